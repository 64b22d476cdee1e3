//! The promises of the crate, a module a subject.

mod asynchrony;
mod bodies;
mod chaos;
mod cleaning;
mod cli;
mod climbing;
mod course;
mod determinism;
mod experiment;
mod exploits;
mod faults;
mod forger;
mod format;
mod hostile;
mod imports;
#[cfg(feature = "view")]
mod onlooker;
mod physics;
mod problems;
mod readers;
mod readme;
#[cfg(feature = "view")]
mod recording;
#[cfg(feature = "view")]
mod reel;
#[cfg(feature = "view")]
mod replay;
mod resume;
mod robustness;
mod run;
mod search;
mod support;
mod survival;
mod tidy;
mod validation;
mod verify;
#[cfg(feature = "view")]
mod watching;
