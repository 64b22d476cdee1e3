//! A run as a library: what it is made of, what it began with, and what came out of it.
//!
//! [`config`] is the whole of a run in one struct, and lists every [`setting`]. [`kind`] names every problem;
//! [`catalogue`] makes the one that is meant, and hands it to whoever does something with it; [`subject`] is what a
//! program has to know of it. [`seeds`] are genomes that a run begins with, [`terrains`] what it stands on: its folder
//! keeps a copy of both; [`genome_files`] reads what is named. [`summary`] gathers what the islands wrote, with the
//! champion that is [`kept`], the [`reports`] and, of MAP-Elites, the [map](map_output). A [`Failure`] says what to
//! do.
//!
//! Architecture invariant: nothing here prints, reads a clock or a command line, or starts a process.

pub mod catalogue;
pub mod config;
mod failure;
pub mod genome_files;
pub mod kept;
pub mod kind;
pub mod map_output;
pub mod reports;
pub mod seeds;
pub mod setting;
pub mod subject;
pub mod summary;
pub mod terrains;

pub use failure::{Failure, INTERRUPTED};
