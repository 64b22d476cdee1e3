//! What came out of a run: gathered from what its islands wrote.

use super::config::Config;
use super::failure::Failure;
use super::kept::Candidates;
use super::kind::Kind;
use super::map_output;
use super::reports::Reports;
use super::subject::Subject;
use crate::archipelago::{Champion, Digest, Island};
use crate::evolution::generation::Effort;
use crate::evolution::{Fitness, Gene, Individual};
use crate::formats::metrics;
use crate::problems::Validation;
use crate::store::{RunDir, StoreError, Tail, checkpoint, file};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// No summary is longer, in bytes: one has some hundred.
pub const SUMMARY_BYTES_MAX: usize = 1 << 20;

/// The result of a run, as `summary.json` and `--json` say it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The digest of all final populations: equal for equal seeds and settings.
    pub digest: String,
    /// The fitness of the champion that is kept: the score that it was selected by. The most negative number there is if
    /// nothing could be scored.
    pub best_fitness: f64,
    /// What the run claims of the same champion: the lower of the means of `validation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validated: Option<f64>,
    /// What it gets in each engine on trials that it was not selected on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub validation: Vec<Validation>,
    /// The fitness as people read it.
    #[serde(skip)]
    pub best: String,
    /// The file of its genome.
    pub best_genome: PathBuf,
    /// Its island.
    pub best_island: u32,
    /// The unit of fitness.
    pub unit: String,
    /// Number of islands.
    pub islands: u32,
    /// The seed.
    pub seed: u64,
    /// Generations after the random first one.
    pub generations: u32,
    /// Individuals on each island.
    pub population: usize,
    /// The problem.
    #[serde(default)]
    pub problem: Kind,
    /// Variables or bits of a genome, where all have as many.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dimensions: Option<usize>,
    /// The task of creatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// The profile of creatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<String>,
    /// Evaluations that were really run.
    pub evaluations: u64,
    /// Offspring whose fitness was known already, so that they were not evaluated.
    pub reused: u64,
    /// Evaluations that did not end in a score.
    pub failures: u64,
    /// Evaluations a second, all islands together.
    pub evaluations_per_second: f64,
    /// How long the slowest island evolved, in seconds. What a run was down for is not counted.
    pub wall_seconds: f64,
    /// The run's folder.
    pub run_dir: PathBuf,
    /// The film, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recording: Option<PathBuf>,
    /// Whether a film is to come yet. Who kills a run over its film can have it made by going on.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub awaits_film: bool,
    /// The program's version.
    pub version: String,
}

/// The result of a run that has finished: what it said then, as long as its final populations still say the same.
/// None if it has not finished, or something of it has to be evolved again.
pub fn finished<P: Subject>(dir: &RunDir, config: &Config, problem: &P) -> Option<Summary> {
    let summary = file::read(&dir.summary(), SUMMARY_BYTES_MAX).ok()?;
    let summary: Summary = serde_json::from_slice(&summary).ok()?;
    let islands = final_islands::<P::Gene>(dir, config).ok()?;
    let is_sound = summary.generations == config.generations
        && summary.digest == Digest::of(&islands).to_string();
    let has_champion = !candidates::<P::Gene>(dir, config).ok()?.is_empty();
    (is_sound && has_champion).then(|| Summary {
        best: problem.show(Fitness::of_saturated(summary.best_fitness)),
        // The folder may have been moved.
        best_genome: dir.champion_genome(),
        run_dir: dir.path().to_owned(),
        recording: recording(dir),
        ..summary
    })
}

/// Gathers the result of a run whose islands have all finished: merges their metrics, hashes their final
/// populations, and writes the champion and the summary, before there is a film if one is to come.
///
/// # Errors
/// If an island's files are missing or damaged, or ours cannot be written.
pub fn gather<P: Subject>(
    dir: &RunDir,
    config: &Config,
    problem: &P,
    awaits_film: bool,
) -> Result<Summary, Failure> {
    let islands = final_islands(dir, config)?;
    let wall_seconds = write_metrics(dir, config)?;
    let best = candidates(dir, config)?.kept(problem);
    let (best_island, best) = best.ok_or_else(|| Failure::failed("no island has a champion"))?;
    write_champion(dir, problem, &best)?;
    map_output::write(dir, config, problem, &islands)?;
    let summary = summarise(dir, config, problem, &islands, (best_island, &best), wall_seconds);
    let summary = Summary { awaits_film, ..summary };
    write(dir, &summary)?;
    Ok(summary)
}

/// The result of a run whose film may have come to be since it was gathered.
///
/// # Errors
/// If it cannot be written.
pub fn with_film(dir: &RunDir, summary: Summary) -> Result<Summary, Failure> {
    let recording = recording(dir);
    if recording == summary.recording && !summary.awaits_film {
        return Ok(summary);
    }
    let summary = Summary { recording, awaits_film: false, ..summary };
    write(dir, &summary)?;
    Ok(summary)
}

/// The film, if there is one.
fn recording(dir: &RunDir) -> Option<PathBuf> {
    Some(dir.recording()).filter(|path| path.is_file())
}

