//! A verb each.
//!
//! `experiment` compares settings over many runs in this process. `verify` looks whether a run's folder holds what it
//! claims, `clean` removes what a killed launcher left; `evaluate`, `inspect` and `replay` look at single genomes and
//! bodies, `import` takes them in and `export` takes them elsewhere.

pub mod clean;
pub mod evaluate;
pub mod experiment;
pub mod export;
pub mod import;
pub mod inspect;
pub mod replay;
pub mod verify;
