//! What can be evolved.
//!
//! [`locomotion`] evolves creatures that move: [`tasks`] say what they have to do, [`progress`] how far one got,
//! [`robustness`] what several trials come to, and [`validation`] what one is worth on trials that it was not selected
//! on; `scoring` is how all that makes a score. [`benchmark`] evolves points that lie low on one of the [`functions`],
//! and [`bits`] strings of ones and zeros, both of a [`fixed`] length; [`neat`] grows networks that pass a test.
//!
//! # A problem of one's own
//!
//! is one file that implements [`Problem`](crate::evolution::Problem): what a gene is, how one is drawn and changed,
//! how far two genomes are apart, and what a genome is worth. All else has a default. Here is a knapsack, packed by
//! three islands:
//!
//! ```
//! use islands::runs::config::Config;
//! use islands::archipelago::lockstep;
//! use islands::evolution::variation::sequences::Layout;
//! use islands::evolution::{Evaluation, Problem, Variation};
//! use islands::problems::{Bit, fixed};
//! use islands::rng::Stream;
//! use rand::RngExt;
//!
//! /// Things with a weight in kilograms and a value each, of which some are taken along.
//! struct Knapsack {
//!     things: Vec<(u32, u32)>,
//!     holds_kg: u32,
//! }
//!
//! impl Problem for Knapsack {
//!     type Gene = Bit;
//!
//!     fn random_gene(&self, rng: &mut Stream) -> Bit {
//!         Bit(rng.random_range(0..2))
//!     }
//!
//!     fn random_genome(&self, rng: &mut Stream) -> Vec<Bit> {
//!         self.things.iter().map(|_| self.random_gene(rng)).collect()
//!     }
//!
//!     fn layout(&self) -> Layout {
//!         Layout::Fixed
//!     }
//!
//!     fn mutate_gene(&self, gene: &mut Bit, variation: &Variation, rng: &mut Stream) {
//!         gene.0 ^= u8::from(rng.random_bool(variation.point_rate));
//!     }
//!
//!     fn distance(&self, a: &[Bit], b: &[Bit]) -> f64 {
//!         fixed::distance(a, b, |a, b| f64::from(a.0 ^ b.0))
//!     }
//!
//!     fn evaluate(&self, genome: &[Bit]) -> Evaluation {
//!         let taken = || genome.iter().zip(&self.things).filter(|(bit, _)| bit.0 == 1);
//!         let weight: u32 = taken().map(|(_, (weight, _))| weight).sum();
//!         let value: u32 = taken().map(|(_, (_, value))| value).sum();
//!         // Who packs too much is worth the less the more it is.
//!         let over = f64::from(weight.saturating_sub(self.holds_kg));
//!         Evaluation::scored(if over > 0.0 { -over } else { f64::from(value) })
//!     }
//! }
//!
//! let things = vec![(12, 4), (2, 2), (1, 1), (4, 10), (1, 2), (7, 9), (3, 5)];
//! let problem = Knapsack { things, holds_kg: 15 };
//! let config = Config { islands: 3, point_rate: 0.15, ..Config::default() };
//! let islands = lockstep::run(&problem, &config.archipelago(), 20, |_| ());
//! let best = islands.iter().map(|island| island.champion.fitness).max().unwrap();
//! assert_eq!(best.get(), 26.0);
//! ```

pub mod benchmark;
pub mod bits;
pub mod fixed;
pub mod functions;
pub mod locomotion;
pub mod neat;
pub mod outcomes;
pub mod progress;
pub mod robustness;
mod scoring;
pub mod tasks;
pub mod validation;

pub use benchmark::{Benchmark, Real};
pub use bits::{Bit, Bits, Pattern};
pub use functions::Function;
pub use locomotion::Locomotion;
pub use neat::Neat;
pub use robustness::{RobustBy, Robustness};
pub use tasks::Task;
pub use validation::Validation;
