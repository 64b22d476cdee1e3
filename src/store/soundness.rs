//! Whether a state that a file holds can be one of this archipelago: evolution relies on it, and a checksum
//! only says that a file is as somebody wrote it.

use crate::archipelago::{Archipelago, Island};
use crate::evolution::generation::Effort;
use crate::evolution::{Gene, Id, Individual};

/// Says what is impossible about a state, if anything.
///
/// # Errors
/// One clause of a sentence.
pub fn check<G: Gene>(island: &Island<G>, archipelago: &Archipelago) -> Result<(), &'static str> {
    let everybody = || island.population.iter().chain([&island.champion]);
    let is_born = |id: Id| id.island < archipelago.islands && id.generation <= island.generation;
    let is_born =
        |one: &Individual<G>| one.parents.into_iter().flatten().chain([one.id]).all(is_born);
    let genes_max = archipelago.strategy.variation.genes_max;
    require(
        island.population.len() == archipelago.strategy.population,
        "its population has another size than the run's",
    )?;
    require(
        everybody().all(|one| (1..=genes_max).contains(&one.genome.len())),
        "it has a genome of an impossible length",
    )?;
    require(
        everybody().all(|one| one.genome.iter().all(Gene::is_valid)),
        "it has a gene that is not valid",
    )?;
    require(everybody().all(is_born), "it has an individual from nowhere")?;
    require(
        everybody().all(|one| one.fitness <= island.champion.fitness),
        "its champion is not its best",
    )?;
    require(is_possible(island, archipelago), "its evaluations do not add up")
}

/// Whether so many evaluations can have been run, and ended in one way each.
fn is_possible<G>(island: &Island<G>, archipelago: &Archipelago) -> bool {
    let Effort { evaluations, reused, outcomes } = island.effort;
    let born =
        (u64::from(island.generation) + 1).saturating_mul(archipelago.strategy.population as u64);
    let ended = outcomes.iter().try_fold(0_u64, |sum, &count| sum.checked_add(count));
    ended == Some(evaluations) && evaluations.checked_add(reused).is_some_and(|sum| sum <= born)
}

fn require(condition: bool, otherwise: &'static str) -> Result<(), &'static str> {
    if condition { Ok(()) } else { Err(otherwise) }
}
