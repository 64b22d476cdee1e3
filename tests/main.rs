//! The promises of the crate, a module a subject.

mod bodies;
mod chaos;
mod cleaning;
mod cli;
mod climbing;
mod confirmation;
mod course;
mod determinism;
mod exploits;
mod faults;
mod forger;
mod format;
mod hostile;
mod imports;
mod physics;
#[cfg(feature = "view")]
mod recording;
#[cfg(feature = "view")]
mod reel;
#[cfg(feature = "view")]
mod replay;
mod resume;
mod run;
mod support;
mod survival;
mod tidy;
mod verify;
