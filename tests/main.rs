//! The promises of the crate, a module a subject.

mod cli;
mod course;
mod determinism;
mod run;
mod support;
mod tidy;
