//! Shows what the islands report as a film.

use super::super::Failure;
use super::super::config::Config;
use super::super::console::say;
use super::super::result;
use super::logs::Sighting;
use crate::archipelago::Champion;
use crate::creature::Gene;
use crate::evolution::{Evaluation, Outcome, Problem};
use crate::problems::Locomotion;
use crate::simulation::Trajectory;
use crate::view::{Clip, Draft, Live, Pace, Recorder, RunCard, ViewError};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// A recorder that simulates the champions that will be seen, and no others: filming must cost the islands
/// little, and a film that is made anew must soon be where the run is.
pub struct Cinema {
    problem: Locomotion,
    recorder: Recorder,
    /// Each island's newest champion, if it was not filmed.
    unfilmed: Vec<Option<Champion<Gene>>>,
    has_shown: bool,
}

impl Cinema {
    /// Begins a recording for the path `recording`, in `folder`, and serves it if wanted; where it cannot be
    /// served, it is only recorded.
    ///
    /// # Errors
    /// If nothing can be written there.
    pub fn open(
        folder: &Path,
        recording: &Path,
        live: Option<Live>,
        config: &Config,
    ) -> Result<Self, Failure> {
        let record =
            |live| Recorder::create(Draft::within(folder, recording)?, live, run_card(config));
        let recorder = match record(live) {
            Err(error @ (ViewError::NoFreePort { .. } | ViewError::Serve { .. })) => {
                say(&format!("warning: {error}; this run is only recorded"));
                record(None)?
            }
            result => result?,
        };
        let unfilmed = (0..config.islands).map(|_| None).collect();
        Ok(Self { problem: config.problem(), recorder, unfilmed, has_shown: false })
    }

    /// What to give to a viewer to watch live.
    pub fn address(&self) -> Option<String> {
        self.recorder.address()
    }

    /// Whether there is anything in the recording.
    pub fn has_shown(&self) -> bool {
        self.has_shown
    }

    /// Shows a generation of an island.
    ///
    /// # Errors
    /// If it cannot be recorded.
    pub fn show(&mut self, sighting: &Sighting) -> Result<(), Failure> {
        let Sighting { report, champion } = sighting;
        let (island, generation) = (report.island, report.generation);
        if report.immigrants > 0 {
            let news = format!("{} immigrants arrive", report.immigrants);
            self.recorder.event(Some(island), generation, &news)?;
        }
        if let Some(champion) = champion {
            self.recorder.event(Some(island), generation, &self.news(island, champion))?;
            self.unfilmed[island as usize] = Some(champion.clone());
        }
        if self.recorder.opens_slot(generation) {
            self.film(island)?;
        }
        self.has_shown = true;
        Ok(self.recorder.report(report)?)
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn flush(&self) -> Result<(), Failure> {
        Ok(self.recorder.flush()?)
    }

    /// Puts the recording in its place, in which it goes on. A recording of before is worth more than one with
    /// nothing in it.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn publish(&mut self) -> Result<(), Failure> {
        if self.has_shown {
            self.recorder.publish()?;
        }
        Ok(())
    }

    /// Films the champions that were not seen yet and ends the recording.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn finish(mut self) -> Result<(), Failure> {
        (0..self.unfilmed.len() as u32).try_for_each(|island| self.film(island))?;
        if self.has_shown {
            self.recorder.finish()?;
        }
        Ok(())
    }

    fn news(&self, island: u32, champion: &Champion<Gene>) -> String {
        let individual = &champion.individual;
        let score = result::show(&self.problem, champion);
        let links = self.problem.express(&individual.genome).map_or_else(
            |_| String::new(),
            |creature| format!(", {} links", creature.morphology.links.len()),
        );
        let origin = match individual.id.island {
            born if born == island => String::new(),
            born => format!(", born on island {born}"),
        };
        format!("new champion, {score}{links}{origin}")
    }

    /// Simulates an island's newest champion again, if that was not done. It must get the fitness that it was
    /// reported with, bit for bit: what is seen is what was scored.
    fn film(&mut self, island: u32) -> Result<(), Failure> {
        let Some(champion) = self.unfilmed[island as usize].take() else { return Ok(()) };
        let shown = result::show(&self.problem, &champion);
        let Champion { generation, individual, .. } = champion;
        let Some((evaluation, trajectory)) = self.simulate(&individual.genome) else {
            return Ok(());
        };
        if evaluation.fitness != individual.fitness {
            let news = format!(
                "WARNING: the champion of island {island} was reported with {:?}, but gets {:?} here: \
                 the islands and the monitor do not simulate the same",
                individual.fitness, evaluation.fitness
            );
            say(&news);
            self.recorder.event(Some(island), generation, &news)?;
        }
        let label = format!("gen {generation} · {shown}");
        Ok(self.recorder.champion(&Clip { island, generation, label, trajectory })?)
    }

    /// A champion whose body cannot be built has no film.
    fn simulate(&self, genome: &[Gene]) -> Option<(Evaluation, Trajectory)> {
        let filmed = catch_unwind(AssertUnwindSafe(|| self.problem.film(genome)));
        let nothing = Trajectory {
            shapes: Vec::new(),
            times_s: Vec::new(),
            poses: Vec::new(),
            scoring_from_s: 0.0,
        };
        match filmed {
            Ok(film) => film.ok(),
            // The island survived it, too: it is an outcome like others.
            Err(_) => Some((Evaluation::failed(Outcome::Panicked), nothing)),
        }
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
