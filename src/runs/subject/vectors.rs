//! Numbers and bits: a column of a table.

use super::Subject;
use crate::evolution::{Fitness, Gene};
use crate::formats::vector_csv::{self, COLUMNS};
use crate::problems::{Benchmark, Bit, Bits, Real};
use std::io::{self, Write};

impl Subject for Benchmark {
    const INHABITANTS: &'static str = "points";
    const HAS_BODIES: bool = false;

    fn title(&self) -> String {
        let turned = if self.rotation().is_empty() { "" } else { " and rotated" };
        format!("**{}**, shifted{turned}, {} variables", self.function(), self.dimensions())
    }

    fn read_genome(&self, bytes: &[u8], _dropped: &[usize]) -> Result<Vec<Real>, String> {
        let gene = "a number from 0 (included) to 1 (excluded)";
        let parse = |cell: &str| cell.parse().ok().map(Real).filter(Gene::is_valid);
        vector_csv::read(bytes, self.dimensions(), gene, parse).map_err(|error| error.to_string())
    }

    /// Beside each gene stands the variable that it is, in the function's domain.
    fn write_genome(&self, genome: &[Real], output: &mut dyn Write) -> io::Result<()> {
        let line = |gene: &Real| format!("{},{}", gene.0, self.variable(*gene));
        vector_csv::write(COLUMNS[0], genome.iter().map(line), output)
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["x1", "x2"]
    }

    /// An error of a millionth is no zero.
    fn show(&self, fitness: Fitness) -> String {
        fitness.finite().map_or_else(|| "failed".to_owned(), |score| format!("{score:.6e}"))
    }

    fn short(&self, fitness: Fitness) -> String {
        fitness.finite().map_or_else(|| "failed".to_owned(), |score| format!("{score:.2e}"))
    }
}

impl Subject for Bits {
    const INHABITANTS: &'static str = "strings";
    const HAS_BODIES: bool = false;

    fn title(&self) -> String {
        let blocks =
            if self.block > 1 { format!(" in blocks of {}", self.block) } else { String::new() };
        format!("**{}**, {} bits{blocks}", self.pattern, self.bits)
    }

    fn read_genome(&self, bytes: &[u8], _dropped: &[usize]) -> Result<Vec<Bit>, String> {
        let parse = |cell: &str| cell.parse().ok().map(Bit).filter(Gene::is_valid);
        vector_csv::read(bytes, self.bits, "0 or 1", parse).map_err(|error| error.to_string())
    }

    fn write_genome(&self, genome: &[Bit], output: &mut dyn Write) -> io::Result<()> {
        vector_csv::write(COLUMNS[1], genome.iter().map(|bit| bit.0.to_string()), output)
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["ones of the first half", "ones of the second half"]
    }

    /// Bits are counted.
    fn show(&self, fitness: Fitness) -> String {
        fitness.finite().map_or_else(|| "failed".to_owned(), |score| format!("{score}"))
    }
}
