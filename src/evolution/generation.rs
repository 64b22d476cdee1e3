//! One generation, as a list of named phases: [`select`], [`vary`], [`evaluate`], [`survive`].

use super::fitness::{Evaluation, Fitness, Outcome};
use super::individual::{Id, Individual};
use super::population::Population;
use super::problem::Problem;
use super::selection::Selection;
use super::survival;
use super::variation::{Variation, happens};
use crate::rng::{Purpose, Source};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How one island's population evolves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Strategy {
    /// Individuals, at least 2.
    pub population: usize,
    /// How many of the best live on unchanged, fewer than `population`.
    pub elites: usize,
    /// How parents are picked.
    pub selection: Selection,
    /// How offspring differ from them.
    pub variation: Variation,
}

/// Where the draws of one generation come from and what its children are called.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// The island's randomness.
    pub source: Source,
    /// The generation that is being made.
    pub generation: u32,
}

impl Moment {
    fn id(self, index: usize) -> Id {
        Id { island: self.source.island, generation: self.generation, index: index as u32 }
    }
}

/// A genome that was not evaluated yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Offspring<G> {
    /// What it will be called.
    pub id: Id,
    /// Whom it comes from.
    pub parents: [Option<Id>; 2],
    /// Its genes.
    pub genome: Vec<G>,
}

/// What evaluating a brood cost and how it ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Evaluations that were really run.
    pub evaluations: u64,
    /// Offspring whose fitness was known already: copies of residents, elites and immigrants among them, and of
    /// their own siblings. Elites and immigrants themselves are no offspring, and never evaluated.
    pub reused: u64,
    /// How the evaluations that were run ended, in the order of [`Outcome::ALL`].
    pub outcomes: [u64; Outcome::ALL.len()],
}

impl Effort {
    /// Adds up two efforts.
    pub fn and(mut self, other: Effort) -> Effort {
        // Efforts are also read from files, which may say anything.
        self.evaluations = self.evaluations.saturating_add(other.evaluations);
        self.reused = self.reused.saturating_add(other.reused);
        for (sum, more) in self.outcomes.iter_mut().zip(other.outcomes) {
            *sum = sum.saturating_add(more);
        }
        self
    }

    /// Evaluations that did not end in a score.
    pub fn failures(&self) -> u64 {
        self.evaluations.saturating_sub(self.outcomes[Outcome::Scored as usize])
    }
}

/// The genomes of generation 0: random ones, but for founders.
pub fn genesis<P: Problem>(
    problem: &P,
    strategy: &Strategy,
    source: Source,
) -> Vec<Offspring<P::Gene>> {
    let moment = Moment { source, generation: 0 };
    (0..strategy.population)
        .map(|index| {
            let genome = first(problem, strategy, source, index);
            Offspring { id: moment.id(index), parents: [None; 2], genome }
        })
        .collect()
}

/// Genome number `index` of generation 0: a founder's or, where there is none, a random one.
pub fn first<P: Problem>(
    problem: &P,
    strategy: &Strategy,
    source: Source,
    index: usize,
) -> Vec<P::Gene> {
    let founder = problem.founder(source.island, index, strategy.population);
    founder.unwrap_or_else(|| {
        let mut rng = source.stream(0, index as u32, Purpose::Genesis);
        let mut genome = problem.random_genome(&mut rng);
        genome.truncate(strategy.variation.genes_max);
        genome
    })
}

/// Phase: picks the parents of each offspring, two indices into the population.
pub fn select<G>(
    population: &[Individual<G>],
    strategy: &Strategy,
    moment: Moment,
) -> Vec<[usize; 2]> {
    let fitness: Vec<Fitness> = population.iter().map(|i| i.fitness).collect();
    let selector = strategy.selection.prepare(&fitness);
    let brood = strategy.population - strategy.elites;
    (0..brood)
        .map(|index| {
            let Moment { source, generation } = moment;
            let mut rng = source.stream(generation, index as u32, Purpose::Selection);
            [selector.pick(&mut rng), selector.pick(&mut rng)]
        })
        .collect()
}

