//! Problems over bits, whose schemata can be counted by hand.

use super::fixed;
use crate::choice;
use crate::evolution::variation::sequences::Layout;
use crate::evolution::{Evaluation, Gene, Hurdles, Problem, Variation, variation};
use crate::rng::Stream;
use bytemuck::{Pod, Zeroable};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// 0 or 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
pub struct Bit(pub u8);

impl Gene for Bit {
    const WIRE_NAME: &'static str = "islands.bit.v1";

    fn is_valid(&self) -> bool {
        self.0 < 2
    }
}

/// What bits are worth.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// The number of ones: every schema leads to the optimum.
    #[serde(rename = "onemax")]
    #[strum(serialize = "onemax")]
    OneMax,
    /// Blocks in a row, each a fully deceptive trap of k bits (Deb & Goldberg 1993): k if all are ones, else k − 1
    /// less the number of ones, so that every schema of less than a block leads away from the optimum.
    Trap,
    /// The royal road R1 (Mitchell, Forrest & Holland 1992): each block of ones that is whole is worth its length,
    /// and what is not whole nothing.
    RoyalRoad,
}

impl Pattern {
    /// The bits of a genome, as its source has them where it says.
    pub fn usual_bits(self) -> usize {
        match self {
            Pattern::OneMax | Pattern::Trap => 100,
            Pattern::RoyalRoad => 64,
        }
    }

    /// The bits of a block, as its source has them; one-max has no blocks.
    pub fn usual_block(self) -> usize {
        match self {
            Pattern::OneMax => 1,
            Pattern::Trap => 5,
            Pattern::RoyalRoad => 8,
        }
    }

    /// What a block with so many ones of so many bits is worth.
    pub fn worth(self, ones: usize, bits: usize) -> usize {
        match self {
            Pattern::OneMax => ones,
            Pattern::Trap | Pattern::RoyalRoad if ones == bits => bits,
            Pattern::Trap => bits - 1 - ones,
            Pattern::RoyalRoad => 0,
        }
    }
}

choice::one_of!("pattern", Pattern);

/// A problem over bits: the optimum is a genome of ones, and worth as many as there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits {
    /// What they are worth.
    pub pattern: Pattern,
    /// Bits of a genome, at least 1.
    pub bits: usize,
    /// Bits of a block, at least 1; a last block may be shorter.
    pub block: usize,
}

impl Bits {
    /// A problem with as many bits, and as many a block, as its source has.
    pub fn of(pattern: Pattern) -> Self {
        Self { pattern, bits: pattern.usual_bits(), block: pattern.usual_block() }
    }
}

impl Problem for Bits {
    type Gene = Bit;

