//! The monitor's process: films what the islands report, and serves it live. It only looks: a run without
//! it loses nothing but the film.

use super::Failure;
use super::cli::MonitorArgs;

/// Records and serves the run in a folder until its launcher, or the user, stops it.
///
/// # Errors
/// If the run is not under way, or the recording cannot be written.
#[cfg(feature = "view")]
pub fn run(args: &MonitorArgs) -> Result<(), Failure> {
    watched::run(args)
}

/// Says that this program cannot.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &MonitorArgs) -> Result<(), Failure> {
    Err(Failure::usage("this program was built without the feature “view”, and cannot record"))
}

#[cfg(feature = "view")]
mod watched {
    use super::super::Failure;
    use super::super::config::Config;
    use super::super::console::{print, say};
    use super::super::kinship::{Ear, SERVING, tell};
    use super::MonitorArgs;
    use crate::creature::Gene;
    use crate::evolution::{Individual, Problem};
    use crate::problems::Locomotion;
    use crate::store::RunDir;
    use crate::transport::{Lookout, Sighting};
    use crate::view::{Clip, Live, Pace, Recorder, RunCard, ViewError};
    use std::collections::BTreeSet;
    use std::time::Duration;

    /// The monitor looks about so often.
    const LOOK: Duration = Duration::from_millis(20);
    /// How much the monitor stands back behind the islands: filming must not cost them evaluations.
    const NICENESS: i32 = 10;

    pub fn run(args: &MonitorArgs) -> Result<(), Failure> {
        let ear = match args.parent {
            Some(parent) => Ear::to(parent)?,
            None => Ear::to_signals()?,
        };
        // Standing back is a courtesy: where it is not to be had, filming goes on.
        let _ = rustix::process::nice(NICENESS);
        let dir = RunDir::at(&args.dir);
        let config = Config::read(&dir.config())?;
        let lookout = Lookout::<Gene>::open(&config.domain()?, &config.archipelago())?;
        let recorder = open_recorder(&dir, &config)?;
        let has_launcher = args.parent.is_some();
        match recorder.address() {
            Some(address) if has_launcher => tell(&format!("{SERVING}{address}")),
            Some(address) => print(&format!("watch it live:  rerun {address}")),
            None => {}
        }
        let mut cinema = Cinema { problem: config.problem(), recorder };
        let mut evolving: BTreeSet<u32> = (0..config.islands).collect();
        loop {
            let last = ear.heard_stop();
            let sightings = lookout.receive();
            let idle = sightings.is_empty();
            crosses_off_the_last(&mut evolving, &sightings, config.generations);
            for sighting in sightings {
                cinema.show(&sighting)?;
            }
            if last && idle {
                return Ok(cinema.recorder.finish()?);
            }
            if idle {
                std::thread::sleep(LOOK);
            }
        }
    }

    /// Crosses off the islands whose last report is here; whether there were some, and none is left.
    fn crosses_off_the_last(
        evolving: &mut BTreeSet<u32>,
        sightings: &[Sighting<Gene>],
        generations: u32,
    ) -> bool {
        let reports = sightings.iter().map(|sighting| sighting.report);
        let last = reports.filter(|report| report.generation == generations);
        let crossed = last.filter(|report| evolving.remove(&report.island)).count();
        crossed > 0 && evolving.is_empty()
    }

    /// Records and serves; where no port is free, only records.
    fn open_recorder(dir: &RunDir, config: &Config) -> Result<Recorder, ViewError> {
        let path = dir.recording();
        match Recorder::create(&path, Some(Live::default()), run_card(config)) {
            Err(error @ ViewError::NoFreePort { .. }) => {
                say(&format!("warning: {error}; this run is only recorded"));
                Recorder::create(&path, None, run_card(config))
            }
            result => result,
        }
    }

    struct Cinema {
        problem: Locomotion,
        recorder: Recorder,
    }

    impl Cinema {
        fn show(&mut self, sighting: &Sighting<Gene>) -> Result<(), Failure> {
            let report = &sighting.report;
            let (island, generation) = (report.island, report.generation);
            if report.immigrants > 0 {
                let news = format!("{} immigrants arrive", report.immigrants);
                self.recorder.event(Some(island), generation, &news)?;
            }
            if let Some(champion) = &sighting.champion {
                self.film(island, generation, champion)?;
            }
            self.recorder.report(report)?;
            Ok(self.recorder.flush()?)
        }

        /// Simulates a champion again. It must get the fitness that it was reported with, bit for bit: what is
        /// seen is what was scored.
        fn film(
            &mut self,
            island: u32,
            generation: u32,
            champion: &Individual<Gene>,
        ) -> Result<(), Failure> {
            let Ok((evaluation, trajectory)) = self.problem.film(&champion.genome) else {
                return Ok(());
            };
            let score = self.problem.show(champion.fitness);
            let origin = match champion.id.island {
                born if born == island => String::new(),
                born => format!(", born on island {born}"),
            };
            let mut news =
                format!("new champion, {score}, {} links{origin}", trajectory.shapes.len());
            if evaluation.fitness != champion.fitness {
                news = format!(
                    "WARNING: the champion of island {island} was reported with {:?}, but gets {:?} here: \
                     the islands and the monitor do not simulate the same",
                    champion.fitness, evaluation.fitness
                );
                say(&news);
            }
            self.recorder.event(Some(island), generation, &news)?;
            let clip = Clip {
                island,
                generation,
                label: format!("gen {generation} · {score}"),
                trajectory,
            };
            Ok(self.recorder.champion(&clip)?)
        }
    }

    fn run_card(config: &Config) -> RunCard {
        let archipelago = config.archipelago();
        let edges = (0..config.islands).flat_map(|island| {
            archipelago.out_neighbours(island).into_iter().map(move |to| (island, to))
        });
        let trial = config.task.trial();
        RunCard {
            islands: config.islands,
            unit: config.problem().unit().to_owned(),
            description_markdown: format!("# A run\n\n```toml\n{}```\n", config.to_toml()),
            topology_edges: edges.collect(),
            pace: Pace::for_run(config.generations, trial.settle_s + trial.scored_s),
        }
    }
}
