//! Species as NEAT has them (Stanley & Miikkulainen 2002, section 3.3): who is alike shares its fitness, so that what is
//! new competes with its like first and has time to become good.
//!
//! A population is divided anew in each generation: everybody belongs to the first species whose representative, a
//! random one of its members before, is near enough, or founds one. A species has offspring in proportion to its mean
//! fitness (explicit sharing, Goldberg & Richardson 1987), and they replace the whole population but for the champion
//! of each species of more than five.
//!
//! What the paper leaves open is decided here: the best of a species become parents by the selection that a run has; of
//! two parents the fitter is the mother, of equally fit ones the one with the shorter genome; where the least fitness is
//! negative, shares are counted from there; and where all species are stagnant, the one with the best is not.

use super::scheme::Scheme;
use crate::evolution::fitness::Fitness;
use crate::evolution::individual::Individual;
use crate::evolution::population::{Population, ranking};
use crate::evolution::problem::Problem;
use crate::evolution::selection::{Selection, Selector};
use crate::evolution::variation::happens;
use crate::rng::{Purpose, Source, Stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// A species that has not improved for so many generations has no offspring.
const STAGNANT: u32 = 15;
/// Where a whole population has not improved for more than so many generations, only its best two species have offspring.
const STAGNANT_ALL: u32 = 20;
/// The champion of a species of more than this lives on.
const SMALL: usize = 5;
/// The probability that the second of two parents is of another species.
const INTERSPECIES_RATE: f64 = 0.001;

/// A population that is divided into [`Species`]: they pick the parents and say who lives on.
#[derive(Debug, Clone, Copy)]
pub struct Divided {
    /// The distance from which on two individuals are of different species, above 0.
    pub radius: f64,
}

impl Scheme for Divided {
    /// Champions of species live on instead.
    fn has_elites(self) -> bool {
        false
    }

    fn has_selection(self) -> bool {
        true
    }

    fn species_radius(self) -> Option<f64> {
        Some(self.radius)
    }

    fn forgets(self) -> bool {
        false
    }
}

/// When and where a population is divided: everything that its draws depend on.
#[derive(Debug, Clone, Copy)]
pub struct Here {
    /// The island's randomness.
    pub source: Source,
    /// The generation that is being made.
    pub generation: u32,
}

/// The species of a population.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Species {
    /// The number of the species of each individual, in the order of the population.
    of: Vec<u32>,
    /// Those that live, in the order of their numbers.
    living: Vec<One>,
    /// The number of the next one to be founded.
    next: u32,
    /// The best that the population ever was, and since when.
    all: Progress,
}

/// A species.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct One {
    number: u32,
    progress: Progress,
}

/// The best so far, and the generation that it came with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Progress {
    best: Fitness,
    since: u32,
}

impl Progress {
    /// Nothing was seen before `generation`.
    fn begun(generation: u32) -> Self {
        Self { best: Fitness::WORST, since: generation }
    }

    fn see(&mut self, fitness: Fitness, generation: u32) {
        if fitness > self.best {
            *self = Self { best: fitness, since: generation };
        }
    }

    /// Generations for which residents of a generation have not improved.
    fn idle(self, generation: u32) -> u32 {
        generation.saturating_sub(self.since)
    }
}

/// Who may have offspring, and how many.
#[derive(Debug, Clone, PartialEq)]
struct Litter {
    /// Its members, the best first.
    members: Vec<usize>,
    /// Individuals of the next generation, its champion included where that lives on.
    share: usize,
}

impl Litter {
    fn champion(&self) -> Option<usize> {
        (self.members.len() > SMALL && self.share > 0).then(|| self.members[0])
    }

    fn offspring(&self) -> usize {
        self.share - usize::from(self.champion().is_some())
    }
}

impl Species {
    /// Those of generation 0.
    pub fn first<P: Problem>(problem: &P, population: &[Individual<P::Gene>], radius: f64) -> Self {
        let (of, living) = (Vec::new(), Vec::new());
        let mut species = Self { of, living, next: 0, all: Progress::begun(0) };
        let places = Places { representatives: Vec::new(), next: 0, radius };
        species.settle(problem, places, population, 0, |_| None);
        species
    }

    /// Those of the residents `now` of a generation, some of whom immigrants replaced since they were `before`:
    /// immigrants find their species as offspring do.
    pub fn with_immigrants<P: Problem>(
        mut self,
        problem: &P,
        before: &[Individual<P::Gene>],
        now: &[Individual<P::Gene>],
        radius: f64,
        here: Here,
    ) -> Self {
        let places = self.places(before, radius, here, 0);
        let of = std::mem::take(&mut self.of);
        let stays = |place: usize| (before[place].id == now[place].id).then(|| of[place]);
        // They are residents of the generation before the one that is being made.
        self.settle(problem, places, now, here.generation - 1, stays);
        self
    }

