//! The promises of the crate, a module a subject.

mod course;
mod determinism;
mod run;
mod support;
mod tidy;
