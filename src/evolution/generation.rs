//! One generation, as a list of named phases: [`reproduce`], which is [`select`] and [`vary`] where there are parents,
//! and [`evaluate`]. Who survives is [`super::survival`]'s.

use super::fitness::{Evaluation, Fitness};
use super::founders::Founders;
use super::gene::Gene;
use super::hurdles::Hurdles;
use super::individual::{Id, Individual};
use super::memory::Memory;
use super::outcome::{Outcome, Outcomes};
use super::population::{Population, ranking};
use super::problem::Problem;
use super::strategy::{Reproduction, Strategy};
use super::survival::species::Here;
use super::variation::happens;
use super::variation::sequences::Layout;
use crate::rng::{Purpose, Source, Stream};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

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

    /// Where a population is divided into species.
    pub fn here(self) -> Here {
        Here { source: self.source, generation: self.generation }
    }

    /// Somebody without parents.
    fn newborn<G>(self, index: usize, genome: Vec<G>) -> Offspring<G> {
        Offspring { id: self.id(index), parents: [None; 2], origin: self.generation, genome }
    }
}

/// A genome that was not evaluated yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Offspring<G> {
    /// What it will be called.
    pub id: Id,
    /// Whom it comes from.
    pub parents: [Option<Id>; 2],
    /// The generation in which its oldest ancestor was born.
    pub origin: u32,
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
    /// How the evaluations that were run ended.
    pub outcomes: Outcomes,
}

impl Effort {
    /// Adds up two efforts.
    pub fn and(mut self, other: Effort) -> Effort {
        // Efforts are also read from files, which may say anything.
        self.evaluations = self.evaluations.saturating_add(other.evaluations);
        self.reused = self.reused.saturating_add(other.reused);
        self.outcomes = self.outcomes.and(other.outcomes);
        self
    }

    /// Evaluations that did not end in a score.
    pub fn failures(&self) -> u64 {
        self.evaluations.saturating_sub(self.outcomes.count(Outcome::Scored))
    }
}

/// The genomes of generation 0: random ones, but for founders.
pub fn genesis<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    strategy: &Strategy,
    source: Source,
) -> Vec<Offspring<P::Gene>> {
    let moment = Moment { source, generation: 0 };
    let newborn = |index| moment.newborn(index, first(problem, founders, strategy, moment, index));
    (0..strategy.population).map(newborn).collect()
}

/// Genome number `index` of those who have no parents: a founder's in generation 0 or, where there is none, a random
/// one.
pub fn first<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    strategy: &Strategy,
    moment: Moment,
    index: usize,
) -> Vec<P::Gene> {
    let founder = founders.of(moment.source.island, index, strategy.population);
    match founder.filter(|_| moment.generation == 0) {
        Some(founder) => founder.to_vec(),
        None => random(problem, strategy, moment, index),
    }
}

/// Random genome number `index` of a generation.
fn random<P: Problem>(
    problem: &P,
    strategy: &Strategy,
    moment: Moment,
    index: usize,
) -> Vec<P::Gene> {
    let mut rng = moment.source.stream(moment.generation, index as u32, Purpose::Genesis);
    let mut genome = problem.random_genome(&mut rng);
    if problem.layout() == Layout::Free {
        genome.truncate(strategy.variation.genes_max);
    }
    genome
}

/// Phase: the offspring of a population. `memory` is what its island has learned.
pub fn reproduce<P: Problem>(
    problem: &P,
    population: &[Individual<P::Gene>],
    memory: &Memory,
    strategy: &Strategy,
    moment: Moment,
) -> Vec<Offspring<P::Gene>> {
    let brood = strategy.brood();
    let random = |index| moment.newborn(index, random(problem, strategy, moment, index));
    match strategy.reproduction {
        Reproduction::Parents if memory.species().is_some() => {
            let two_parents = |index| crossing(strategy, moment, index).0;
            let couples = memory.species().map(|species| {
                species.couples(population, strategy.selection, two_parents, moment.here())
            });
            vary(problem, population, &couples.unwrap_or_default(), strategy, moment)
        }
        Reproduction::Parents => {
            let newcomers = strategy.survival.newcomers().min(brood);
            let couples = select(problem, population, strategy, moment, brood - newcomers);
            let mut offspring = vary(problem, population, &couples, strategy, moment);
            offspring.extend((couples.len()..brood).map(random));
            offspring
        }
        Reproduction::Random => (0..brood).map(random).collect(),
        Reproduction::CmaEs => sample(problem, memory, strategy, moment),
    }
}