fn write(dir: &RunDir, summary: &Summary) -> Result<(), StoreError> {
    dir.write(&dir.summary(), |out| Ok(serde_json::to_writer_pretty(out, summary)?))
}

/// What the final states of all islands come to, in the order of their index; the slowest evolved for `wall_seconds`.
pub fn summarise<P: Subject>(
    dir: &RunDir,
    config: &Config,
    problem: &P,
    islands: &[Island<P::Gene>],
    best: (u32, &Individual<P::Gene>),
    wall_seconds: f64,
) -> Summary {
    let (best_island, best) = best;
    let is_walker = config.problem == Kind::Creatures;
    let validation = problem.fresh(&best.genome, None);
    let effort = islands.iter().fold(Effort::default(), |sum, island| sum.and(island.effort));
    Summary {
        digest: Digest::of(islands).to_string(),
        best_fitness: best.fitness.saturated(),
        validated: lowest_mean(&validation),
        validation,
        best: problem.show(best.fitness),
        best_genome: dir.champion_genome(),
        best_island,
        unit: problem.unit().to_owned(),
        islands: config.islands,
        seed: config.seed.unwrap_or_default(),
        generations: config.generations,
        population: config.population,
        problem: config.problem,
        dimensions: (!is_walker).then_some(config.dimensions),
        task: is_walker.then(|| config.task.to_string()),
        profile: is_walker.then(|| config.profile.to_string()),
        evaluations: effort.evaluations,
        reused: effort.reused,
        failures: effort.failures(),
        evaluations_per_second: effort.evaluations as f64 / wall_seconds.max(1e-9),
        wall_seconds,
        run_dir: dir.path().to_owned(),
        recording: recording(dir),
        awaits_film: false,
        version: env!("CARGO_PKG_VERSION").to_owned(),
    }
}

/// Writes what all islands have reported so far as the run's metrics, and says how long the slowest of them took for it,
/// in seconds.
///
/// # Errors
/// If the reports cannot be read, or the metrics not written.
pub fn write_metrics(dir: &RunDir, config: &Config) -> Result<f64, StoreError> {
    let mut reports = Reports::of(dir, config.islands)?;
    let rows = reports.by_ref().map(|row| row.map_err(std::io::Error::other));
    dir.write(&dir.metrics(), |out| metrics::write(rows, true, out))?;
    Ok(reports.seconds())
}

/// The lower of the engines' means, if there are any.
pub fn lowest_mean(validation: &[Validation]) -> Option<f64> {
    validation.iter().map(|one| one.mean).reduce(f64::min)
}

/// Who of all champions that the islands have had so far may be kept.
fn candidates<G: Gene>(dir: &RunDir, config: &Config) -> Result<Candidates<G>, StoreError> {
    let mut candidates = Candidates::none();
    for island in 0..config.islands {
        let mut champions = Tail::<Champion<G>>::of(dir.champions(island));
        while let Some(champion) = champions.next_record()? {
            candidates.see(island, &champion.individual);
        }
    }
    Ok(candidates)
}

fn final_islands<G: Gene>(dir: &RunDir, config: &Config) -> Result<Vec<Island<G>>, StoreError> {
    (0..config.islands)
        .map(|index| {
            let path = dir.checkpoint(index, config.generations);
            let island: Island<G> = checkpoint::load(&path)?.island;
            let misfit = island.fits(&config.archipelago(), index);
            misfit.map_err(|misfit| StoreError::damaged(&path, misfit.to_string()))?;
            Ok(island)
        })
        .collect()
}

/// Writes an individual as the run's champion: its genome, and its body if it has one.
///
/// # Errors
/// If the files cannot be written.
pub fn write_champion<P: Subject>(
    dir: &RunDir,
    problem: &P,
    champion: &Individual<P::Gene>,
) -> Result<(), Failure> {
    dir.write(&dir.champion_genome(), |out| problem.write_genome(&champion.genome, out))?;
    let Some(body) = problem.body(&champion.genome) else { return Ok(()) };
    Ok(dir.write(&dir.champion_body(), |out| out.write_all(&body))?)
}

/// Keeps the best individual of a run on disk while the run goes on.
#[derive(Debug)]
pub struct BestOnDisk {
    best: Fitness,
}

impl BestOnDisk {
    /// That of a run that may have had champions already.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn of<G: Gene>(dir: &RunDir, config: &Config) -> Result<Self, Failure> {
        Ok(Self { best: candidates::<G>(dir, config)?.highest() })
    }

    /// Writes `champion` if it is better than all before it.
    ///
    /// # Errors
    /// If the files cannot be written.
    pub fn receive<P: Subject>(
        &mut self,
        dir: &RunDir,
        problem: &P,
        champion: &Champion<P::Gene>,
    ) -> Result<(), Failure> {
        let fitness = champion.individual.fitness;
        if fitness <= self.best {
            return Ok(());
        }
        self.best = fitness;
        write_champion(dir, problem, &champion.individual)
    }
}
