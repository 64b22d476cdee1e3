//! From genes to a body and its motors.

use super::expansion::{self, Copy};
use super::gene::Gene;
use super::profile::{self, Profile};
use super::scales::Reading;
use super::traits::Traits;
use super::{genome, links, motors};
use crate::creature::encodings::encoding::ExpressionError;
use crate::creature::living::Creature;

/// How a genome develops: what its genes say, and the links that they become.
#[derive(Debug, Clone, PartialEq)]
pub struct Development {
    /// What each gene says, in the order of the genes.
    pub traits: Vec<Traits>,
    /// Which gene became which link, in the order of the links.
    pub tree: Vec<Copy>,
    profile: Profile,
}

impl Development {
    /// What it leads to.
    pub fn creature(&self) -> Creature {
        let Self { traits, tree, profile } = self;
        let morphology = links::build(traits, tree, *profile);
        let controller = motors::build(traits, tree, &morphology, *profile);
        Creature { morphology, controller }
    }
}

/// Expresses a genome: develops it and builds what that leads to.
///
/// # Errors
/// As [`develop`].
pub fn express(
    genome: &[Gene],
    reading: impl Into<Reading>,
    links_max: usize,
) -> Result<Creature, ExpressionError> {
    Ok(develop(genome, reading, links_max)?.creature())
}

/// How many links the body has that [`express`] makes of a genome, found without building it.
///
/// # Errors
/// As [`develop`].
pub fn count_links(
    genome: &[Gene],
    reading: impl Into<Reading>,
    links_max: usize,
) -> Result<usize, ExpressionError> {
    develop(genome, reading, links_max).map(|development| development.tree.len())
}

/// Develops a genome. A body of more than `links_max` links is cut to the first ones of the expansion's
/// depth-first order; profile `coursework` never cuts, but refuses what is over [`profile::COURSEWORK_LINKS_MAX`].
///
/// # Errors
/// If there is no gene, or too many links for a profile that does not cut.
pub fn develop(
    genome: &[Gene],
    reading: impl Into<Reading>,
    links_max: usize,
) -> Result<Development, ExpressionError> {
    if genome.is_empty() {
        return Err(ExpressionError::Empty);
    }
    let reading = reading.into();
    let profile = reading.profile;
    let traits: Vec<Traits> = genome.iter().map(|gene| reading.decode(gene)).collect();
    let parents = genome::parents(&traits);
    let copies: Vec<u32> = traits.iter().map(|t| t.copies).collect();
    let tree = if profile.is_cut() {
        expansion::expand(&parents, &copies, links_max.max(1))
    } else {
        let max = profile::COURSEWORK_LINKS_MAX;
        let tree = expansion::expand(&parents, &copies, max + 1);
        if tree.len() > max {
            return Err(ExpressionError::TooManyLinks {
                builder: format!("profile {profile}"),
                max,
            });
        }
        tree
    };
    Ok(Development { traits, tree, profile })
}