/// Offspring drawn from the distribution that an island has learned.
fn sample<P: Problem>(
    problem: &P,
    memory: &Memory,
    strategy: &Strategy,
    moment: Moment,
) -> Vec<Offspring<P::Gene>> {
    let sampler = memory.cma().map(|cma| cma.sampler());
    let draw = |index: usize| {
        // Whatever is no number in a genome stays as in a random one.
        let mut genome = random(problem, strategy, moment, index);
        let mut rng = moment.source.stream(moment.generation, index as u32, Purpose::Sampling);
        let drawn = sampler.as_ref().map(|sampler| sampler.draw(&mut rng)).unwrap_or_default();
        let values = genome.iter_mut().flat_map(Gene::values_mut);
        values.zip(drawn).for_each(|(value, drawn)| *value = drawn);
        moment.newborn(index, genome)
    };
    (0..strategy.brood()).map(draw).collect()
}

/// Phase: picks the parents of each of so many offspring, two indices into the population.
pub fn select<P: Problem>(
    problem: &P,
    population: &[Individual<P::Gene>],
    strategy: &Strategy,
    moment: Moment,
    offspring: usize,
) -> Vec<[usize; 2]> {
    let Moment { source, generation } = moment;
    let stream = |index| source.stream(generation, index as u32, Purpose::Selection);
    strategy.survival.couples(problem, population, strategy.selection, offspring, stream)
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
        let oldest = if two_parents { mother.origin.min(father.origin) } else { mother.origin };
        // Where islands do not wait for each other, parents may come from a later generation.
        let origin = oldest.min(moment.generation);
        Offspring { id: moment.id(index), parents, origin, genome }
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
    let (two_parents, mut crossing) = crossing(strategy, moment, index);
    let mut genome = match two_parents {
        true => problem.crossover(mother, father, variation, &mut crossing),
        false => mother.to_vec(),
    };
    problem.mutate(&mut genome, variation, &mut stream(Purpose::Mutation));
    (genome, two_parents)
}

/// Whether offspring number `index` has two parents, and the stream that they are recombined with.
fn crossing(strategy: &Strategy, moment: Moment, index: usize) -> (bool, Stream) {
    let mut rng = moment.source.stream(moment.generation, index as u32, Purpose::Crossover);
    (happens(strategy.variation.crossover_rate, &mut rng), rng)
}

/// Phase: the next population.
pub fn succeed<P: Problem>(
    problem: &P,
    old: &[Individual<P::Gene>],
    brood: Population<P::Gene>,
    memory: &Memory,
    strategy: &Strategy,
    moment: Moment,
) -> Population<P::Gene> {
    if let Some(species) = memory.species() {
        return species.survivors(old, brood, moment.here());
    }
    let mut fate = moment.source.stream(moment.generation, u32::MAX, Purpose::Survival);
    strategy.survival.survivors(problem, old, brood, strategy.elites, &mut fate)
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

/// Phase: scores the offspring, as far as they get over the hurdles. A genome that stands in `known` or twice in the
/// brood is evaluated once at most: evaluation is a pure function of the genome.
pub fn evaluate<P: Problem>(
    problem: &P,
    offspring: Vec<Offspring<P::Gene>>,
    known: &[Individual<P::Gene>],
    hurdles: &Hurdles,
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
    let evaluations = problem.estimate_batch(&genomes, hurdles);
    let effort = effort(&evaluations, offspring.len());
    let panicked = genomes.iter().zip(&evaluations).filter(|(_, e)| e.outcome == Outcome::Panicked);
    let panicked = panicked.map(|(genome, _)| genome.to_vec()).collect();
    fitness.extend(genomes.iter().zip(&evaluations).map(|(g, e)| (key(g), e.fitness)));

    let scores: Vec<Fitness> = offspring.iter().map(|child| fitness[key(&child.genome)]).collect();
    let population = offspring
        .into_iter()
        .zip(scores)
        .map(|(Offspring { id, parents, origin, genome }, fitness)| Individual {
            id,
            parents,
            origin,
            genome,
            fitness,
        })
        .collect();
    Brood { population, effort, panicked }
}

/// Phase: gives the best of a population its whole score, and whoever is the best then. A judge lowers scores, or
/// confirms the best, so that few have to be judged before one of them is the best.
pub fn judge_best<P: Problem>(problem: &P, population: &mut Population<P::Gene>) {
    if !problem.has_estimates() {
        return;
    }
    let mut judged = BTreeSet::new();
    while let Some(&best) = ranking(population).first().filter(|best| !judged.contains(*best)) {
        population[best].fitness = problem.evaluate(&population[best].genome).fitness;
        judged.insert(best);
    }
}

fn effort(evaluations: &[Evaluation], offspring: usize) -> Effort {
    Effort {
        evaluations: evaluations.len() as u64,
        reused: (offspring - evaluations.len()) as u64,
        outcomes: Outcomes::of(evaluations.iter().map(|e| e.outcome)),
    }
}
