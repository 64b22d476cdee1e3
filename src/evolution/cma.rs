//! CMA-ES, the covariance matrix adaptation evolution strategy, after Hansen's tutorial (2016, arXiv:1604.00772): a
//! baseline for genomes of a fixed number of real values. It restarts with twice as many samples as before: IPOP (Auger
//! & Hansen 2005).
//!
//! A generation has as many samples as an island has individuals, always; an update that needs more waits for several
//! generations.
//!
//! It is written here, and not taken from a library, because its whole state must be what an island saves: a run of it
//! survives a kill like any other.

use super::fitness::Fitness;
use super::variation::values::{normal, reflect};
use crate::rng::Stream;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// The step size to begin with, as a share of the range of a value: 0.3 as the tutorial has it.
pub const FIRST_STEP: f64 = 0.3;

/// A larger step size is of no use, nor is a larger number in a covariance or a path: it has run away.
const SIGMA_MAX: f64 = 1e3;
const COVARIANCE_MAX: f64 = 1e12;

/// So often the number of samples is doubled at most, as in the paper.
const DOUBLINGS_MAX: u32 = 9;
/// An update has no more values in all of its samples than this: they are part of what an island saves.
const VALUES_MAX: usize = 1 << 20;
/// Scores that differ by no more are equal.
const SCORE_TOLERANCE: f64 = 1e-12;

/// The most values of a sample: the covariance has their square, and is taken apart in each generation.
pub const DIMENSIONS_MAX: usize = 1_000;

/// The distribution that samples are drawn from, in a space where every value is from 0 to 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cma {
    /// Its mean.
    mean: Vec<f64>,
    /// Its step size.
    sigma: f64,
    /// Its covariance, column by column.
    covariance: Vec<f64>,
    /// The evolution path of the step size.
    sigma_path: Vec<f64>,
    /// The evolution path of the covariance.
    path: Vec<f64>,
    /// Updates since it began, or began again.
    updates: u32,
    /// How often it began again with twice as many samples as before.
    doublings: u32,
    /// The samples of an update that still needs more.
    waiting: Vec<(Vec<f64>, Fitness)>,
    /// The best scores of the last updates.
    bests: Vec<Fitness>,
}

impl Cma {
    /// A distribution about `mean`.
    pub fn about(mean: Vec<f64>) -> Self {
        let n = mean.len();
        let identity: DMatrix<f64> = DMatrix::identity(n, n);
        Self {
            mean,
            sigma: FIRST_STEP,
            covariance: identity.as_slice().to_vec(),
            sigma_path: vec![0.0; n],
            path: vec![0.0; n],
            updates: 0,
            doublings: 0,
            waiting: Vec::new(),
            bests: Vec::new(),
        }
    }

    /// Whether what was read from a file can be such a state.
    pub fn is_sound(&self) -> bool {
        let n = self.mean.len();
        let lengths = self.sigma_path.len() == n && self.path.len() == n;
        let within = |values: &[f64]| values.iter().all(|value| value.abs() <= COVARIANCE_MAX);
        let is_sample = |(values, _): &(Vec<f64>, Fitness)| {
            values.len() == n && values.iter().all(|value| (0.0..=1.0).contains(value))
        };
        n > 0
            && lengths
            && Some(self.covariance.len()) == n.checked_mul(n)
            && self.sigma > 0.0
            && self.sigma <= SIGMA_MAX
            && self.mean.iter().all(|value| (0.0..=1.0).contains(value))
            && self.doublings <= DOUBLINGS_MAX
            && self.waiting.len().saturating_mul(n) <= VALUES_MAX
            && self.waiting.iter().all(is_sample)
            && self.bests.len() <= history(n, 1)
            && [&self.covariance, &self.sigma_path, &self.path].into_iter().all(|it| within(it))
    }

    /// How many values a sample has.
    pub fn dimensions(&self) -> usize {
        self.mean.len()
    }

    /// What is needed to draw samples.
    pub fn sampler(&self) -> Sampler {
        let Axes { mut directions, lengths } = self.axes();
        // Column by column: how a product of matrices is rounded depends on the processor.
        for (mut direction, length) in directions.column_iter_mut().zip(lengths.iter()) {
            direction *= length * self.sigma;
        }
        Sampler { mean: self.mean.clone(), axes: directions }
    }

