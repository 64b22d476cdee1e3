//! From genes to a body that can move.
//!
//! A genome is a sequence of [`Gene`]s, 17 numbers each ([`PARAMETERS`]). A [`Profile`] says what the numbers
//! mean and decodes each gene into [`Traits`]. [`expansion`] copies links by their recurrence into a
//! tree; [`morphology`] gives the tree a body, [`controller`] gives its joints motors. [`express`] does it all:
//!
//! ```
//! use islands::creature::{Gene, Profile, express};
//!
//! let genome = [Gene([0.5; 17]), Gene([0.4; 17])];
//! let creature = express(&genome, Profile::Coursework, 32)?;
//! assert_eq!(creature.morphology.links.len(), 3, "a root, and the second gene's link twice");
//! # Ok::<(), islands::creature::ExpressionError>(())
//! ```
//!
//! Architecture invariant: this knows no physics engine and no evolution. Everything is in f64 and goes through
//! libm, so that the same genes are the same body on every machine.

pub mod controller;
pub mod expansion;
pub mod gene;
pub mod genome;
pub mod morphology;
pub mod profile;
pub mod shape;
pub mod traits;
pub mod waveform;

pub use controller::{Controller, Motor};
pub use expansion::Copy;
pub use gene::{Gene, PARAMETERS, Parameter};
pub use morphology::{Joint, JointKind, Link, Morphology};
pub use profile::Profile;
pub use shape::Shape;
pub use traits::Traits;
pub use waveform::Waveform;

/// A genome expressed, with every stage of its development.
#[derive(Debug, Clone, PartialEq)]
pub struct Creature {
    /// What each gene says, in the order of the genes.
    pub traits: Vec<Traits>,
    /// Which gene became which link, in the order of the links.
    pub tree: Vec<Copy>,
    /// The body.
    pub morphology: Morphology,
    /// What moves it.
    pub controller: Controller,
}

/// Why a genome cannot be expressed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionError {
    /// There is nothing to express.
    #[error("the genome has no gene")]
    Empty,
    /// The profile does not cut bodies, and this one is too large to be built.
    #[error("the body has more than {max} links, the most that profile {profile} builds")]
    TooManyLinks {
        /// The profile.
        profile: Profile,
        /// Its bound.
        max: usize,
    },
}

/// Expresses a genome. A body of more than `links_max` links is cut to the first ones of the expansion's
/// depth-first order; profile `coursework` never cuts, but refuses what is over [`profile::COURSEWORK_LINKS_MAX`].
///
/// # Errors
/// If there is no gene, or too many links for a profile that does not cut.
pub fn express(
    genome: &[Gene],
    profile: Profile,
    links_max: usize,
) -> Result<Creature, ExpressionError> {
    let (traits, tree) = develop(genome, profile, links_max)?;
    let morphology = morphology::build(&traits, &tree, profile);
    let controller = controller::build(&traits, &tree, &morphology, profile);
    Ok(Creature { traits, tree, morphology, controller })
}

/// How many links the body has that [`express`] makes of a genome, found without building it.
///
/// # Errors
/// As [`express`].
pub fn count_links(
    genome: &[Gene],
    profile: Profile,
    links_max: usize,
) -> Result<usize, ExpressionError> {
    develop(genome, profile, links_max).map(|(_, tree)| tree.len())
}

fn develop(
    genome: &[Gene],
    profile: Profile,
    links_max: usize,
) -> Result<(Vec<Traits>, Vec<Copy>), ExpressionError> {
    if genome.is_empty() {
        return Err(ExpressionError::Empty);
    }
    let traits: Vec<Traits> = genome.iter().map(|gene| profile.decode(gene)).collect();
    let parents = genome::parents(&traits);
    let copies: Vec<u32> = traits.iter().map(|t| t.copies).collect();
    let tree = if profile.is_cut() {
        expansion::expand(&parents, &copies, links_max.max(1))
    } else {
        let max = profile::COURSEWORK_LINKS_MAX;
        let tree = expansion::expand(&parents, &copies, max + 1);
        if tree.len() > max {
            return Err(ExpressionError::TooManyLinks { profile, max });
        }
        tree
    };
    Ok((traits, tree))
}
