//! The only way into the wire types and out of them.
//!
//! Any process of the same user can write into shared memory, and memory can change while it is read. So
//! everything received is copied first, and it is the copy that is checked.

use super::wire::{BatchHeader, IndividualHeader, NOBODY, ReportHeader, ResendRequest, WireGene};
use crate::archipelago::migration::MIGRANTS_MAX;
use crate::archipelago::{Archipelago, Champion, Outbox, Report};
use crate::evolution::generation::Effort;
use crate::evolution::{Fitness, Gene, Id, Individual, Outcomes, Spread, Statistics};

/// Why something received was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Rejection {
    /// It belongs to another run.
    #[error("it belongs to another run")]
    Run,
    /// There is no such island, or not in this place.
    #[error("it names an island that cannot have sent it")]
    Island,
    /// There are more migrants than an outbox of this run can have.
    #[error("it has more migrants than an outbox can carry")]
    Count,
    /// A genome is empty or too long, or genomes and payload differ in length.
    #[error("it has a genome that is empty or too long")]
    Length,
    /// A gene may not be used.
    #[error("it has a gene that is not valid")]
    Gene,
    /// A fitness or another number is not one.
    #[error("it has a value that is no number")]
    Number,
    /// Someone's birthplace does not exist.
    #[error("it has an individual that was born nowhere")]
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
    pub champion: Option<Champion<G>>,
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
        champion: Option<&Champion<G>>,
    ) -> Result<ReportHeader, Rejection> {
        let Report { island, generation, statistics, effort, immigrants, species } = *report;
        let header = champion.map(|champion| self.individual_header(&champion.individual));
        let header = header.transpose()?;
        let validated = champion.and_then(|champion| champion.validated);
        Ok(ReportHeader {
            run_id: self.run_id,
            island,
            generation,
            immigrants,
            has_champion: u32::from(champion.is_some()),
            champion: header.unwrap_or_default(),
            validated: validated.map_or(f64::NAN, Fitness::get),
            best: statistics.best.get(),
            mean: statistics.mean.get(),
            median: statistics.median.get(),
            diversity: statistics.diversity,
            phenotype_diversity: statistics.phenotype_diversity,
            spread_low: statistics.spread.low,
            spread_high: statistics.spread.high,
            spread_counts: statistics.spread.counts,
            seconds,
            evaluations: effort.evaluations,
            reused: effort.reused,
            outcomes: effort.outcomes.into(),
            species,
            reserved: 0,
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
            1 => Some(Champion {
                generation: header.generation,
                individual: self.individual(&header.champion, &mut rest)?,
                validated: (!header.validated.is_nan()).then(|| Fitness::new(header.validated)),
            }),
            _ => return Err(Rejection::Count),
        };
        require(rest.is_empty(), Rejection::Length)?;
        let report = Report {
            island: header.island,
            generation: header.generation,
            statistics: statistics(&header)?,
            effort: effort(&header)?,
            immigrants: header.immigrants,
            species: header.species,
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
            origin: from.origin,
            reserved: 0,
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
        let id = self.id(header.id)?;
        require(header.origin <= id.generation, Rejection::Lineage)?;
        Ok(Individual {
            id,
            parents: [mother?, father?],
            origin: header.origin,
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
    let ReportHeader { spread_low: low, spread_high: high, spread_counts: counts, .. } = *header;
    let diversities = [header.diversity, header.phenotype_diversity];
    require(diversities.into_iter().all(f64::is_finite), Rejection::Number)?;
    require(low.is_finite() && high.is_finite() && low <= high, Rejection::Number)?;
    Ok(Statistics {
        spread: Spread { low, high, counts },
        best: fitness(header.best)?,
        mean: fitness(header.mean)?,
        median: fitness(header.median)?,
        diversity: header.diversity,
        phenotype_diversity: header.phenotype_diversity,
    })
}

fn effort(header: &ReportHeader) -> Result<Effort, Rejection> {
    let ReportHeader { evaluations, reused, outcomes, .. } = *header;
    let outcomes = Outcomes::from(outcomes);
    let ended = outcomes.total();
    require(ended == Some(evaluations), Rejection::Number)?;
    Ok(Effort { evaluations, reused, outcomes })
}