    fn random_gene(&self, rng: &mut Stream) -> Bit {
        Bit(rng.random_range(0..2))
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Bit> {
        (0..self.bits).map(|_| self.random_gene(rng)).collect()
    }

    fn layout(&self) -> Layout {
        Layout::Fixed
    }

    /// Turns the bit over; there is no less of it.
    fn mutate_gene(&self, gene: &mut Bit, variation: &Variation, rng: &mut Stream) {
        if variation::happens(variation.point_rate, rng) {
            gene.0 ^= 1;
        }
    }

    /// The shares of ones in the first half of the genome and in the second.
    fn features(&self, genome: &[Bit]) -> [f64; 2] {
        let (first, second) = genome.split_at(genome.len() / 2);
        [first, second].map(|half| {
            let ones = half.iter().filter(|bit| bit.0 == 1).count();
            ones as f64 / half.len().max(1) as f64
        })
    }

    /// The share of bits that differ (Hamming 1950).
    fn distance(&self, a: &[Bit], b: &[Bit]) -> f64 {
        fixed::distance(a, b, |a, b| f64::from(u8::from(a != b)))
    }

    fn evaluate(&self, genome: &[Bit]) -> Evaluation {
        let worth = |block: &[Bit]| {
            let ones = block.iter().filter(|bit| bit.0 == 1).count();
            self.pattern.worth(ones, block.len())
        };
        fixed::evaluate(genome, self.bits, |genome| {
            genome.chunks(self.block.max(1)).map(worth).sum::<usize>() as f64
        })
    }

    // A pool of threads would take far longer than the work.
    fn estimate_batch(&self, genomes: &[&[Bit]], _: &Hurdles) -> Vec<Evaluation> {
        genomes.iter().map(|genome| self.evaluate(genome)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::Outcome;
    use crate::rng::{Purpose, Source};

    fn score(problem: Bits, text: &str) -> Option<f64> {
        let genome: Vec<Bit> = text.bytes().map(|digit| Bit(digit - b'0')).collect();
        problem.evaluate(&genome).fitness.finite()
    }

    #[test]
    fn one_max_counts_ones() {
        let problem = Bits { bits: 6, ..Bits::of(Pattern::OneMax) };
        assert_eq!(score(problem, "000000"), Some(0.0));
        assert_eq!(score(problem, "011010"), Some(3.0));
        assert_eq!(score(problem, "111111"), Some(6.0));
    }

    #[test]
    fn a_trap_is_worth_less_with_each_one_but_the_last() {
        let problem = Bits { bits: 5, ..Bits::of(Pattern::Trap) };
        let worth = ["00000", "10000", "01010", "10101", "11011", "11111"];
        let worth = worth.map(|text| score(problem, text).unwrap());
        assert_eq!(worth, [4.0, 3.0, 2.0, 1.0, 0.0, 5.0]);
        let two = Bits { bits: 10, ..problem };
        assert_eq!(score(two, "1111100000"), Some(9.0));
        assert_eq!(score(two, "1111111110"), Some(5.0));
    }

    #[test]
    fn a_trap_deceives_every_schema_of_less_than_a_block() {
        let problem = Bits { bits: 5, ..Bits::of(Pattern::Trap) };
        let mean = |fixed: u32, value: u32| {
            let members = (0..32_u32).filter(|genome| genome & fixed == value);
            let of = |genome: u32| score(problem, &format!("{genome:05b}")).unwrap();
            let scores: Vec<f64> = members.map(of).collect();
            scores.iter().sum::<f64>() / scores.len() as f64
        };
        for fixed in 1..31 {
            assert!(mean(fixed, 0) > mean(fixed, fixed), "{fixed:05b}");
        }
        assert!(mean(31, 0) < mean(31, 31));
    }

    #[test]
    fn a_royal_road_counts_whole_blocks_alone() {
        let problem = Bits::of(Pattern::RoyalRoad);
        let genome = |blocks: &[&str]| score(problem, &blocks.concat());
        let (whole, nearly, none) = ("11111111", "11111110", "00000000");
        assert_eq!(genome(&[none; 8]), Some(0.0));
        assert_eq!(genome(&[nearly; 8]), Some(0.0));
        assert_eq!(genome(&[whole, none, none, none, none, none, none, nearly]), Some(8.0));
        assert_eq!(genome(&[whole; 8]), Some(64.0));
    }

    #[test]
    fn a_genome_of_another_length_or_with_another_digit_is_not_scored() {
        let problem = Bits::of(Pattern::OneMax);
        let refused = Evaluation::failed(Outcome::TooLarge);
        assert_eq!(problem.evaluate(&[Bit(1); 99]), refused);
        assert_eq!(problem.evaluate(&[Bit(2); 100]), refused);
    }

    #[test]
    fn random_genomes_hold_as_many_ones_as_zeros_and_mutation_turns_bits_at_its_rate() {
        let problem = Bits { bits: 20_000, ..Bits::of(Pattern::OneMax) };
        let mut rng = Source { seed: 1, island: 0 }.stream(0, 0, Purpose::Genesis);
        let genome = problem.random_genome(&mut rng);
        let ones = problem.evaluate(&genome).fitness.get();
        assert!((9_700.0..10_300.0).contains(&ones), "{ones}");
        let variation = Variation { point_rate: 0.1, ..Variation::default() };
        let mut mutant = genome.clone();
        problem.mutate(&mut mutant, &variation, &mut rng);
        let share = problem.distance(&genome, &mutant);
        assert!((share - 0.1).abs() < 0.01, "{share}");
        assert!(mutant.iter().all(Gene::is_valid));
    }
}
