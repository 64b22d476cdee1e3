//! The promises of the crate, a module a subject.

mod chaos;
mod cli;
mod course;
mod determinism;
mod faults;
mod forger;
mod physics;
#[cfg(feature = "view")]
mod recording;
mod resume;
mod run;
mod support;
mod survival;
mod tidy;
