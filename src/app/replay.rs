//! `islands replay`: films genomes and bodies.

use super::Failure;
use super::cli::ReplayArgs;

/// Films the creatures in the files that are named, genomes or bodies, side by side.
///
/// # Errors
/// If one cannot be read or expressed, or the recording cannot be written.
#[cfg(feature = "view")]
pub fn run(args: &ReplayArgs) -> Result<(), Failure> {
    use super::console::print;
    use super::genomes::Specimen;
    use crate::evolution::Problem;
    use crate::view::{Clip, Draft, Pace, Recorder, RunCard};

    let problem = args.trial.problem()?;
    let read = |path| Specimen::read(path, &args.trial.read);
    let specimens: Vec<_> = args.genomes.iter().map(|path| read(path)).collect::<Result<_, _>>()?;
    let trial = args.trial.task.trial();
    let names: Vec<String> =
        args.genomes.iter().map(|path| format!("- {}\n", path.display())).collect();
    let card = RunCard {
        islands: specimens.len() as u32,
        unit: problem.unit().to_owned(),
        description_markdown: format!("# A replay\n\n{}", names.concat()),
        topology_edges: Vec::new(),
        pace: Pace::for_run(0, trial.settle_s + trial.scored_s),
    };
    let mut films = Vec::new();
    for (specimen, path) in specimens.iter().zip(&args.genomes) {
        let creature = specimen.creature(path, problem.reading(), problem.links_max)?;
        films.push(problem.film_body(&creature));
    }
    let elsewhere = |error| Failure::usage(format!("{error}; choose another file with --out"));
    let draft = Draft::beside(&args.out).map_err(elsewhere)?;
    let mut recorder = Recorder::create(draft, None, card).map_err(elsewhere)?;
    for ((index, path), (evaluation, trajectory)) in (0..).zip(&args.genomes).zip(films) {
        let score = problem.show(evaluation.fitness);
        let name = path.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
        print(&format!("{score:>12}  {}  {}", evaluation.outcome, path.display()));
        recorder.champion(&Clip {
            island: index,
            generation: 0,
            label: format!("{name} · {score}"),
            trajectory,
        })?;
    }
    recorder.finish()?;
    print(&format!("view it:  rerun {}", args.out.display()));
    Ok(())
}

/// Says that this program cannot.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &ReplayArgs) -> Result<(), Failure> {
    Err(Failure::usage("this program was built without the feature “view”, and cannot film"))
}
