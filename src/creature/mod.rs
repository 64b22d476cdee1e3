//! From genes to a body that can move.
//!
//! A [`body`] is links in a tree of joints, a [`brain`] says what its motors do, and an [`encoding`](encodings) is how
//! both grow from genes. There is one so far, the [`course`](encodings::course)'s:
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
//! Architecture invariant: this knows no physics engine, and bodies and brains know no genes; of evolution encodings
//! know what varies a genome, and no more. Everything is in f64 and goes through libm, so that the same genes are the
//! same body on every machine.

pub mod body;
pub mod brain;
pub mod encodings;
pub mod living;

pub use body::{Inertia, Joint, JointKind, Link, Morphology, Shape};
pub use brain::{Brain, Controller, Motor, Wave, Waveform};
pub use encodings::course::{
    Copy, Development, Gene, PARAMETERS, Parameter, Profile, Reading, Scales, Traits, count_links,
    develop, express,
};
pub use encodings::{Course, Encoding, ExpressionError};
pub use living::Creature;
