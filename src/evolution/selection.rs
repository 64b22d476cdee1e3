//! Who becomes a parent.

use super::fitness::Fitness;
use crate::choice;
use crate::rng::Stream;
use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::str::FromStr;
use strum::EnumCount;

/// How parents are picked from a population. An individual that could not be scored is only ever picked
/// where nothing better is to be had.
#[derive(
    Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::Display, strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Selection {
    /// Fitness-proportionate (Holland 1975), shifted so that the smallest score of the population has
    /// no share of the wheel: scores may be negative, and their offset does not matter.
    Roulette,
    /// Stochastic universal sampling (Baker 1987): the shares of the roulette wheel, drawn all at once, so that nobody
    /// gets more than one offspring more or less than expected.
    Sus,
    /// The best of `size` drawn with replacement (Brindle 1981).
    #[strum(to_string = "tournament:{size}")]
    Tournament {
        /// How many compete, at least 1.
        size: u32,
    },
    /// Linear ranking (Baker 1985): the best gets `pressure` expected offspring, the worst 2 - `pressure`.
    #[strum(to_string = "rank:{pressure}")]
    Rank {
        /// From 1 (no pressure) to 2.
        pressure: f64,
    },
    /// Uniformly among the best `fraction` (Mühlenbein & Schlierkamp-Voosen 1993).
    #[strum(to_string = "truncation:{fraction}")]
    Truncation {
        /// Above 0, at most 1; at least one individual is kept.
        fraction: f64,
    },
}

impl FromStr for Selection {
    type Err = String;

