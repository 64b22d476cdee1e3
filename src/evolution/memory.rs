//! What an island knows besides its population.

use super::cma::Cma;
use super::gene::Gene;
use super::individual::Individual;
use super::learned::Learned;
use super::problem::Problem;
use super::strategy::{Adaptation, Reproduction, Strategy};
use super::survival::species::{Here, Species};
use crate::rng::Stream;
use serde::{Deserialize, Serialize};

/// By what the amount of point mutation is multiplied after a generation with many successes, and divided after one
/// with few: Schwefel's factor (1981), 1 / 0.85.
const GROWTH: f64 = 1.0 / 0.85;

/// The share of offspring better than their mother at which nothing changes (Rechenberg 1973).
const SUCCESSES: f64 = 0.2;

/// The range of [`Memory::amount_scale`].
const SCALES: (f64, f64) = (1e-9, 1e3);

/// What an island has learned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// By what the amount of point mutation is multiplied.
    pub amount_scale: f64,
    /// What else there is to know, if there is.
    pub learned: Learned,
}

impl Default for Memory {
    fn default() -> Self {
        Self { amount_scale: 1.0, learned: Learned::Nothing }
    }
}

impl Memory {
    /// What is known after generation 0: a distribution begins about the centre of its better half.
    pub fn first<P: Problem>(
        problem: &P,
        population: &[Individual<P::Gene>],
        strategy: &Strategy,
    ) -> Self {
        let learned = match strategy.species_radius() {
            _ if strategy.reproduction == Reproduction::CmaEs => {
                Learned::Cma(Box::new(Self::first_distribution(population)))
            }
            Some(radius) => Learned::Species(Box::new(Species::first(problem, population, radius))),
            None => Learned::Nothing,
        };
        Self { learned, ..Self::default() }
    }

    fn first_distribution<G: Gene>(population: &[Individual<G>]) -> Cma {
        let order = super::population::ranking(population);
        let better: Vec<Vec<f64>> = order[..order.len().div_ceil(2)]
            .iter()
            .map(|&index| values(&population[index].genome))
            .collect();
        let dimensions = better.iter().map(Vec::len).min().unwrap_or(0);
        let mean = |place: usize| {
            better.iter().map(|values| values[place]).sum::<f64>() / better.len() as f64
        };
        Cma::about((0..dimensions).map(mean).collect())
    }

    /// The distribution that offspring are drawn from, if they are.
    pub fn cma(&self) -> Option<&Cma> {
        match &self.learned {
            Learned::Cma(cma) => Some(cma),
            _ => None,
        }
    }

    /// The species of the population, if it has such.
    pub fn species(&self) -> Option<&Species> {
        match &self.learned {
            Learned::Species(species) => Some(species),
            _ => None,
        }
    }

    /// What is known when immigrants have taken places of those who were there `before`.
    pub fn with_immigrants<P: Problem>(
        self,
        problem: &P,
        before: &[Individual<P::Gene>],
        now: &[Individual<P::Gene>],
        strategy: &Strategy,
        here: Here,
    ) -> Self {
        let divide =
            |species: Species, radius| species.with_immigrants(problem, before, now, radius, here);
        self.divided(strategy, divide)
    }

    /// What is known when the offspring of a population have taken its place.
    pub fn with_heirs<P: Problem>(
        self,
        problem: &P,
        old: &[Individual<P::Gene>],
        next: &[Individual<P::Gene>],
        strategy: &Strategy,
        here: Here,
    ) -> Self {
        self.divided(strategy, |species, radius| species.after(problem, old, next, radius, here))
    }

    fn divided(self, strategy: &Strategy, divide: impl FnOnce(Species, f64) -> Species) -> Self {
        match (self.learned, strategy.species_radius()) {
            (Learned::Species(species), Some(radius)) => {
                Self { learned: Learned::Species(Box::new(divide(*species, radius))), ..self }
            }
            (learned, _) => Self { learned, ..self },
        }
    }

    /// What is known after a generation: `brood` are the offspring of `population`. The stream is drawn from where a
    /// distribution begins again.
    pub fn after<G: Gene>(
        mut self,
        population: &[Individual<G>],
        brood: &[Individual<G>],
        strategy: &Strategy,
        rng: &mut Stream,
    ) -> Self {
        if strategy.adaptation == Adaptation::OneFifth {
            let successes = brood.iter().filter(|child| is_success(child, population)).count();
            let share = successes as f64 / brood.len().max(1) as f64;
            // More than the whole range would only have to be unlearned again.
            let can_grow = strategy.variation.point_amount < 1.0;
            let factor = match share {
                _ if share > SUCCESSES && can_grow => GROWTH,
                _ if share < SUCCESSES => 1.0 / GROWTH,
                _ => 1.0,
            };
            self.amount_scale = (self.amount_scale * factor).clamp(SCALES.0, SCALES.1);
        }
        if let Learned::Cma(cma) = &mut self.learned {
            let samples: Vec<_> =
                brood.iter().map(|one| (values(&one.genome), one.fitness)).collect();
            cma.learn(&samples, rng);
        }
        self
    }

    /// Whether what was read from a file can be such a state, of an island with this strategy and population.
    pub fn is_sound<G: Gene>(
        &self,
        strategy: &Strategy,
        population: &[Individual<G>],
        generation: u32,
    ) -> bool {
        let is_drawn = strategy.reproduction == Reproduction::CmaEs;
        let is_divided = strategy.species_radius().is_some();
        let fits = |cma: &Cma| {
            let is_alike = |one: &Individual<G>| values(&one.genome).len() == cma.dimensions();
            cma.is_sound() && population.iter().all(is_alike)
        };
        Self::is_scale(self.amount_scale, strategy.adaptation)
            && match &self.learned {
                Learned::Nothing => !is_drawn && !is_divided,
                Learned::Cma(cma) => is_drawn && fits(cma),
                Learned::Species(species) => {
                    is_divided && species.is_sound(population.len(), generation)
                }
            }
    }

    /// Whether [`Memory::amount_scale`] can be this.
    pub fn is_scale(scale: f64, adaptation: Adaptation) -> bool {
        match adaptation {
            Adaptation::None => scale == 1.0,
            Adaptation::OneFifth => (SCALES.0..=SCALES.1).contains(&scale),
        }
    }
}

fn is_success<G>(child: &Individual<G>, population: &[Individual<G>]) -> bool {
    let mother = child.parents[0].and_then(|id| population.iter().find(|one| one.id == id));
    mother.is_some_and(|mother| child.fitness > mother.fitness)
}

/// All numbers of a genome, one after the other.
pub fn values<G: Gene>(genome: &[G]) -> Vec<f64> {
    genome.iter().flat_map(Gene::values).copied().collect()
}