    /// Learns from the samples of a generation and what they were worth. If there is nothing to be learned any more,
    /// because the distribution has shrunk to a point, has lost its shape, or finds nothing better, it begins again about
    /// a random place, with twice as many samples.
    pub fn learn(&mut self, samples: &[(Vec<f64>, Fitness)], rng: &mut Stream) {
        // Seeds of another length would have another number of values.
        let is_alike = |(values, _): &(Vec<f64>, Fitness)| values.len() == self.dimensions();
        if samples.is_empty() || !samples.iter().all(is_alike) {
            return;
        }
        self.waiting.extend_from_slice(samples);
        if self.waiting.len() < samples.len() << self.doublings {
            return;
        }
        let all = std::mem::take(&mut self.waiting);
        self.remember_best(&all);
        if self.is_flat(&all) || !self.update(&all) {
            self.begin_again(samples.len(), rng);
        }
    }

    fn begin_again(&mut self, samples: usize, rng: &mut Stream) {
        let more = self.doublings + 1;
        let values = (samples << more).saturating_mul(self.dimensions());
        let doublings =
            if more <= DOUBLINGS_MAX && values <= VALUES_MAX { more } else { self.doublings };
        let mean = (0..self.dimensions()).map(|_| rng.random()).collect();
        *self = Self { doublings, ..Self::about(mean) };
    }

    /// Remembers the best score of an update, beside as many of those before it as matter.
    fn remember_best(&mut self, samples: &[(Vec<f64>, Fitness)]) {
        self.bests.extend(samples.iter().map(|(_, fitness)| *fitness).max());
        let enough = history(self.dimensions(), samples.len());
        self.bests.drain(..self.bests.len().saturating_sub(enough));
    }

    /// Whether the scores of these samples are all the same, or the best ones of all updates that are remembered (TolFun
    /// and its history).
    fn is_flat(&self, samples: &[(Vec<f64>, Fitness)]) -> bool {
        let is_old = self.bests.len() == history(self.dimensions(), samples.len());
        are_equal(samples.iter().map(|(_, fitness)| *fitness))
            || (is_old && are_equal(self.bests.iter().copied()))
    }

    /// One update (equations 38 to 47 of the tutorial, without negative weights); whether the distribution is of use
    /// after it.
    fn update(&mut self, samples: &[(Vec<f64>, Fitness)]) -> bool {
        let rates = Rates::of(self.dimensions(), samples.len());
        let mut order: Vec<&(Vec<f64>, Fitness)> = samples.iter().collect();
        order.sort_by_key(|(_, fitness)| Reverse(*fitness));

        let old = DVector::from_column_slice(&self.mean);
        let step = |values: &[f64]| (DVector::from_column_slice(values) - &old) / self.sigma;
        let steps: Vec<DVector<f64>> =
            order.iter().take(rates.weights.len()).map(|(values, _)| step(values)).collect();
        let weighted = || rates.weights.iter().zip(&steps);
        let mean_step: DVector<f64> =
            weighted().fold(DVector::zeros(old.len()), |sum, (weight, step)| sum + step * *weight);

        self.updates = self.updates.saturating_add(1);
        let Axes { directions, lengths } = self.axes();
        let white = directions.tr_mul(&mean_step).component_div(&lengths);
        let sigma_path = DVector::from_column_slice(&self.sigma_path) * (1.0 - rates.c_sigma)
            + (&directions * white) * libm::sqrt(rates.c_sigma * (2.0 - rates.c_sigma) * rates.mu);
        let faded = 1.0 - libm::pow(1.0 - rates.c_sigma, 2.0 * f64::from(self.updates));
        let is_steady = sigma_path.norm() / libm::sqrt(faded) < rates.stall;
        let h = if is_steady { 1.0 } else { 0.0 };
        let path = DVector::from_column_slice(&self.path) * (1.0 - rates.c_path)
            + &mean_step * (h * libm::sqrt(rates.c_path * (2.0 - rates.c_path) * rates.mu));

        let n = old.len();
        let mut covariance = DMatrix::from_column_slice(n, n, &self.covariance);
        let kept = 1.0 - rates.c_one - rates.c_mu
            + (1.0 - h) * rates.c_one * rates.c_path * (2.0 - rates.c_path);
        covariance *= kept;
        covariance.ger(rates.c_one, &path, &path, 1.0);
        for (weight, step) in weighted() {
            covariance.ger(rates.c_mu * weight, step, step, 1.0);
        }
        self.mean = (&old + &mean_step * self.sigma).as_slice().to_vec();
        self.sigma *=
            libm::exp(rates.c_sigma / rates.damping * (sigma_path.norm() / rates.chi - 1.0));
        (self.covariance, self.path) = (covariance.as_slice().to_vec(), path.as_slice().to_vec());
        self.sigma_path = sigma_path.as_slice().to_vec();
        self.is_of_use()
    }