    /// Those of the next generation.
    pub fn after<P: Problem>(
        mut self,
        problem: &P,
        old: &[Individual<P::Gene>],
        next: &[Individual<P::Gene>],
        radius: f64,
        here: Here,
    ) -> Self {
        let places = self.places(old, radius, here, 1);
        self.settle(problem, places, next, here.generation, |_| None);
        self
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.living.len()
    }

    /// The number of the species of each individual, in the order of the population.
    pub fn of_each(&self) -> &[u32] {
        &self.of
    }

    /// Whether what was read from a file can be those of a population of this size in this generation.
    pub fn is_sound(&self, individuals: usize, generation: u32) -> bool {
        // A generation divides twice, and no division makes more species than there are individuals.
        let species_max = (2 * u64::from(generation) + 2) * individuals as u64;
        let inhabited: BTreeSet<u32> = self.of.iter().copied().collect();
        let numbers: Vec<u32> = self.living.iter().map(|one| one.number).collect();
        let is_living = |number: &u32| numbers.binary_search(number).is_ok();
        self.of.len() == individuals
            && numbers.is_sorted_by(|a, b| a < b)
            && numbers.iter().all(|number| *number < self.next && inhabited.contains(number))
            && u64::from(self.next) <= species_max
            && self.of.iter().all(is_living)
            && self.living.iter().all(|one| one.progress.since <= generation)
            && self.all.since <= generation
    }

