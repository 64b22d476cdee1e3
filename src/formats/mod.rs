//! Files for people and other programs.
//!
//! - [`genome_csv`] reads and writes genomes, in the course's format.
//! - [`inspection`] says in JSON what a genome became, link by link.
//! - [`metrics`] are what a run was like, a row an island and generation, as CSV.
//! - [`urdf`] writes a body for other simulators.
//!
//! Architecture invariant: nothing here opens a file or changes what it is given; each format reads from any
//! reader or writes to any writer.

pub mod genome_csv;
pub mod inspection;
pub mod metrics;
mod rotation;
pub mod urdf;

pub use genome_csv::{GenomeCsvError, ReadGenome};
pub use inspection::Inspection;
