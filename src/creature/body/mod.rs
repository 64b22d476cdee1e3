//! Bodies: rigid links in a tree of joints, whatever they were grown from.

pub mod morphology;
pub mod shape;

pub use morphology::{Inertia, Joint, JointKind, Link, Morphology};
pub use shape::Shape;
