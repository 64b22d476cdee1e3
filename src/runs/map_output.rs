//! The map that a run of MAP-Elites has drawn, as files.

use super::config::Config;
use super::failure::Failure;
use super::subject::Subject;
use crate::archipelago::Island;
use crate::evolution::survival::map_elites;
use crate::evolution::{Individual, Survival};
use crate::store::RunDir;
use std::io::{self, Write};

/// Writes the best of each cell over all islands, if the run has maps: a table, and each genome as a file of its own.
///
/// # Errors
/// If the files cannot be written.
pub fn write<P: Subject>(
    dir: &RunDir,
    config: &Config,
    problem: &P,
    islands: &[Island<P::Gene>],
) -> Result<(), Failure> {
    let Survival::MapElites { bins } = config.archipelago().strategy.survival else {
        return Ok(());
    };
    let all = islands.iter().flat_map(|island| island.population.iter().cloned());
    let elites = map_elites::fill(problem, bins, all);
    dir.make_map()?;
    for elite in &elites {
        let path = dir.map_genome(map_elites::cell(problem.features(&elite.genome), bins));
        dir.write(&path, |out| problem.write_genome(&elite.genome, out))?;
    }
    dir.write(&dir.map(), |out| table(problem, bins, &elites, out))?;
    Ok(())
}

/// A row a cell: its place, the features and the fitness of who is in it, where that was born, and its genome's file.
fn table<P: Subject>(
    problem: &P,
    bins: u32,
    elites: &[Individual<P::Gene>],
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(out);
    let [first, second] = problem.feature_names();
    rows.write_record([
        &format!("{first} cell"),
        &format!("{second} cell"),
        first,
        second,
        "fitness",
        "individual",
        "genome",
    ])?;
    for elite in elites {
        let features = problem.features(&elite.genome);
        let [x, y] = map_elites::cell(features, bins);
        rows.write_record([
            x.to_string(),
            y.to_string(),
            features[0].to_string(),
            features[1].to_string(),
            elite.fitness.finite().map(|score| score.to_string()).unwrap_or_default(),
            elite.id.to_string(),
            format!("map/{x}-{y}.csv"),
        ])?;
    }
    rows.flush()
}
