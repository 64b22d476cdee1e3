//! What crosses the process boundary: plain types of their own, and the only way in and out of them.
//!
//! A sample is a slice of genes, all genomes one after the other, and a header that says whose they are.
//! Any process of the same user can write into shared memory, and memory can change while it is read. So
//! everything received is copied first, and it is the copy that is checked.

#![allow(unsafe_code, reason = "ZeroCopySend, implemented or derived, is an unsafe trait")]

use crate::archipelago::migration::MIGRANTS_MAX;
use crate::archipelago::{Archipelago, Outbox, Report};
use crate::evolution::generation::Effort;
use crate::evolution::{Fitness, Gene, Id, Individual, Outcome, Statistics};
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
#[type_name("islands.IndividualHeader.v1")]
pub struct IndividualHeader {
    /// Its fitness, negative infinity for the worst.
    pub fitness: f64,
    /// How many genes of the payload are its genome.
    pub gene_count: u32,
    /// Its birthplace: island, generation, index.
    pub id: [u32; 3],
    /// Its parents' birthplaces, [`NOBODY`] where it has none.
    pub parents: [[u32; 3]; 2],
}

/// A parent that does not exist.
pub const NOBODY: [u32; 3] = [u32::MAX; 3];

/// The header of an outbox; the payload is the genomes of its migrants.
#[derive(Debug, Clone, Copy, Default, PartialEq, ZeroCopySend)]
#[repr(C)]
#[type_name("islands.BatchHeader.v1")]
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
#[type_name("islands.ReportHeader.v1")]
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
    /// The best fitness.
    pub best: f64,
    /// The mean fitness.
    pub mean: f64,
    /// The median fitness.
    pub median: f64,
    /// The diversity.
    pub diversity: f64,
    /// Wall seconds that the generation took.
    pub seconds: f64,
    /// Evaluations that were run.
    pub evaluations: u64,
    /// Evaluations that were spared.
    pub reused: u64,
    /// How evaluations ended, in the order of [`Outcome::ALL`].
    pub outcomes: [u64; Outcome::ALL.len()],
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
const _: () = assert!(size_of::<IndividualHeader>() == 48);
const _: () = assert!(size_of::<BatchHeader>() == 24 + 48 * MIGRANTS_MAX);
const _: () = assert!(size_of::<ReportHeader>() == 24 + 48 + 7 * 8 + 6 * 8);
const _: () = assert!(size_of::<ResendRequest>() == 16);

/// Why something received was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Rejection {
    /// It belongs to another run.
    #[error("it belongs to another run")]
    Run,
    /// There is no such island, or not in this place.
    #[error("it names an island that it cannot be from")]
    Island,
    /// There are more migrants than an outbox of this run can have.
    #[error("it has more migrants than an outbox can carry")]
    Count,
    /// A genome is empty or too long, or genomes and payload differ in length.
    #[error("its genomes do not have the lengths that they may have")]
    Length,
    /// A gene may not be used.
    #[error("it has a gene that is not valid")]
    Gene,
    /// A fitness or another number is not one.
    #[error("it has a number that is not one")]
    Number,
    /// Someone's birthplace does not exist.
    #[error("it has an individual from nowhere")]
    Lineage,
}

/// What a report says.
#[derive(Debug, Clone, PartialEq)]
pub struct Sighting<G> {
    /// What the generation was like.
    pub report: Report,
    /// Wall seconds that it took.
    pub seconds: f64,
    /// The island's champion, if it is a new one.
    pub champion: Option<Individual<G>>,
}

/// What everything that travels in one run must respect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The run.
    pub run_id: u64,
    /// Its islands.
    pub islands: u32,
    /// The most migrants of an outbox.
    pub migrants: usize,
    /// The longest genome, in genes.
    pub genes_max: usize,
}

impl Limits {
    /// The limits of the run `run_id` of `archipelago`.
    pub fn of(run_id: u64, archipelago: &Archipelago) -> Self {
        Self {
            run_id,
            islands: archipelago.islands,
            migrants: archipelago.migration.migrants.min(MIGRANTS_MAX),
            genes_max: archipelago.strategy.variation.genes_max,
        }
    }

    /// The header of an outbox, unless the outbox breaks the limits.
    pub fn batch<G>(&self, outbox: &Outbox<G>) -> Result<BatchHeader, Rejection> {
        require(outbox.migrants.len() <= self.migrants, Rejection::Count)?;
        let mut header = BatchHeader {
            run_id: self.run_id,
            island: outbox.island,
            epoch: outbox.epoch,
            count: outbox.migrants.len() as u32,
            ..BatchHeader::default()
        };
        for (slot, migrant) in header.migrants.iter_mut().zip(&outbox.migrants) {
            *slot = self.individual_header(migrant)?;
        }
        Ok(header)
    }

    /// The outbox that a sample says it is, if `source` can have sent it.
    pub fn outbox<G: Gene>(
        &self,
        source: u32,
        header: BatchHeader,
        genes: &[WireGene<G>],
    ) -> Result<Outbox<G>, Rejection> {
        require(header.run_id == self.run_id, Rejection::Run)?;
        require(header.island == source && source < self.islands, Rejection::Island)?;
        require(header.count as usize <= self.migrants, Rejection::Count)?;
        let mut rest = genes;
        let migrants = header.migrants[..header.count as usize]
            .iter()
            .map(|migrant| self.individual(migrant, &mut rest))
            .collect::<Result<Vec<_>, _>>()?;
        require(rest.is_empty(), Rejection::Length)?;
        Ok(Outbox { island: header.island, epoch: header.epoch, migrants })
    }

