//! Every scheme of selection, variation and survival keeps what the rest of the program relies on.

use super::toy::{Toy, archipelago};
use crate::archipelago::{Algorithm, Archipelago, Digest, Lineage, Migration, lockstep};
use crate::evolution::{
    Adaptation, Crossover, Founders, Mutation, Selection, Strategy, Survival, Variation,
};
use std::collections::BTreeMap;

const SELECTIONS: [&str; 5] = ["roulette", "sus", "tournament:2", "rank:1.8", "truncation:0.3"];
const CROSSOVERS: [&str; 5] = ["one-point", "two-point", "uniform", "blend:0.5", "sbx:15"];
const MUTATIONS: [&str; 3] = ["uniform", "gaussian", "polynomial:20"];
/// In the last three of them it is survival that selects.
const SURVIVALS: [&str; 7] =
    ["generational", "drifting", "sharing:0.3", "species:0.3", "crowding", "afpo", "map-elites:4"];
const GENERATIONS: u32 = 12;

fn run(strategy: Strategy) -> Archipelago {
    let usual =
        archipelago(3, 5, Migration { interval: 2, migrants: 2, lag: 1, ..Migration::default() });
    Archipelago { strategy, ..usual }
}

/// Every survival with every selection, crossover, mutation, adaptation and kind of islands, so that each pair meets.
fn strategies() -> Vec<Strategy> {
    let usual =
        archipelago(3, 5, Migration { interval: 2, migrants: 2, lag: 1, ..Migration::default() })
            .strategy;
    let mut strategies = Vec::new();
    for (i, survival) in SURVIVALS.into_iter().enumerate() {
        for (j, selection) in SELECTIONS.into_iter().enumerate() {
            for (k, crossover) in CROSSOVERS.into_iter().enumerate() {
                let variation = Variation {
                    crossover: crossover.parse::<Crossover>().unwrap(),
                    mutation: MUTATIONS[(i + j + k) % 3].parse::<Mutation>().unwrap(),
                    duplicate_rate: 0.2,
                    ..usual.variation
                };
                strategies.push(Strategy {
                    survival: survival.parse::<Survival>().unwrap(),
                    selection: selection.parse::<Selection>().unwrap(),
                    adaptation: Adaptation::ALL[(j + k) % 2],
                    heterogeneous: (i + k) % 2 == 1,
                    variation,
                    ..usual
                });
            }
        }
    }
    strategies
}

#[test]
fn every_state_fits_its_island_and_everybody_can_be_bred_again() {
    let mut digests = std::collections::BTreeSet::new();
    for strategy in strategies() {
        let archipelago = run(strategy);
        let (mut lineage, mut everybody) = (Lineage::default(), BTreeMap::new());
        let islands = lockstep::run(&Toy, &archipelago, GENERATIONS, |step| {
            let island = &step.island;
            assert_eq!(island.fits(&archipelago, island.index), Ok(()), "{strategy:?}");
            let best = island.population.iter().map(|one| one.fitness).max();
            let lives_on =
                best == Some(island.champion.fitness) || strategy.species_radius().is_some();
            assert!(lives_on, "the best lives on: {strategy:?}");
            lineage.push(island.index, step.births.clone());
            everybody.extend(island.population.iter().map(|one| (one.id, one.genome.clone())));
        });
        let ids: Vec<_> = everybody.keys().copied().collect();
        let bred =
            lineage.genomes(&ids, &Toy, &Founders::NONE, &archipelago).expect("nothing is lost");
        assert_eq!(bred, everybody, "{strategy:?}");
        digests.insert(Digest::of(&islands).to_string());
    }
    // Bits are not blended, so that three crossovers are one but for the islands' rates. Within a species universal
    // sampling is the same as a roulette wheel, since each parent is picked alone.
    assert_eq!(digests.len(), 3 * 5 * 4 + 4 * 4 + 3 * 4, "what differs has an effect");
}

#[test]
fn baselines_evaluate_as_many_and_exchange_nothing() {
    let usual = run(Strategy { population: 8, ..strategies()[0] });
    for algorithm in [Algorithm::Random, Algorithm::HillClimb] {
        let archipelago = algorithm.on(usual);
        lockstep::run(&Toy, &archipelago, GENERATIONS, |step| {
            let effort = step.report.effort;
            let born = if step.report.generation == 0 { 8 } else { 7 };
            assert_eq!(effort.evaluations + effort.reused, born, "{algorithm}");
            assert_eq!(step.report.immigrants, 0);
            let parents = step.births.births.iter().flat_map(|birth| birth.parents).flatten();
            match algorithm {
                Algorithm::Random => assert_eq!(parents.count(), 0),
                _ => assert!(parents.map(|id| id.index).max() == parents_of_one(step)),
            }
        });
    }
}

/// A climber's offspring have one mother.
fn parents_of_one(step: &crate::archipelago::Step<super::toy::Bit>) -> Option<u32> {
    let mut mothers: Vec<_> = step.births.births.iter().map(|birth| birth.parents[0]).collect();
    mothers.dedup();
    assert_eq!(mothers.len(), 1);
    mothers[0].map(|id| id.index)
}