    /// A random member of each species represents it. `draw` tells two divisions of one generation apart.
    fn places<'a, G>(
        &self,
        old: &'a [Individual<G>],
        radius: f64,
        Here { source, generation }: Here,
        draw: u32,
    ) -> Places<'a, G> {
        let mut rng = source.stream(generation, draw, Purpose::Survival);
        let represent = |one: &One| {
            let members: Vec<usize> = self.members(one.number).collect();
            (one.number, &old[members[rng.random_range(0..members.len())]].genome[..])
        };
        let representatives = self.living.iter().map(represent).collect();
        Places { representatives, next: self.next, radius }
    }

    fn members(&self, number: u32) -> impl Iterator<Item = usize> + '_ {
        (0..self.of.len()).filter(move |&index| self.of[index] == number)
    }

    /// Divides a population; `stays` is the species of who need not be placed.
    fn settle<'a, P: Problem>(
        &mut self,
        problem: &P,
        mut places: Places<'a, P::Gene>,
        population: &'a [Individual<P::Gene>],
        generation: u32,
        stays: impl Fn(usize) -> Option<u32>,
    ) {
        let known: BTreeMap<u32, Progress> =
            self.living.iter().map(|one| (one.number, one.progress)).collect();
        let mut living: BTreeMap<u32, Progress> = BTreeMap::new();
        self.of.clear();
        for (place, one) in population.iter().enumerate() {
            let number = stays(place).unwrap_or_else(|| places.find(problem, &one.genome));
            let before = || known.get(&number).copied().unwrap_or(Progress::begun(generation));
            living.entry(number).or_insert_with(before).see(one.fitness, generation);
            self.all.see(one.fitness, generation);
            self.of.push(number);
        }
        self.living =
            living.into_iter().map(|(number, progress)| One { number, progress }).collect();
        self.next = places.next;
    }

    /// The couples of the offspring of a generation, the mother first, which is the fitter of two. There are fewer than
    /// the population has individuals by the champions that live on.
    pub fn couples<G>(
        &self,
        population: &[Individual<G>],
        selection: Selection,
        has_two_parents: impl Fn(usize) -> bool,
        here: Here,
    ) -> Vec<[usize; 2]> {
        let fitness = |litter: &Litter| -> Vec<Fitness> {
            litter.members.iter().map(|&member| population[member].fitness).collect()
        };
        let litters = self.litters(population, here);
        let selectors: Vec<Selector> =
            litters.iter().map(|litter| selection.prepare(&fitness(litter))).collect();
        let pick =
            |litter: usize, rng: &mut Stream| litters[litter].members[selectors[litter].pick(rng)];
        let mothers =
            (0..litters.len()).flat_map(|litter| vec![litter; litters[litter].offspring()]);
        let couple = |(index, litter): (usize, usize)| {
            let rng = &mut here.source.stream(here.generation, index as u32, Purpose::Selection);
            let one = pick(litter, rng);
            if !has_two_parents(index) {
                return [one, one];
            }
            let leaves = litters.len() > 1 && happens(INTERSPECIES_RATE, rng);
            let home = match leaves {
                true => (litter + rng.random_range(1..litters.len())) % litters.len(),
                false => litter,
            };
            let other = pick(home, rng);
            let worth =
                |index: usize| (population[index].fitness, Reverse(population[index].genome.len()));
            if worth(other) > worth(one) { [other, one] } else { [one, other] }
        };
        mothers.enumerate().map(couple).collect()
    }

    /// The next population: the champions that live on, then the offspring.
    pub fn survivors<G: Clone>(
        &self,
        old: &[Individual<G>],
        brood: Population<G>,
        here: Here,
    ) -> Population<G> {
        let litters = self.litters(old, here);
        let champions = litters.iter().filter_map(Litter::champion);
        champions.map(|index| old[index].clone()).chain(brood).collect()
    }

    /// What each species has, in the order of their numbers: together as many as there are.
    fn litters<G>(&self, population: &[Individual<G>], here: Here) -> Vec<Litter> {
        let generation = here.generation - 1;
        let mut members: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for index in ranking(population) {
            members.entry(self.of[index]).or_default().push(index);
        }
        let may: Vec<bool> = self.may_breed(population, &members, generation);
        let least = population.iter().filter_map(|one| one.fitness.finite()).fold(0.0, f64::min);
        let mean = |all: &Vec<usize>| {
            let scores = all.iter().filter_map(|&index| population[index].fitness.finite());
            // Halved, so that no pair of scores overflows.
            scores.map(|score| (score / 2.0 - least / 2.0) / all.len() as f64).sum::<f64>()
        };
        let means: Vec<f64> = members
            .values()
            .zip(&may)
            .map(|(all, may)| if *may { mean(all) } else { 0.0 })
            .collect();
        let has_worth = means.iter().any(|mean| *mean > 0.0);
        let equal = may.iter().map(|may| f64::from(u8::from(*may))).collect();
        let shares = apportion(if has_worth { means } else { equal }, population.len());
        let litter = |(members, share)| Litter { members, share };
        members.into_values().zip(shares).map(litter).collect()
    }

    fn may_breed<G>(
        &self,
        population: &[Individual<G>],
        members: &BTreeMap<u32, Vec<usize>>,
        generation: u32,
    ) -> Vec<bool> {
        let champion = |number: &u32| population[members[number][0]].fitness;
        let mut best: Vec<u32> = members.keys().copied().collect();
        best.sort_by_key(|number| Reverse(champion(number)));
        if self.all.idle(generation) > STAGNANT_ALL {
            return members
                .keys()
                .map(|number| best[..best.len().min(2)].contains(number))
                .collect();
        }
        let may: Vec<bool> =
            self.living.iter().map(|one| one.progress.idle(generation) < STAGNANT).collect();
        match may.contains(&true) {
            true => may,
            false => members.keys().map(|number| *number == best[0]).collect(),
        }
    }
}

/// Representatives of species, among whom newcomers find theirs.
struct Places<'a, G> {
    representatives: Vec<(u32, &'a [G])>,
    next: u32,
    radius: f64,
}

impl<'a, G> Places<'a, G> {
    /// The first species that a genome is near enough to, or a new one that it represents.
    fn find<P: Problem<Gene = G>>(&mut self, problem: &P, genome: &'a [G]) -> u32 {
        let is_near =
            |representative: &[G]| problem.compatibility(genome, representative) < self.radius;
        let found = self.representatives.iter().find(|(_, other)| is_near(other));
        if let Some((number, _)) = found {
            return *number;
        }
        let number = self.next;
        self.next += 1;
        self.representatives.push((number, genome));
        number
    }
}

/// Shares `seats` out in proportion to weights of which one at least is above 0: what is left after whole shares goes to
/// the largest remainders, of equal ones to the first (Hamilton 1792).
fn apportion(weights: Vec<f64>, seats: usize) -> Vec<usize> {
    let total: f64 = weights.iter().sum();
    let quotas: Vec<f64> = weights.iter().map(|weight| weight / total * seats as f64).collect();
    let mut shares: Vec<usize> = quotas.iter().map(|quota| *quota as usize).collect();
    let mut order: Vec<usize> = (0..shares.len()).filter(|&i| weights[i] > 0.0).collect();
    order.sort_by(|&a, &b| (quotas[b] % 1.0).total_cmp(&(quotas[a] % 1.0)));
    let left = seats.saturating_sub(shares.iter().sum());
    order.iter().cycle().take(left).for_each(|&place| shares[place] += 1);
    shares
}
