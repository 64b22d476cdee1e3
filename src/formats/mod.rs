//! Files for people and other programs.
//!
//! - [`genome_csv`] reads and writes genomes of every encoding, in the course's format.
//! - [`inspection`] says in JSON what a genome became, link by link; [`body_inspection`] what a body that was read is.
//! - [`vector_csv`] reads and writes genomes of bits or numbers, [`network_csv`] networks, which it also draws.
//! - [`metrics`] are what a run was like, a row an island and generation, as CSV.
//! - [`urdf`] reads and writes bodies for other simulators; [`mjcf`] writes them for MuJoCo, [`stl`] for printers.
//! - [`motion`] is how a body moved.
//! - [`chart`] draws curves with bands, as SVG.
//!
//! Architecture invariant: this alone imports plotters. Nothing here opens a file or changes what it is given; each
//! format reads from any reader or writes to any writer.

pub mod body_inspection;
pub mod chart;
pub mod genome_csv;
pub mod inspection;
pub mod metrics;
pub mod mjcf;
pub mod motion;
pub mod network_csv;
mod rotation;
pub mod stl;
pub mod terrain;
pub mod urdf;
pub mod vector_csv;
mod xml;

pub use body_inspection::BodyInspection;
pub use genome_csv::{GenomeCsvError, ReadGenome};
pub use inspection::Inspection;
pub use vector_csv::VectorCsvError;
