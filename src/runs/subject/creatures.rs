//! Creatures have bodies: they can be filmed, and taken elsewhere.

#[cfg(feature = "view")]
use super::Shot;
use super::Subject;
use crate::creature::{Creature, Gene};
use crate::evolution::Fitness;
#[cfg(feature = "view")]
use crate::evolution::{Evaluation, Outcome};
use crate::formats::{genome_csv, urdf};
use crate::problems::{Locomotion, Validation};
#[cfg(feature = "view")]
use crate::simulation::{Ground, Trajectory};
use std::io::{self, Write};
#[cfg(feature = "view")]
use std::panic::{AssertUnwindSafe, catch_unwind};

impl Subject for Locomotion {
    const INHABITANTS: &'static str = "creatures";
    const HAS_BODIES: bool = true;

    fn title(&self) -> String {
        format!("Task **{}**, profile **{}**", self.task, self.encoding.profile)
    }

    fn read_genome(&self, bytes: &[u8], dropped: &[usize]) -> Result<Vec<Gene>, String> {
        let read = genome_csv::read_without(bytes, dropped);
        read.map(|read| read.genome).map_err(|error| error.to_string())
    }

    fn write_genome(&self, genome: &[Gene], output: &mut dyn Write) -> io::Result<()> {
        genome_csv::write(genome, output)
    }

    /// As URDF. What cannot be expressed has no body, and was never scored.
    fn body(&self, genome: &[Gene]) -> Option<Vec<u8>> {
        let Creature { morphology, controller } = self.express(genome).ok()?;
        let mut file = Vec::new();
        urdf::write(&morphology, &controller, "champion", &mut file)
            .expect("memory takes everything");
        Some(file)
    }

    fn unit(&self) -> &'static str {
        self.task.unit()
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["links", "height"]
    }

    fn possible_scores(&self, genome: &[Gene]) -> Vec<Fitness> {
        Locomotion::possible_scores(self, genome)
    }

    fn fresh(&self, genome: &[Gene], trials: Option<u32>) -> Vec<Validation> {
        let Ok(creature) = self.express(genome) else { return Vec::new() };
        self.validate_in_each(&creature, trials.unwrap_or(self.fresh_trials()))
    }

    fn tried_once_more(&self, genome: &[Gene]) -> Option<Fitness> {
        self.robustness
            .is_wanted()
            .then(|| self.express(genome).map_or(Fitness::WORST, |body| self.elsewhere(&body)))
    }

    fn short(&self, fitness: Fitness) -> String {
        match fitness.finite() {
            Some(score) => format!("{score:.2} {}", self.unit()),
            None => "failed".to_owned(),
        }
    }

    fn remark(&self, genome: &[Gene]) -> Option<String> {
        let creature = self.express(genome).ok()?;
        Some(format!("{} links", creature.morphology.links.len()))
    }

    fn clip_s(&self) -> f64 {
        let trial = self.trial();
        trial.settle_s + trial.scored_s
    }

    #[cfg(feature = "view")]
    fn ground(&self) -> Ground {
        self.trial().ground
    }

    #[cfg(feature = "view")]
    fn shoot(&self, genome: &[Gene]) -> Option<Shot> {
        let nothing = Trajectory {
            bodies: Vec::new(),
            shapes: Vec::new(),
            times_s: Vec::new(),
            poses: Vec::new(),
            scoring_from_s: 0.0,
            ground: self.ground(),
        };
        let filmed = match catch_unwind(AssertUnwindSafe(|| self.film(genome))) {
            Ok(film) => film.ok()?,
            // The island survived it, too: it is an outcome like others.
            Err(_) => (Evaluation::failed(Outcome::Panicked), nothing),
        };
        let Creature { morphology, controller } = self.express(genome).ok()?;
        let (evaluation, trajectory) = filmed;
        Some(Shot { morphology, controller, evaluation, trajectory })
    }
}
