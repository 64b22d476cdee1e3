//! Every choice that an archipelago has, with every other: whatever is chosen, the same seed gives the same bits, on
//! any number of threads, in one process and through the protocol, whoever dies.

use super::toy::{Bit, Toy, archipelago};
use super::try_schedule;
use crate::archipelago::{
    Archipelago, Digest, Emigrants, ExchangeMode, Migration, Replacement, Topology, lockstep,
};
use crate::evolution::{Evaluation, Problem, Selection, Survival, Variation};
use crate::rng::Stream;
use rayon::prelude::*;
use std::collections::BTreeSet;

const GENERATIONS: u32 = 9;
/// Schedules of loss and death that each archipelago goes through, in each mode of exchange.
const SCHEDULES: u64 = 3;

const EMIGRANTS: [Emigrants; 3] =
    [Emigrants::Best, Emigrants::Random, Emigrants::Tournament { size: 2 }];
const SELECTIONS: [Selection; 2] = [Selection::Tournament { size: 2 }, Selection::Sus];
const SURVIVALS: [Survival; 7] = [
    Survival::Generational,
    Survival::Drifting,
    Survival::Sharing { radius: 0.3 },
    Survival::Species { radius: 0.3 },
    Survival::Crowding,
    Survival::Afpo,
    Survival::MapElites { bins: 4 },
];

/// Makes a choice in an archipelago.
type Choose = Box<dyn Fn(&mut Archipelago) + Sync>;

/// The choices that there are, the default first: one more is a line more.
fn dimensions() -> Vec<Vec<Choose>> {
    vec![
        dimension(&Topology::ALL, |it, topology| it.topology = topology),
        dimension(&EMIGRANTS, |it, emigrants| it.migration.emigrants = emigrants),
        dimension(&Replacement::ALL, |it, replacement| it.migration.replacement = replacement),
        dimension(&SELECTIONS, |it, selection| it.strategy.selection = selection),
        dimension(&SURVIVALS, |it, survival| it.strategy.survival = survival),
    ]
}

fn dimension<T: Clone + Sync + 'static>(
    choices: &[T],
    choose: fn(&mut Archipelago, T),
) -> Vec<Choose> {
    let choice = |choice: &T| -> Choose {
        let choice = choice.clone();
        Box::new(move |it: &mut Archipelago| choose(it, choice.clone()))
    };
    choices.iter().map(choice).collect()
}

/// All combinations of all choices, in six islands that exchange often.
fn product() -> Vec<Archipelago> {
    let first = archipelago(6, 11, Migration { interval: 1, lag: 0, ..Migration::default() });
    dimensions().into_iter().fold(vec![first], |all, choices| {
        let with = |it: &Archipelago, choose: &Choose| {
            let mut it = *it;
            choose(&mut it);
            it
        };
        all.iter().flat_map(|it| choices.iter().map(move |choose| with(it, choose))).collect()
    })
}

/// The toy, evaluated on as many threads as there are.
struct Shared;

impl Problem for Shared {
    type Gene = Bit;

    fn random_gene(&self, rng: &mut Stream) -> Bit {
        Toy.random_gene(rng)
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Bit> {
        Toy.random_genome(rng)
    }

    fn mutate_gene(&self, gene: &mut Bit, variation: &Variation, rng: &mut Stream) {
        Toy.mutate_gene(gene, variation, rng);
    }

    fn distance(&self, a: &[Bit], b: &[Bit]) -> f64 {
        Toy.distance(a, b)
    }

    fn evaluate(&self, genome: &[Bit]) -> Evaluation {
        Toy.evaluate(genome)
    }

    fn features(&self, genome: &[Bit]) -> [f64; 2] {
        Toy.features(genome)
    }
}

fn digest(problem: &impl Problem<Gene = Bit>, it: &Archipelago) -> String {
    Digest::of(&lockstep::run(problem, it, GENERATIONS, |_| ())).to_string()
}

#[test]
fn whatever_is_chosen_the_number_of_threads_changes_no_digest() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let pools = [1, 3].map(pool);
    for it in product() {
        let expected = digest(&Toy, &it);
        for pool in &pools {
            assert_eq!(pool.install(|| digest(&Shared, &it)), expected, "{it:?}");
        }
    }
}

#[test]
fn whatever_is_chosen_islands_that_lose_and_die_end_in_the_bits_of_the_reference() {
    product().into_par_iter().enumerate().for_each(|(number, it)| {
        for (schedule, exchange) in (0..SCHEDULES).flat_map(|s| ExchangeMode::ALL.map(|e| (s, e))) {
            try_schedule(SCHEDULES * number as u64 + schedule, |schedule| {
                let drawn = schedule.archipelago.migration;
                schedule.archipelago = it;
                let Migration { interval, migrants, lag, .. } = drawn;
                let migration = &mut schedule.archipelago.migration;
                *migration = Migration { interval, migrants, lag, exchange, ..*migration };
            });
        }
    });
}

#[test]
fn every_choice_matters() {
    for choices in dimensions() {
        let digest = |choose: &Choose| {
            let mut it = product().swap_remove(0);
            choose(&mut it);
            digest(&Toy, &it)
        };
        let digests: BTreeSet<String> = choices.iter().map(digest).collect();
        assert_eq!(digests.len(), choices.len());
    }
}