/// Phase: recombines and mutates.
pub fn vary<P: Problem>(
    problem: &P,
    population: &[Individual<P::Gene>],
    couples: &[[usize; 2]],
    strategy: &Strategy,
    moment: Moment,
) -> Vec<Offspring<P::Gene>> {
    let offspring = |(index, &[a, b]): (usize, &[usize; 2])| {
        let (mother, father) = (&population[a], &population[b]);
        let (genome, two_parents) =
            breed(problem, strategy, moment, index, &mother.genome, &father.genome);
        let parents = [Some(mother.id), two_parents.then_some(father.id)];
        Offspring { id: moment.id(index), parents, genome }
    };
    couples.iter().enumerate().map(offspring).collect()
}

/// The genome of offspring number `index` of a couple, and whether it has two parents. It depends on nothing
/// else, so that whoever knows all ancestors of an individual can breed it again.
pub fn breed<P: Problem>(
    problem: &P,
    strategy: &Strategy,
    moment: Moment,
    index: usize,
    mother: &[P::Gene],
    father: &[P::Gene],
) -> (Vec<P::Gene>, bool) {
    let stream = |purpose| moment.source.stream(moment.generation, index as u32, purpose);
    let variation = &strategy.variation;
    let mut crossing = stream(Purpose::Crossover);
    let two_parents = happens(variation.crossover_rate, &mut crossing);
    let mut genome = match two_parents {
        true => problem.crossover(mother, father, variation, &mut crossing),
        false => mother.to_vec(),
    };
    problem.mutate(&mut genome, variation, &mut stream(Purpose::Mutation));
    (genome, two_parents)
}

/// A brood that was scored.
#[derive(Debug, Clone, PartialEq)]
pub struct Brood<G> {
    /// Its individuals.
    pub population: Population<G>,
    /// What scoring them cost.
    pub effort: Effort,
    /// The genomes whose evaluation panicked, for whoever looks for the bug.
    pub panicked: Vec<Vec<G>>,
}

/// Phase: scores the offspring. A genome that stands in `known` or twice in the brood is evaluated once
/// at most: evaluation is a pure function of the genome.
pub fn evaluate<P: Problem>(
    problem: &P,
    offspring: Vec<Offspring<P::Gene>>,
    known: &[Individual<P::Gene>],
) -> Brood<P::Gene> {
    fn key<G: super::Gene>(genome: &[G]) -> &[u8] {
        bytemuck::cast_slice(genome)
    }
    let mut fitness: BTreeMap<&[u8], Fitness> =
        known.iter().map(|i| (key(&i.genome), i.fitness)).collect();
    let mut fresh: BTreeMap<&[u8], &[P::Gene]> = BTreeMap::new();
    for child in &offspring {
        if !fitness.contains_key(key(&child.genome)) {
            fresh.insert(key(&child.genome), &child.genome);
        }
    }
    let genomes: Vec<&[P::Gene]> = fresh.into_values().collect();
    let evaluations = problem.evaluate_batch(&genomes);
    let effort = effort(&evaluations, offspring.len());
    let panicked = genomes.iter().zip(&evaluations).filter(|(_, e)| e.outcome == Outcome::Panicked);
    let panicked = panicked.map(|(genome, _)| genome.to_vec()).collect();
    fitness.extend(genomes.iter().zip(&evaluations).map(|(g, e)| (key(g), e.fitness)));

    let scores: Vec<Fitness> = offspring.iter().map(|child| fitness[key(&child.genome)]).collect();
    let population = offspring
        .into_iter()
        .zip(scores)
        .map(|(Offspring { id, parents, genome }, fitness)| Individual {
            id,
            parents,
            genome,
            fitness,
        })
        .collect();
    Brood { population, effort, panicked }
}

fn effort(evaluations: &[Evaluation], offspring: usize) -> Effort {
    let count = |outcome| evaluations.iter().filter(|e| e.outcome == outcome).count() as u64;
    Effort {
        evaluations: evaluations.len() as u64,
        reused: (offspring - evaluations.len()) as u64,
        outcomes: Outcome::ALL.map(count),
    }
}

/// Phase: makes the next population of the old one and its offspring.
pub fn survive<G: Clone>(
    old: &[Individual<G>],
    offspring: Population<G>,
    strategy: &Strategy,
) -> Population<G> {
    survival::elitist(old, offspring, strategy.elites)
}
