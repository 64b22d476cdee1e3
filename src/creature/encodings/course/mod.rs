//! The encoding of a well-known genetic-algorithms course: a gene is a link, its joint and its motor.
//!
//! A genome is a sequence of [`Gene`]s, 17 numbers each ([`PARAMETERS`]). A [`Profile`] says what the numbers mean, and
//! decodes each gene into [`Traits`]; [`Scales`] may change some. [`genome`] says which gene hangs on which, and
//! [`expansion`] copies links by their recurrence into a tree. [`development`] does it all, and gives the tree a body and
//! its joints motors. [`translation`] says genomes in the terms of the course's program. [`Course`] is the whole as an
//! [`Encoding`].

pub mod development;
pub mod expansion;
pub mod gene;
pub mod genome;
mod links;
mod motors;
pub mod parameters;
pub mod profile;
pub mod scales;
pub mod traits;
pub mod translation;

pub use development::{Development, count_links, develop, express};
pub use expansion::Copy;
pub use gene::{Gene, PARAMETER_COUNT, VALUE_MAX};
pub use parameters::{PARAMETERS, Parameter, Use};
pub use profile::Profile;
pub use scales::{Reading, Rescaling, Scales};
pub use traits::{SolidKind, Traits};

use super::encoding::{Encoding, ExpressionError};
use crate::creature::living::Creature;
use crate::rng::Stream;
use rand::RngExt;

/// The course's encoding, as it is read and drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// How genes are read.
    pub profile: Profile,
    /// Scales of profile `coursework` that were changed.
    pub scales: Scales,
    /// Genes of a random genome, at least 1.
    pub genes: usize,
    /// The most links of a body, for profiles that cut.
    pub links_max: usize,
}

impl Default for Course {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Course {
    /// What a run uses if nothing else is said.
    pub const DEFAULT: Self =
        Self { profile: Profile::Native, scales: Scales::NONE, genes: 4, links_max: 16 };

    /// How genes are read.
    pub fn reading(&self) -> Reading {
        Reading { profile: self.profile, scales: self.scales }
    }
}

impl Encoding for Course {
    type Gene = Gene;

    fn columns(&self) -> Vec<&'static str> {
        PARAMETERS.iter().map(|parameter| parameter.name).collect()
    }

    /// Changed course programs write 18 and 19 numbers a gene.
    fn advice(&self, columns: usize) -> Option<&'static str> {
        match columns {
            18 => Some("leave out the additional one, link-geometry, usually with --drop-column 6"),
            19 => Some(
                "leave out the additional ones, sensor gain and bias, usually with --drop-column 18 --drop-column 19",
            ),
            _ => None,
        }
    }

    /// In the terms of the course's program.
    fn exported(&self, genome: &[Gene]) -> Result<Vec<Gene>, String> {
        translation::translate(genome, &self.reading()).map_err(|error| error.to_string())
    }

    fn title(&self) -> String {
        format!("profile **{}**", self.profile)
    }

    fn random_gene(&self, rng: &mut Stream) -> Gene {
        Gene(std::array::from_fn(|_| rng.random()))
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Gene> {
        (0..self.genes).map(|_| self.random_gene(rng)).collect()
    }

    /// Appends a copy of a limb, with all that it carries, to whom the limb is on: a new gene for each of the old ones,
    /// as they are but for who their parents are.
    fn duplicate(&self, genome: &mut Vec<Gene>, genes_max: usize, rng: &mut Stream) {
        if genome.len() > 1 {
            let limb = rng.random_range(1..genome.len());
            genome::duplicate(genome, limb, genes_max);
        }
    }

    /// The mean absolute difference of the values of genes in the same place; a gene that only one of them has
    /// counts as wholly different.
    fn distance(&self, a: &[Gene], b: &[Gene]) -> f64 {
        let shared: f64 = a.iter().zip(b).map(|(a, b)| gene_distance(a, b)).sum();
        let longer = a.len().max(b.len());
        if longer == 0 {
            return 0.0;
        }
        (shared + a.len().abs_diff(b.len()) as f64) / longer as f64
    }

    fn express(&self, genome: &[Gene]) -> Result<Creature, ExpressionError> {
        express(genome, self.reading(), self.links_max)
    }

    fn count_links(&self, genome: &[Gene]) -> Result<usize, ExpressionError> {
        count_links(genome, self.reading(), self.links_max)
    }

    fn links_max(&self) -> usize {
        self.links_max.max(1)
    }
}

fn gene_distance(a: &Gene, b: &Gene) -> f64 {
    a.0.iter().zip(&b.0).map(|(a, b)| (a - b).abs()).sum::<f64>() / PARAMETER_COUNT as f64
}
