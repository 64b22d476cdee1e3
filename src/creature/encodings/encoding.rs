//! What an encoding is.

use crate::creature::living::Creature;
use crate::evolution::variation;
use crate::evolution::variation::sequences::Layout;
use crate::evolution::{Gene, Variation};
use crate::rng::Stream;

/// How genes are drawn, how they vary, and how they develop into a body and a brain. How they are read and written
/// follows from what they are made of: [`Gene::values`] is what a file holds a line of, and [`Encoding::columns`] says
/// what each of them is.
pub trait Encoding: Clone + std::fmt::Debug + PartialEq + Send + Sync {
    /// What genomes are sequences of.
    type Gene: Gene;

    /// What a card says of it beside the task, in Markdown.
    fn title(&self) -> String;

    /// What each value of a gene is called.
    fn columns(&self) -> Vec<&'static str>;

    /// What to do about a file with so many columns, which are not [`Encoding::columns`], if it is known where there are
    /// such files.
    fn advice(&self, _columns: usize) -> Option<&'static str> {
        None
    }

    /// A genome for the program that the encoding comes from; by default as it is.
    ///
    /// # Errors
    /// What that program could not build, in a sentence.
    fn exported(&self, genome: &[Self::Gene]) -> Result<Vec<Self::Gene>, String> {
        Ok(genome.to_vec())
    }

    /// Draws a gene.
    fn random_gene(&self, rng: &mut Stream) -> Self::Gene;

    /// Draws a genome.
    fn random_genome(&self, rng: &mut Stream) -> Vec<Self::Gene>;

    /// Whether each place of a genome has its meaning.
    fn layout(&self) -> Layout {
        Layout::Free
    }

    /// Changes a gene by point mutation: each of its values as `variation` says.
    fn mutate_gene(&self, gene: &mut Self::Gene, variation: &Variation, rng: &mut Stream) {
        variation::values::mutate(gene.values_mut(), variation, rng);
    }

    /// Recombines two genomes.
    fn crossover(
        &self,
        a: &[Self::Gene],
        b: &[Self::Gene],
        variation: &Variation,
        rng: &mut Stream,
    ) -> Vec<Self::Gene> {
        variation::recombine(a, b, self.layout(), variation, rng)
    }

    /// Mutates a genome as `variation` says: its values and, where it may be of any length, its genes.
    fn mutate(&self, genome: &mut Vec<Self::Gene>, variation: &Variation, rng: &mut Stream) {
        let mutate_gene = |gene: &mut _, rng: &mut Stream| self.mutate_gene(gene, variation, rng);
        let random_gene = |rng: &mut Stream| self.random_gene(rng);
        let duplicate = |genome: &mut Vec<_>, rng: &mut Stream| {
            self.duplicate(genome, variation.genes_max, rng);
        };
        let layout = self.layout();
        variation::mutate(genome, layout, variation, rng, mutate_gene, random_gene, duplicate);
    }

    /// Repeats a part of a genome within it, if it can and that leaves at most `genes_max` genes: by default it
    /// cannot.
    fn duplicate(&self, _genome: &mut Vec<Self::Gene>, _genes_max: usize, _rng: &mut Stream) {}

    /// How different two genomes are, from 0 (equal) to 1 (nothing in common).
    fn distance(&self, a: &[Self::Gene], b: &[Self::Gene]) -> f64;

    /// Grows the body and the brain of a genome whose genes are all valid.
    ///
    /// # Errors
    /// If the genome describes none that the encoding builds.
    fn express(&self, genome: &[Self::Gene]) -> Result<Creature, ExpressionError>;

    /// How many links the body has that [`Encoding::express`] makes of a genome, found without building it.
    ///
    /// # Errors
    /// As [`Encoding::express`].
    fn count_links(&self, genome: &[Self::Gene]) -> Result<usize, ExpressionError>;

    /// The most links of a body that is not refused, at least 1: what maps and bounds are made for.
    fn links_max(&self) -> usize;
}

/// Why a genome cannot be expressed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionError {
    /// There is nothing to express.
    #[error("the genome has no gene")]
    Empty,
    /// The encoding does not cut this body, which is too large to be built.
    #[error("the body has more than {max} links, the most that {builder} builds")]
    TooManyLinks {
        /// Who builds no more, such as `profile coursework`.
        builder: String,
        /// Its bound.
        max: usize,
    },
}