    /// Reads what `Display` writes; without its number a scheme takes its usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("selection", &Self::USUAL, text)?;
        match usual {
            Selection::Tournament { size } => {
                Ok(Selection::Tournament { size: scheme.whole(size, 1, 1000)? })
            }
            Selection::Rank { pressure } => {
                Ok(Selection::Rank { pressure: scheme.number(pressure, 1.0, 2.0)? })
            }
            Selection::Truncation { fraction } => {
                Ok(Selection::Truncation { fraction: scheme.number(fraction, 0.001, 1.0)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Selection);

/// A selection scheme made ready for one population: build it once, pick from it often.
#[derive(Debug, Clone)]
pub enum Selector {
    /// Picks in proportion to weights; see [`Wheel`].
    Wheel(Wheel),
    /// The same, with all picks from one spin: see [`Wheel::spin_once`].
    WheelOnce(Wheel),
    /// Holds tournaments of a size.
    Tournament {
        /// The scores competed with, by index.
        fitness: Vec<Fitness>,
        /// How many compete.
        size: u32,
    },
    /// Picks uniformly among indices.
    Pool(Vec<usize>),
}

impl Selection {
    /// One of every kind, with its usual number.
    pub const USUAL: [Selection; Selection::COUNT] = [
        Selection::Roulette,
        Selection::Sus,
        Selection::Tournament { size: 3 },
        Selection::Rank { pressure: 1.8 },
        Selection::Truncation { fraction: 0.3 },
    ];

    /// Makes the scheme ready for a population with these scores.
    ///
    /// # Panics
    /// If `fitness` is empty: nobody can be selected from nobody.
    pub fn prepare(self, fitness: &[Fitness]) -> Selector {
        assert!(!fitness.is_empty(), "selection needs a population");
        match self {
            Selection::Roulette => Selector::Wheel(Wheel::new(&roulette_weights(fitness))),
            Selection::Sus => Selector::WheelOnce(Wheel::new(&roulette_weights(fitness))),
            Selection::Tournament { size } => {
                Selector::Tournament { fitness: fitness.to_vec(), size: size.max(1) }
            }
            Selection::Rank { pressure } => {
                Selector::Wheel(Wheel::new(&rank_weights(fitness, pressure)))
            }
            Selection::Truncation { fraction } => Selector::Pool(fittest(fitness, fraction)),
        }
    }
}

impl Selector {
    /// The indices of the parents of so many couples, each couple from its own stream, or all of them from that of the
    /// first one where they are drawn at once.
    pub fn couples(&self, couples: usize, stream: impl Fn(usize) -> Stream) -> Vec<[usize; 2]> {
        match self {
            Selector::WheelOnce(wheel) => {
                let parents = wheel.spin_once(2 * couples, &mut stream(0));
                parents.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
            }
            _ => {
                let couple = |index| {
                    let mut rng = stream(index);
                    [self.pick(&mut rng), self.pick(&mut rng)]
                };
                (0..couples).map(couple).collect()
            }
        }
    }

    /// The index of one parent.
    pub fn pick(&self, rng: &mut Stream) -> usize {
        match self {
            Selector::Wheel(wheel) | Selector::WheelOnce(wheel) => wheel.spin(rng),
            Selector::Tournament { fitness, size } => {
                let mut draw = || rng.random_range(0..fitness.len());
                let first = draw();
                (1..*size).fold(first, |champion, _| {
                    let challenger = draw();
                    if fitness[challenger] > fitness[champion] { challenger } else { champion }
                })
            }
            Selector::Pool(indices) => indices[rng.random_range(0..indices.len())],
        }
    }
}

/// A roulette wheel: index i comes up in proportion to weight i.
#[derive(Debug, Clone)]
pub struct Wheel {
    // Running sums of the weights, added up serially so that they have the same bits everywhere.
    cumulative: Vec<f64>,
}

impl Wheel {
    /// A wheel with these weights, each finite and at least 0; a wheel without any weight is uniform.
    pub fn new(weights: &[f64]) -> Self {
        let running = |weights: &mut dyn Iterator<Item = f64>| -> Vec<f64> {
            weights
                .scan(0.0, |sum, weight| {
                    *sum += weight;
                    Some(*sum)
                })
                .collect()
        };
        let cumulative = running(&mut weights.iter().copied());
        let has_weight = cumulative.last().is_some_and(|&total| total > 0.0 && total.is_finite());
        if has_weight {
            Self { cumulative }
        } else {
            Self { cumulative: running(&mut weights.iter().map(|_| 1.0)) }
        }
    }

    /// Spins the wheel.
    pub fn spin(&self, rng: &mut Stream) -> usize {
        self.at(rng.random::<f64>() * self.total())
    }

    /// Spins it once with `balls` that lie at equal distances, and returns where they end, in any order.
    pub fn spin_once(&self, balls: usize, rng: &mut Stream) -> Vec<usize> {
        let offset: f64 = rng.random();
        let ball = |i: usize| self.at((i as f64 + offset) / balls as f64 * self.total());
        let mut ends: Vec<usize> = (0..balls).map(ball).collect();
        ends.shuffle(rng);
        ends
    }

    fn total(&self) -> f64 {
        self.cumulative.last().copied().expect("a wheel has at least one weight")
    }

    fn at(&self, ball: f64) -> usize {
        let index = self.cumulative.partition_point(|&sum| sum <= ball);
        // Rounding can let the ball land on the total itself: it then belongs to the last weight.
        index.min(self.last_weighted())
    }

    fn last_weighted(&self) -> usize {
        let total = self.total();
        self.cumulative.partition_point(|&sum| sum < total)
    }
}

/// Each score's height above the smallest finite one; failures get nothing. Where all scores are equal
/// every scored individual gets the same. Halved before subtraction, so that no pair of scores overflows.
fn roulette_weights(fitness: &[Fitness]) -> Vec<f64> {
    let scores = || fitness.iter().filter_map(|f| f.finite());
    let smallest = scores().fold(f64::INFINITY, f64::min);
    let largest = scores().fold(f64::NEG_INFINITY, f64::max);
    let flat = largest <= smallest;
    let span = largest / 2.0 - smallest / 2.0;
    let weight = |score: f64| if flat { 1.0 } else { (score / 2.0 - smallest / 2.0) / span };
    fitness.iter().map(|f| f.finite().map_or(0.0, weight)).collect()
}

/// Linear ranking weights among those that were scored; failures get nothing.
fn rank_weights(fitness: &[Fitness], pressure: f64) -> Vec<f64> {
    let scored: Vec<usize> =
        (0..fitness.len()).filter(|&i| fitness[i].finite().is_some()).collect();
    let mut weights = vec![0.0; fitness.len()];
    let mut order = scored;
    order.sort_by_key(|&i| (fitness[i], Reverse(i)));
    let steps = order.len().saturating_sub(1).max(1) as f64;
    for (rank, &i) in order.iter().enumerate() {
        weights[i] = 2.0 - pressure + 2.0 * (pressure - 1.0) * rank as f64 / steps;
    }
    weights
}

/// The indices of the best `fraction` of all; of equal ones the first.
fn fittest(fitness: &[Fitness], fraction: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..fitness.len()).collect();
    order.sort_by_key(|&i| Reverse(fitness[i]));
    // 7 % of 100 are 7, though the product is a little more.
    let kept = (fitness.len() as f64 * fraction - 1e-9).ceil() as usize;
    order.truncate(kept.clamp(1, fitness.len()));
    let best_failed = fitness[order[0]].finite().is_none();
    order.retain(|&i| best_failed || fitness[i].finite().is_some());
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, Source};

    const SCHEMES: [Selection; 5] = [
        Selection::Roulette,
        Selection::Sus,
        Selection::Tournament { size: 3 },
        Selection::Rank { pressure: 2.0 },
        Selection::Truncation { fraction: 0.5 },
    ];

    fn shares(selection: Selection, scores: &[f64]) -> Vec<f64> {
        let fitness: Vec<Fitness> = scores.iter().map(|&s| Fitness::new(s)).collect();
        let selector = selection.prepare(&fitness);
        let mut rng = Source { seed: 1, island: 0 }.stream(0, 0, Purpose::Selection);
        let spins = 20_000;
        let mut counts = vec![0.0; scores.len()];
        for _ in 0..spins {
            counts[selector.pick(&mut rng)] += 1.0 / f64::from(spins);
        }
        counts
    }

    fn assert_close(shares: &[f64], expected: &[f64]) {
        for (share, expected) in shares.iter().zip(expected) {
            assert!((share - expected).abs() < 0.015, "{shares:?} is not {expected}");
        }
    }

    #[test]
    fn a_roulette_wheel_gives_each_score_its_height_above_the_smallest() {
        assert_close(&shares(Selection::Roulette, &[1.0, 2.0, 4.0]), &[0.0, 0.25, 0.75]);
        assert_close(&shares(Selection::Roulette, &[-3.0, -2.0, 0.0]), &[0.0, 0.25, 0.75]);
        assert_close(&shares(Selection::Roulette, &[-1e308, 0.0, 1e308]), &[0.0, 1. / 3., 2. / 3.]);
    }

    #[test]
    fn universal_sampling_gives_everybody_what_is_expected_to_within_one() {
        let fitness = [1.0, 2.0, 4.0, 1.5].map(Fitness::new);
        let expected = [0.0, 2.0 / 9.0, 6.0 / 9.0, 1.0 / 9.0].map(|share| share * 14.0);
        for seed in 0..50 {
            let stream = |_| Source { seed, island: 0 }.stream(0, 0, Purpose::Selection);
            let couples = Selection::Sus.prepare(&fitness).couples(7, stream);
            for (index, expected) in expected.into_iter().enumerate() {
                let count = couples.iter().flatten().filter(|&&it| it == index).count() as f64;
                assert!((count - expected).abs() < 1.0, "{count} instead of {expected}");
            }
        }
    }

    #[test]
    fn a_tournament_is_won_by_the_best_of_those_drawn() {
        let shares = shares(Selection::Tournament { size: 2 }, &[1.0, 2.0, 3.0]);
        assert_close(&shares, &[1.0 / 9.0, 3.0 / 9.0, 5.0 / 9.0]);
    }

    #[test]
    fn linear_ranking_ignores_the_scale_of_the_scores() {
        let shares = shares(Selection::Rank { pressure: 1.5 }, &[0.001, 1e9, 0.002]);
        assert_close(&shares, &[0.5 / 3.0, 1.5 / 3.0, 1.0 / 3.0]);
    }

    #[test]
    fn truncation_is_uniform_among_the_best_and_knows_nobody_else() {
        let shares = shares(Selection::Truncation { fraction: 0.5 }, &[4.0, 1.0, 3.0, 2.0]);
        assert_close(&shares, &[0.5, 0.0, 0.5, 0.0]);
    }

    #[test]
    fn truncation_keeps_the_share_that_it_names() {
        let hundred: Vec<Fitness> = (0..100).map(f64::from).map(Fitness::new).collect();
        for percent in 1..=100 {
            assert_eq!(fittest(&hundred, f64::from(percent) / 100.0).len(), percent as usize);
        }
        assert_eq!(fittest(&hundred, 0.071).len(), 8);
        assert_eq!(fittest(&hundred[..3], 0.001).len(), 1);
    }

    #[test]
    fn equal_scores_mean_uniform_chances() {
        for scheme in [Selection::Roulette, Selection::Tournament { size: 1 }] {
            assert_close(&shares(scheme, &[2.0; 4]), &[0.25; 4]);
        }
    }

    #[test]
    fn failures_have_no_share_while_anything_was_scored() {
        for scheme in [Selection::Roulette, Selection::Rank { pressure: 1.5 }, SCHEMES[4]] {
            let shares = shares(scheme, &[f64::NAN, 1.0, f64::NEG_INFINITY, 2.0]);
            assert_eq!((shares[0], shares[2]), (0.0, 0.0), "{scheme:?}");
        }
    }

    #[test]
    fn a_scheme_is_read_as_it_is_written() {
        let names = ["roulette", "sus", "tournament:3", "rank:1.8", "truncation:0.3"];
        assert_eq!(Selection::USUAL.map(|scheme| scheme.to_string()), names);
        for scheme in Selection::USUAL.into_iter().chain(SCHEMES) {
            assert_eq!(scheme.to_string().parse(), Ok(scheme));
        }
        assert_eq!("tournament".parse(), Ok(Selection::Tournament { size: 3 }));
        for wrong in ["", "best", "rank:3", "tournament:x", "roulette:1", "truncation:NaN"] {
            assert!(wrong.parse::<Selection>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_scheme_copes_with_a_population_of_failures_and_of_one() {
        for scheme in SCHEMES {
            assert_close(&[shares(scheme, &[f64::NAN; 3]).iter().sum()], &[1.0]);
            assert_eq!(shares(scheme, &[5.0]).len(), 1);
        }
    }
}
