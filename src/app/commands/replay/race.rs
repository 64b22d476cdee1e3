//! Creatures that race.

use super::film::{Studio, recorder};
use crate::app::args::cli::ReplayArgs;
use crate::app::console::print;
use crate::app::genomes::Specimen;
use crate::creature::Course;
use crate::evolution::Fitness;
use crate::problems::Locomotion;
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::view::{Clip, Lane, Pace, Program, RunCard};
use std::path::{Path, PathBuf};

/// Films genomes and bodies side by side, and returns the recording's name.
///
/// # Errors
/// If one cannot be read or expressed, or the recording cannot be written.
pub fn film(args: &ReplayArgs, paths: &[PathBuf]) -> Result<PathBuf, Failure> {
    let studio = Studio::new(args, &Config::default())?;
    let out = args.out.clone().unwrap_or_else(|| paths[0].with_extension("rrd"));
    let encoding = studio.problem.encoding;
    let read = |path| Specimen::read(path, &encoding, &args.changes);
    let specimens: Vec<_> = paths.iter().map(|path| read(path)).collect::<Result<_, _>>()?;
    let mut shots = Vec::new();
    for (specimen, path) in specimens.iter().zip(paths) {
        shots.push(studio.shoot(specimen.creature(path, &encoding)?));
    }
    let lanes = (0..).zip(paths).map(|(hue, path)| Lane { title: name(path), hue });
    let scores = shots.iter().map(|shot| shot.evaluation.fitness);
    let card = RunCard {
        program: Program::Race,
        lanes: lanes.collect(),
        unit: studio.problem.unit().to_owned(),
        description_markdown: description(&studio, paths, scores),
        topology_edges: Vec::new(),
        has_stage: true,
        has_family: false,
        pace: Pace::for_run(0, None, studio.clip_s()),
        ground: studio.trial.ground.clone(),
    };
    let mut recorder = recorder(&out, card)?;
    for ((lane, path), shot) in (0..).zip(paths).zip(shots) {
        print(&studio.row(&shot, &path.display().to_string()));
        let score = studio.problem.short(shot.evaluation.fitness);
        let label = format!("{} · {score}", name(path));
        recorder.play(
            &Clip {
                lane,
                hue: lane,
                generation: 0,
                short_label: label.clone(),
                label,
                creature: shot.creature,
                others: studio.trial.other_creatures(),
                trajectory: shot.trajectory,
            },
            0,
        )?;
    }
    recorder.finish()?;
    Ok(out)
}

fn name(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

fn description(
    studio: &Studio,
    paths: &[PathBuf],
    scores: impl Iterator<Item = Fitness>,
) -> String {
    let rows = paths
        .iter()
        .zip(scores)
        .map(|(path, score)| format!("| {} | {} |\n", path.display(), studio.problem.short(score)));
    let Locomotion { task, encoding: Course { profile, .. }, .. } = studio.problem;
    format!(
        "# A replay\n\nTask **{task}**, profile **{profile}**, {} s\n\n| creature | score |\n|---|---|\n{}",
        studio.trial.scored_s,
        rows.collect::<String>()
    )
}
