//! What crosses the process boundary: plain types of their own.
//!
//! A sample is a slice of genes, all genomes one after the other, and a header that says whose they are.

#![allow(unsafe_code, reason = "ZeroCopySend, implemented or derived, is an unsafe trait")]

use crate::archipelago::migration::MIGRANTS_MAX;
use crate::evolution::population::SPREAD_BARS;
use crate::evolution::{Gene, outcome};
use iceoryx2::prelude::ZeroCopySend;
use std::mem::size_of;

/// A gene as it lies in shared memory: exactly as it lies anywhere else.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(transparent)]
pub struct WireGene<G: Gene>(pub G);

// SAFETY: a gene is `Pod`, so it holds no pointer, reference or padding and every bit pattern is one; the
// name is the gene's own, which changes with its layout.
unsafe impl<G: Gene> ZeroCopySend for WireGene<G> {
    unsafe fn type_name() -> &'static str {
        G::WIRE_NAME
    }
}

/// All of an individual but its genes.
#[derive(Debug, Clone, Copy, Default, PartialEq, ZeroCopySend)]
#[repr(C)]
#[type_name("islands.IndividualHeader.v2")]
pub struct IndividualHeader {
    /// Its fitness, negative infinity for the worst.
    pub fitness: f64,
    /// How many genes of the payload are its genome.
    pub gene_count: u32,
    /// Its birthplace: island, generation, index.
    pub id: [u32; 3],
    /// Its parents' birthplaces, [`NOBODY`] where it has none.
    pub parents: [[u32; 3]; 2],
    /// The generation in which its oldest ancestor was born.
    pub origin: u32,
    /// Zero: makes the padding a field, so that no byte is left to chance.
    pub reserved: u32,
}

/// A parent that does not exist.
pub const NOBODY: [u32; 3] = [u32::MAX; 3];

/// The header of an outbox; the payload is the genomes of its migrants.
#[derive(Debug, Clone, Copy, Default, PartialEq, ZeroCopySend)]
#[repr(C)]
#[type_name("islands.BatchHeader.v2")]
pub struct BatchHeader {
    /// The run that it belongs to.
    pub run_id: u64,
    /// The sender.
    pub island: u32,
    /// The epoch that it ends.
    pub epoch: u32,
    /// How many of `migrants` count.
    pub count: u32,
    /// Zero: makes the padding a field, so that no byte is left to chance.
    pub reserved: u32,
    /// The migrants, in the order of their genomes in the payload.
    pub migrants: [IndividualHeader; MIGRANTS_MAX],
}

/// The header of a report; the payload is the genome of a new champion, or nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, ZeroCopySend)]
#[repr(C)]
#[type_name("islands.ReportHeader.v5")]
pub struct ReportHeader {
    /// The run that it belongs to.
    pub run_id: u64,
    /// The island.
    pub island: u32,
    /// The generation.
    pub generation: u32,
    /// Immigrants that were taken in.
    pub immigrants: u32,
    /// 1 if there is a new champion, else 0.
    pub has_champion: u32,
    /// The new champion, if there is one.
    pub champion: IndividualHeader,
    /// What the new champion is worth on fresh trials; no number if there are none.
    pub validated: f64,
    /// The best fitness.
    pub best: f64,
    /// The mean fitness.
    pub mean: f64,
    /// The median fitness.
    pub median: f64,
    /// The diversity of genomes.
    pub diversity: f64,
    /// The diversity of phenotypes.
    pub phenotype_diversity: f64,
    /// The smallest score.
    pub spread_low: f64,
    /// The largest score.
    pub spread_high: f64,
    /// How many scores lie in each part of the range between them.
    pub spread_counts: [u32; SPREAD_BARS],
    /// Wall seconds that the generation took.
    pub seconds: f64,
    /// Evaluations that were run.
    pub evaluations: u64,
    /// Evaluations that were spared.
    pub reused: u64,
    /// How evaluations ended: [`Outcomes`](crate::evolution::Outcomes) as data.
    pub outcomes: [u64; outcome::WORDS],
    /// Species of the population.
    pub species: u32,
    /// Zero: makes the padding a field, so that no byte is left to chance.
    pub reserved: u32,
}

/// Asks an island to send its outboxes from an epoch on once more.
#[derive(Debug, Clone, Copy, Default, PartialEq, ZeroCopySend)]
#[repr(C)]
#[type_name("islands.ResendRequest.v1")]
pub struct ResendRequest {
    /// The run that it belongs to.
    pub run_id: u64,
    /// Who asks.
    pub asker: u32,
    /// The first epoch that it misses.
    pub epoch: u32,
}

// A changed size is a changed layout: give the type a new name, and only then change the number.
const _: () = assert!(size_of::<IndividualHeader>() == 56);
const _: () = assert!(size_of::<BatchHeader>() == 24 + 56 * MIGRANTS_MAX);
const _: () = assert!(size_of::<ReportHeader>() == 24 + 56 + 11 * 8 + 16 * 4 + 7 * 8 + 8);
const _: () = assert!(size_of::<ResendRequest>() == 16);
