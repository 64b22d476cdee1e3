//! Encodings: how genes become a body and a brain.
//!
//! Each is a folder that implements [`Encoding`]. The one that there is so far is the [`course`]'s: 17 numbers a gene.

pub mod course;
pub mod encoding;

pub use course::Course;
pub use encoding::{Encoding, ExpressionError};
