//! What is evaluated, in which order, and what is not; and what an island learns of it.

use super::generation::{Brood, Effort, Offspring, evaluate};
use super::hurdles::Hurdles;
use super::{
    Adaptation, Evaluation, Failure, Fitness, Gene, Id, Individual, Memory, Outcome, Outcomes,
    Problem, Strategy,
};
use crate::rng::{Purpose, Source, Stream};
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};
use std::sync::Mutex;

/// A failure that the problem of these tests names.
const LAUNCHED: Outcome = Outcome::Failed(Failure::new(4, "launched"));

/// A genome is worth the sum of its numbers, costs as much as it is long, fails with a 13 in it and panics with a
/// 66. Who is evaluated is written down.
#[derive(Default)]
struct Ledger(Mutex<Vec<Vec<Number>>>);

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
struct Number(u8);

impl Gene for Number {
    const WIRE_NAME: &'static str = "islands.tests.Number.v1";

    fn is_valid(&self) -> bool {
        true
    }
}

impl Problem for Ledger {
    type Gene = Number;

    fn random_gene(&self, _: &mut Stream) -> Number {
        Number(1)
    }

    fn random_genome(&self, _: &mut Stream) -> Vec<Number> {
        vec![Number(1)]
    }

    fn distance(&self, _: &[Number], _: &[Number]) -> f64 {
        0.0
    }

    fn evaluate(&self, genome: &[Number]) -> Evaluation {
        self.0.lock().unwrap().push(genome.to_vec());
        if genome.contains(&Number(13)) {
            return Evaluation::failed(LAUNCHED);
        }
        if genome.contains(&Number(66)) {
            return Evaluation::failed(Outcome::Panicked);
        }
        Evaluation::scored(genome.iter().map(|number| f64::from(number.0)).sum())
    }

    fn cost(&self, genome: &[Number]) -> u64 {
        genome.len() as u64
    }
}

fn genome(numbers: &[u8]) -> Vec<Number> {
    numbers.iter().copied().map(Number).collect()
}

fn child(numbers: &[u8]) -> Offspring<Number> {
    Offspring { id: NOBODY, parents: [None; 2], origin: 0, genome: genome(numbers) }
}

const NOBODY: Id = Id { island: 0, generation: 0, index: 0 };

#[test]
fn a_batch_is_begun_with_the_dearest_and_scored_in_the_order_given() {
    let genomes = [&[1][..], &[1, 2, 3], &[4, 5], &[6, 13]].map(genome);
    let batch: Vec<&[Number]> = genomes.iter().map(Vec::as_slice).collect();
    let ledger = Ledger::default();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let scores = pool.install(|| ledger.evaluate_batch(&batch));
    let failed = Evaluation::failed(LAUNCHED);
    let scored = [1.0, 6.0, 9.0].map(Evaluation::scored);
    assert_eq!(scores, [&scored[..], &[failed]].concat());
    let begun = ledger.0.into_inner().unwrap();
    assert_eq!(begun, [1, 2, 3, 0].map(|index| genomes[index].clone()));
}

#[test]
fn neither_a_copy_of_a_resident_nor_one_of_an_immigrant_nor_a_twin_is_evaluated() {
    // No evaluation gives them these scores: they are taken as they are.
    let resident = |numbers, fitness| Individual {
        id: NOBODY,
        parents: [None; 2],
        origin: 0,
        genome: genome(numbers),
        fitness: Fitness::new(fitness),
    };
    let (elite, immigrant) = (resident(&[1], 100.0), resident(&[2], 200.0));
    let brood: [&[u8]; 7] = [&[7], &[1], &[3], &[2], &[3], &[1], &[13]];
    let ledger = Ledger::default();
    let brood = brood.map(child).to_vec();
    let Brood { population, effort, .. } =
        evaluate(&ledger, brood, &[elite, immigrant], &Hurdles::NONE);
    let fitness: Vec<f64> = population.iter().map(|child| child.fitness.get()).collect();
    assert_eq!(fitness, [7.0, 100.0, 3.0, 200.0, 3.0, 100.0, f64::NEG_INFINITY]);
    let mut evaluated = ledger.0.into_inner().unwrap();
    evaluated.sort_unstable_by_key(|genome| genome[0].0);
    assert_eq!(evaluated, [&[3][..], &[7], &[13]].map(genome));
    let outcomes = Outcomes::of([Outcome::Scored, LAUNCHED, Outcome::Scored]);
    assert_eq!(effort, Effort { evaluations: 3, reused: 4, outcomes });
}

#[test]
fn the_genomes_that_made_an_evaluation_panic_are_handed_on_once_each() {
    let brood: [&[u8]; 6] = [&[7], &[2, 66], &[13], &[66], &[2, 66], &[1]];
    let brood = evaluate(&Ledger::default(), brood.map(child).to_vec(), &[], &Hurdles::NONE);
    assert_eq!(brood.panicked, [&[2, 66][..], &[66]].map(genome));
    assert_eq!(brood.effort.outcomes.count(Outcome::Panicked), 2);
}

/// The scale of mutation after a generation of ten offspring so many of which are better than their mother.
fn scale_after(successes: u32) -> f64 {
    let one = |index, mother, score| Individual {
        id: Id { index, ..NOBODY },
        parents: [mother, None],
        origin: 0,
        genome: genome(&[1]),
        fitness: Fitness::new(score),
    };
    let score = |index| if index <= successes { 2.0 } else { 1.0 };
    let brood: Vec<_> = (1..=10).map(|index| one(index, Some(NOBODY), score(index))).collect();
    let strategy = Strategy { adaptation: Adaptation::OneFifth, ..Strategy::default() };
    let mut rng = Source { seed: 1, island: 0 }.stream(1, 0, Purpose::Sampling);
    Memory::default().after(&[one(0, None, 1.0)], &brood, &strategy, &mut rng).amount_scale
}

#[test]
fn steps_grow_while_more_than_a_fifth_succeed_and_shrink_while_fewer_do() {
    assert_eq!(scale_after(2), 1.0, "a fifth");
    for successes in [3, 10] {
        assert_eq!(scale_after(successes), 1.0 / 0.85, "{successes} of 10");
    }
    for successes in [0, 1] {
        assert_eq!(scale_after(successes), 0.85, "{successes} of 10: equals are no success");
    }
}
