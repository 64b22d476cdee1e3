//! The promises of the crate, a module a subject.

mod course;
mod tidy;
