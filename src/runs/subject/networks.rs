//! Networks: a neuron or a link a line.

use super::Subject;
use crate::evolution::Fitness;
use crate::formats::network_csv::{self, Names};
use crate::networks::Gene;
use crate::problems::Neat;
use crate::problems::neat::Test;
use std::io::{self, Write};

impl Subject for Neat {
    const INHABITANTS: &'static str = "networks";
    const HAS_BODIES: bool = false;

    fn title(&self) -> String {
        format!("**{}**, networks that grow, solved from {} on", self.test, self.test.solved_from())
    }

    fn unit(&self) -> &'static str {
        if self.test == Test::DoublePole { "steps" } else { "" }
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["hidden neurons", "links"]
    }

    fn possible_scores(&self, genome: &[Gene]) -> Vec<Fitness> {
        Self::possible_scores(self, genome)
    }

    fn read_genome(&self, bytes: &[u8], _dropped: &[usize]) -> Result<Vec<Gene>, String> {
        let genes = network_csv::read(bytes, &names(self))?;
        // Where signals only pass forwards there is no network of a circle.
        self.network(&genes).map_err(|error| error.to_string())?;
        Ok(genes)
    }

    fn write_genome(&self, genome: &[Gene], output: &mut dyn Write) -> io::Result<()> {
        network_csv::write(genome, &names(self), output)
    }

    /// From how many of other starts it balances.
    fn remark(&self, genome: &[Gene]) -> Option<String> {
        let held = self.starts_held(genome)?;
        Some(format!("balances from {held} of 625 other starts"))
    }
}

fn names(problem: &Neat) -> Names<'static> {
    Names { inputs: problem.test.inputs(), outputs: problem.test.outputs() }
}