    /// The header of a report, unless the champion breaks the limits.
    pub fn report<G>(
        &self,
        report: &Report,
        seconds: f64,
        champion: Option<&Individual<G>>,
    ) -> Result<ReportHeader, Rejection> {
        let Report { island, generation, statistics, effort, immigrants } = *report;
        let header = champion.map(|champion| self.individual_header(champion)).transpose()?;
        Ok(ReportHeader {
            run_id: self.run_id,
            island,
            generation,
            immigrants,
            has_champion: u32::from(champion.is_some()),
            champion: header.unwrap_or_default(),
            best: statistics.best.get(),
            mean: statistics.mean.get(),
            median: statistics.median.get(),
            diversity: statistics.diversity,
            seconds,
            evaluations: effort.evaluations,
            reused: effort.reused,
            outcomes: effort.outcomes,
        })
    }

    /// The report that a sample says it is.
    pub fn sighting<G: Gene>(
        &self,
        header: ReportHeader,
        genes: &[WireGene<G>],
    ) -> Result<Sighting<G>, Rejection> {
        require(header.run_id == self.run_id, Rejection::Run)?;
        require(header.island < self.islands, Rejection::Island)?;
        require(header.seconds.is_finite() && header.seconds >= 0.0, Rejection::Number)?;
        let mut rest = genes;
        let champion = match header.has_champion {
            0 => None,
            1 => Some(self.individual(&header.champion, &mut rest)?),
            _ => return Err(Rejection::Count),
        };
        require(rest.is_empty(), Rejection::Length)?;
        let report = Report {
            island: header.island,
            generation: header.generation,
            statistics: statistics(&header)?,
            effort: effort(&header)?,
            immigrants: header.immigrants,
        };
        Ok(Sighting { report, seconds: header.seconds, champion })
    }

    /// The epoch that a request asks for, if one of `askers` made it.
    pub fn requested(&self, request: ResendRequest, askers: &[u32]) -> Result<u32, Rejection> {
        require(request.run_id == self.run_id, Rejection::Run)?;
        require(askers.contains(&request.asker), Rejection::Island)?;
        Ok(request.epoch)
    }

    fn individual_header<G>(&self, from: &Individual<G>) -> Result<IndividualHeader, Rejection> {
        require((1..=self.genes_max).contains(&from.genome.len()), Rejection::Length)?;
        Ok(IndividualHeader {
            fitness: from.fitness.get(),
            gene_count: from.genome.len() as u32,
            id: birthplace(from.id),
            parents: from.parents.map(|parent| parent.map_or(NOBODY, birthplace)),
        })
    }

    fn individual<G: Gene>(
        &self,
        header: &IndividualHeader,
        rest: &mut &[WireGene<G>],
    ) -> Result<Individual<G>, Rejection> {
        let count = header.gene_count as usize;
        require((1..=self.genes_max).contains(&count), Rejection::Length)?;
        let (genes, others) = rest.split_at_checked(count).ok_or(Rejection::Length)?;
        *rest = others;
        let genome: Vec<G> = genes.iter().map(|gene| gene.0).collect();
        require(genome.iter().all(Gene::is_valid), Rejection::Gene)?;
        let [mother, father] = header.parents.map(|parent| self.parent(parent));
        Ok(Individual {
            id: self.id(header.id)?,
            parents: [mother?, father?],
            genome,
            fitness: fitness(header.fitness)?,
        })
    }

    fn parent(&self, parent: [u32; 3]) -> Result<Option<Id>, Rejection> {
        if parent == NOBODY { Ok(None) } else { self.id(parent).map(Some) }
    }

    fn id(&self, [island, generation, index]: [u32; 3]) -> Result<Id, Rejection> {
        require(island < self.islands, Rejection::Lineage)?;
        Ok(Id { island, generation, index })
    }
}

fn require(condition: bool, otherwise: Rejection) -> Result<(), Rejection> {
    if condition { Ok(()) } else { Err(otherwise) }
}

fn birthplace(Id { island, generation, index }: Id) -> [u32; 3] {
    [island, generation, index]
}

// Fitness::new would quietly turn what is no score into the worst one.
fn fitness(score: f64) -> Result<Fitness, Rejection> {
    require(score.is_finite() || score == f64::NEG_INFINITY, Rejection::Number)?;
    Ok(Fitness::new(score))
}

fn statistics(header: &ReportHeader) -> Result<Statistics, Rejection> {
    require(header.diversity.is_finite(), Rejection::Number)?;
    Ok(Statistics {
        best: fitness(header.best)?,
        mean: fitness(header.mean)?,
        median: fitness(header.median)?,
        diversity: header.diversity,
    })
}

fn effort(header: &ReportHeader) -> Result<Effort, Rejection> {
    let ReportHeader { evaluations, reused, outcomes, .. } = *header;
    let ended = outcomes.iter().try_fold(0_u64, |sum, &count| sum.checked_add(count));
    require(ended == Some(evaluations), Rejection::Number)?;
    Ok(Effort { evaluations, reused, outcomes })
}
