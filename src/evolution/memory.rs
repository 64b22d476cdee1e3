//! What an island knows besides its population.

use super::cma::Cma;
use super::gene::Gene;
use super::individual::Individual;
use super::strategy::{Adaptation, Reproduction, Strategy};
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
    /// The distribution that offspring are drawn from, if they are.
    pub cma: Option<Box<Cma>>,
}

impl Default for Memory {
    fn default() -> Self {
        Self { amount_scale: 1.0, cma: None }
    }
}

impl Memory {
    /// What is known after generation 0: a distribution begins about the centre of its better half.
    pub fn first<G: Gene>(population: &[Individual<G>], strategy: &Strategy) -> Self {
        let cma = (strategy.reproduction == Reproduction::CmaEs).then(|| {
            let order = super::population::ranking(population);
            let better: Vec<Vec<f64>> = order[..order.len().div_ceil(2)]
                .iter()
                .map(|&index| values(&population[index].genome))
                .collect();
            let dimensions = better.iter().map(Vec::len).min().unwrap_or(0);
            let mean = |place: usize| {
                better.iter().map(|values| values[place]).sum::<f64>() / better.len() as f64
            };
            Box::new(Cma::about((0..dimensions).map(mean).collect()))
        });
        Self { cma, ..Self::default() }
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
        if let Some(cma) = &mut self.cma {
            let samples: Vec<_> =
                brood.iter().map(|one| (values(&one.genome), one.fitness)).collect();
            cma.learn(&samples, rng);
        }
        self
    }

    /// Whether what was read from a file can be such a state, of an island with this strategy and population.
    pub fn is_sound<G: Gene>(&self, strategy: &Strategy, population: &[Individual<G>]) -> bool {
        let learns = strategy.reproduction == Reproduction::CmaEs;
        let fits = |cma: &Cma| {
            let is_alike = |one: &Individual<G>| values(&one.genome).len() == cma.dimensions();
            cma.is_sound() && population.iter().all(is_alike)
        };
        Self::is_scale(self.amount_scale, strategy.adaptation)
            && self.cma.is_some() == learns
            && self.cma.as_ref().is_none_or(|cma| fits(cma))
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
