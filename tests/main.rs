//! The promises of the crate, a module a subject.

mod cli;
mod course;
mod determinism;
mod format;
mod hostile;
mod physics;
#[cfg(feature = "view")]
mod recording;
mod run;
mod support;
mod tidy;
