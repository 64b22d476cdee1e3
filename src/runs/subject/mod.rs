//! What the program has to know of a problem beyond evolving it. Who implements this for a problem of their own, and
//! names it in [the catalogue](super::catalogue), has it on islands that are processes, saved, verified and watched.

mod creatures;
mod networks;
mod vectors;

#[cfg(feature = "view")]
use crate::creature::Creature;
#[cfg(feature = "view")]
use crate::evolution::Evaluation;
use crate::evolution::{Fitness, Problem};
use crate::problems::Validation;
#[cfg(feature = "view")]
use crate::simulation::{Ground, Trajectory};
use std::io::{self, Write};

/// A problem that the program can run: its genomes can be written and read, and be shown if they have a body.
pub trait Subject: Problem + Clone + Send {
    /// What evolves, in the plural.
    const INHABITANTS: &'static str;
    /// Whether a genome describes a body, which can be filmed and taken elsewhere.
    const HAS_BODIES: bool;

    /// What is to be done, as a card says it in Markdown.
    fn title(&self) -> String;

    /// How many columns each line of a genome's file has, where files may have more that are to be left out.
    fn columns(&self) -> usize {
        0
    }

    /// Reads a genome; columns that are to be left out are counted from 1.
    ///
    /// # Errors
    /// What is wrong with it, in a sentence.
    fn read_genome(&self, bytes: &[u8], dropped: &[usize]) -> Result<Vec<Self::Gene>, String>;

    /// Writes a genome as [`Subject::read_genome`] reads it, without a blank line.
    ///
    /// # Errors
    /// If the output cannot be written.
    fn write_genome(&self, genome: &[Self::Gene], output: &mut dyn Write) -> io::Result<()>;

    /// The body that a genome describes, as a file for other programs; none if it cannot be built.
    fn body(&self, _genome: &[Self::Gene]) -> Option<Vec<u8>> {
        None
    }

    /// What the two features are called.
    fn feature_names(&self) -> [&'static str; 2] {
        ["first", "second"]
    }

    /// All scores that a genome can have on an island, its estimates and, last, its whole score.
    fn possible_scores(&self, genome: &[Self::Gene]) -> Vec<Fitness> {
        vec![self.evaluate(genome).fitness]
    }

    /// What so many trials in each engine come to that nobody was selected on, where there are engines; as many as are
    /// usual if none are said.
    fn fresh(&self, _genome: &[Self::Gene], _trials: Option<u32>) -> Vec<Validation> {
        Vec::new()
    }

    /// What a genome is worth where nobody was selected: the other engine finds it, in as many trials as the score
    /// has. None where a score leaves nothing to luck, or none is wanted that does.
    fn tried_once_more(&self, _genome: &[Self::Gene]) -> Option<Fitness> {
        None
    }

    /// The unit of the fitness, for labels.
    fn unit(&self) -> &'static str {
        ""
    }

    /// A fitness as people read it.
    fn show(&self, fitness: Fitness) -> String {
        match fitness.finite() {
            Some(score) => format!("{score:.3} {}", self.unit()).trim_end().to_owned(),
            None => "failed".to_owned(),
        }
    }

    /// A fitness as a label has room for.
    fn short(&self, fitness: Fitness) -> String {
        self.show(fitness)
    }

    /// What is to be said of a genome besides its fitness.
    fn remark(&self, _genome: &[Self::Gene]) -> Option<String> {
        None
    }

    /// How long a film of a trial is, in seconds; where there is nothing to be seen but figures, how long each twelfth
    /// of a run is shown.
    fn clip_s(&self) -> f64 {
        5.0
    }

    /// What bodies stand on.
    #[cfg(feature = "view")]
    fn ground(&self) -> Ground {
        Ground::Plane
    }

    /// Evaluates a genome and films it; none if its body cannot be built.
    #[cfg(feature = "view")]
    fn shoot(&self, _genome: &[Self::Gene]) -> Option<Shot> {
        None
    }
}

/// A trial that was filmed.
#[cfg(feature = "view")]
#[derive(Debug, Clone)]
pub struct Shot {
    /// The body and what moves it.
    pub creature: Creature,
    /// Who and what else was in its world.
    pub others: Vec<Creature>,
    /// What it got.
    pub evaluation: Evaluation,
    /// How all of them moved.
    pub trajectory: Trajectory,
}
