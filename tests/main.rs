//! The promises of the crate, a module a subject.

mod formats;
mod hostile;
mod physics;
mod program;
mod promises;
mod support;