    fn is_of_use(&self) -> bool {
        if !self.is_sound() {
            return false;
        }
        let lengths = self.axes().lengths;
        let (least, most) = (lengths.min(), lengths.max());
        self.sigma * most > 1e-12 && most < 1e7 * least
    }

    /// The principal axes of the covariance.
    fn axes(&self) -> Axes {
        let n = self.dimensions();
        // Rounding must not let the two halves drift apart.
        let covariance = DMatrix::from_column_slice(n, n, &self.covariance);
        let symmetric = (&covariance + covariance.transpose()) * 0.5;
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(symmetric);
        Axes { directions: eigenvectors, lengths: eigenvalues.map(|it| libm::sqrt(it.max(1e-300))) }
    }
}

/// A distribution that was made ready for drawing.
#[derive(Debug, Clone)]
pub struct Sampler {
    mean: Vec<f64>,
    axes: DMatrix<f64>,
}

impl Sampler {
    /// Draws a sample; what lies outside of the range is mirrored at its ends.
    pub fn draw(&self, rng: &mut Stream) -> Vec<f64> {
        let white = DVector::from_fn(self.mean.len(), |_, _| normal(rng));
        let step = &self.axes * white;
        self.mean.iter().zip(step.iter()).map(|(mean, step)| reflect(mean + step)).collect()
    }
}

/// Whether scores differ by next to nothing.
fn are_equal(scores: impl Iterator<Item = Fitness> + Clone) -> bool {
    let (Some(most), Some(least)) = (scores.clone().max(), scores.min()) else { return true };
    most == least || (most.get() - least.get()).abs() < SCORE_TOLERANCE
}

/// So many updates without anything better are the last: 10 + 30n/λ.
fn history(dimensions: usize, samples: usize) -> usize {
    10 + (30 * dimensions).div_ceil(samples.max(1))
}

struct Axes {
    directions: DMatrix<f64>,
    lengths: DVector<f64>,
}

/// The strategy's parameters (table 1 of the tutorial): they follow from the number of values and of samples.
struct Rates {
    weights: Vec<f64>,
    mu: f64,
    c_sigma: f64,
    damping: f64,
    c_path: f64,
    c_one: f64,
    c_mu: f64,
    chi: f64,
    stall: f64,
}

impl Rates {
    fn of(dimensions: usize, samples: usize) -> Self {
        let n = dimensions as f64;
        let parents = (samples / 2).max(1);
        let raw = |rank: usize| libm::log((samples as f64 + 1.0) / 2.0) - libm::log(rank as f64);
        let raw: Vec<f64> = (1..=parents).map(|rank| raw(rank).max(1e-9)).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let mu = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let c_sigma = (mu + 2.0) / (n + mu + 5.0);
        let c_one = 2.0 / ((n + 1.3) * (n + 1.3) + mu);
        let c_mu = 2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0) * (n + 2.0) + mu);
        let chi = libm::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self {
            mu,
            c_sigma,
            damping: 1.0
                + 2.0 * (libm::sqrt((mu - 1.0).max(0.0) / (n + 1.0)) - 1.0).max(0.0)
                + c_sigma,
            c_path: (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n),
            c_one,
            c_mu: c_mu.clamp(0.0, 1.0 - c_one),
            chi,
            stall: (1.4 + 2.0 / (n + 1.0)) * chi,
            weights,
        }
    }
}

#[cfg(test)]
mod tests;
