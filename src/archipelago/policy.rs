//! Who is sent, whom immigrants replace, and whether islands wait: the choices that migration has.

use crate::choice;
use crate::evolution::{Individual, Problem};
use crate::rng::Stream;
use rand::RngExt;
use rand::seq::index;
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::str::FromStr;
use strum::EnumCount;

/// Who is sent. No individual is twice in an outbox.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::Display,
    strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Emigrants {
    /// The best.
    #[default]
    Best,
    /// Anybody, all with the same chance.
    Random,
    /// The best of `size` drawn from those who do not travel yet, one tournament after another.
    #[strum(to_string = "tournament:{size}")]
    Tournament {
        /// Contestants, from 1 to [`SIZE_MAX`].
        size: u32,
    },
}

/// The largest tournament.
pub const SIZE_MAX: u32 = 1000;

impl Emigrants {
    /// One of every kind, with its usual number.
    pub const USUAL: [Emigrants; Emigrants::COUNT] =
        [Emigrants::Best, Emigrants::Random, Emigrants::Tournament { size: 3 }];

    /// Chooses `count` individuals out of a `ranking`, or all if there are fewer; the best come first. `draw` gives a
    /// stream of random numbers for each of them.
    pub fn choose(
        self,
        ranking: &[usize],
        count: usize,
        draw: impl Fn(u32) -> Stream,
    ) -> Vec<usize> {
        let count = count.min(ranking.len());
        let mut ranks = match self {
            Emigrants::Best => (0..count).collect(),
            Emigrants::Random => index::sample(&mut draw(0), ranking.len(), count).into_vec(),
            Emigrants::Tournament { size } => {
                let mut left: Vec<usize> = (0..ranking.len()).collect();
                let winner = |slot| {
                    let mut rng = draw(slot);
                    // They are in order: the first of those drawn is the best.
                    let drawn = (0..size.max(1)).map(|_| rng.random_range(0..left.len()));
                    let first = drawn.min().expect("somebody is drawn");
                    left.remove(first)
                };
                (0..count as u32).map(winner).collect()
            }
        };
        ranks.sort_unstable();
        ranks.into_iter().map(|rank| ranking[rank]).collect()
    }
}

/// Whom an immigrant replaces.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::Display,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Replacement {
    /// The worst resident, if the immigrant is better.
    #[default]
    Worst,
    /// Any resident but the best, all with the same chance, also a better one.
    Random,
    /// The resident whose genome is most similar, if the immigrant is better; the worst of several: crowding, as in
    /// De Jong (1975).
    Similar,
}

impl Replacement {
    /// The index of the resident that `migrant` replaces, if any.
    pub fn whom<P: Problem>(
        self,
        problem: &P,
        population: &[Individual<P::Gene>],
        migrant: &Individual<P::Gene>,
        rng: &mut Stream,
    ) -> Option<usize> {
        let all = 0..population.len();
        let worth = |i: usize| (population[i].fitness, Reverse(i));
        let is_better = |&i: &usize| migrant.fitness > population[i].fitness;
        match self {
            Replacement::Worst => all.min_by_key(|&i| worth(i)).filter(is_better),
            Replacement::Random => {
                let best = all.clone().max_by_key(|&i| worth(i))?;
                let drawn = rng.random_range(0..all.len().checked_sub(1).filter(|&n| n > 0)?);
                Some(drawn + usize::from(drawn >= best))
            }
            Replacement::Similar => {
                let distance = |i: usize| problem.distance(&population[i].genome, &migrant.genome);
                let distances: Vec<f64> = all.clone().map(distance).collect();
                let closer = |&a: &usize, &b: &usize| {
                    distances[a].total_cmp(&distances[b]).then_with(|| worth(a).cmp(&worth(b)))
                };
                all.min_by(closer).filter(is_better)
            }
        }
    }
}

/// Whether islands wait for each other.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::Display,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum ExchangeMode {
    /// They do, so that the seed fixes the result.
    #[default]
    Sync,
    /// They take in what has arrived: who takes in what depends on who is fast, and is recorded.
    Async,
}

impl FromStr for Emigrants {
    type Err = String;

    /// Reads what `Display` writes; a tournament without its number is one of three.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("emigrants", &Self::USUAL, text)?;
        match usual {
            Emigrants::Tournament { size } => {
                Ok(Emigrants::Tournament { size: scheme.whole(size, 1, SIZE_MAX)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Emigrants);

choice::one_of!("replacement", Replacement);
choice::one_of!("exchange", ExchangeMode);

#[cfg(test)]
mod tests {
    use super::super::tests::toy::{Bit, Toy};
    use super::*;
    use crate::evolution::{Fitness, Id};
    use crate::rng::{Purpose, Source};

    fn stream(index: u32) -> Stream {
        Source { seed: 1, island: 0 }.stream(0, index, Purpose::Emigration)
    }

    fn individual(ones: usize, fitness: f64) -> Individual<Bit> {
        let genome = (0..8).map(|i| Bit(u8::from(i < ones))).collect();
        let id = Id { island: 0, generation: 0, index: ones as u32 };
        Individual { id, parents: [None; 2], origin: 0, genome, fitness: Fitness::new(fitness) }
    }

    fn residents() -> Vec<Individual<Bit>> {
        vec![individual(1, 5.0), individual(4, 9.0), individual(7, 5.0), individual(8, 6.0)]
    }

    /// How often each resident is replaced in 300 draws; the last number says how often nobody is.
    fn replaced(policy: Replacement, migrant: &Individual<Bit>) -> Vec<usize> {
        let mut counts = vec![0; 5];
        for draw in 0..300 {
            let whom = policy.whom(&Toy, &residents(), migrant, &mut stream(draw));
            counts[whom.unwrap_or(4)] += 1;
        }
        counts
    }

    #[test]
    fn nobody_is_sent_twice_and_the_best_come_first() {
        let ranking = [4, 2, 0, 1, 3];
        for (policy, count) in
            Emigrants::USUAL.into_iter().flat_map(|p| (0..8).map(move |n| (p, n)))
        {
            let draw = |slot| stream(100 * count as u32 + slot);
            let chosen = policy.choose(&ranking, count, draw);
            let ranks: Vec<usize> =
                chosen.iter().map(|i| ranking.iter().position(|j| j == i).unwrap()).collect();
            assert!(ranks.is_sorted_by(|a, b| a < b), "{policy}: {chosen:?}");
            assert_eq!(chosen.len(), count.min(5));
        }
        assert_eq!(Emigrants::Best.choose(&ranking, 2, stream), [4, 2]);
    }

    #[test]
    fn a_policy_sends_each_rank_as_often_as_it_says() {
        for (policy, expected) in [
            (Emigrants::Random, [0.25, 0.25, 0.25, 0.25]),
            // The best of two drawn from four.
            (Emigrants::Tournament { size: 2 }, [7.0 / 16.0, 5.0 / 16.0, 3.0 / 16.0, 1.0 / 16.0]),
            (Emigrants::Best, [1.0, 0.0, 0.0, 0.0]),
        ] {
            let mut shares = [0.0; 4];
            for draw in 0..4_000 {
                for i in policy.choose(&[0, 1, 2, 3], 1, |slot| stream(draw + slot)) {
                    shares[i] += 1.0 / 4_000.0;
                }
            }
            let is_close = shares.iter().zip(expected).all(|(a, b)| f64::abs(a - b) < 0.03);
            assert!(is_close, "{policy}: {shares:?}");
        }
    }

    #[test]
    fn the_worst_gives_way_to_a_better_one_and_of_equal_ones_the_last() {
        assert_eq!(replaced(Replacement::Worst, &individual(2, 5.5)), [0, 0, 300, 0, 0]);
        assert_eq!(replaced(Replacement::Worst, &individual(2, 5.0)), [0, 0, 0, 0, 300]);
    }

    #[test]
    fn anybody_but_the_best_gives_way_at_random() {
        let counts = replaced(Replacement::Random, &individual(2, 1.0));
        assert_eq!((counts[1], counts[4]), (0, 0));
        assert!([0, 2, 3].iter().all(|&i| (70..130).contains(&counts[i])), "{counts:?}");
        let alone = &residents()[..1];
        let whom = Replacement::Random.whom(&Toy, alone, &individual(2, 9.0), &mut stream(0));
        assert_eq!(whom, None);
    }

    #[test]
    fn the_most_similar_gives_way_to_a_better_one() {
        assert_eq!(replaced(Replacement::Similar, &individual(5, 9.5)), [0, 300, 0, 0, 0]);
        assert_eq!(replaced(Replacement::Similar, &individual(5, 8.5)), [0, 0, 0, 0, 300]);
        // As far from the one with four ones as from the one with eight: the worse one goes.
        assert_eq!(replaced(Replacement::Similar, &individual(6, 9.5))[2], 300);
    }

    #[test]
    fn a_policy_is_read_as_it_is_written() {
        for policy in Emigrants::USUAL {
            assert_eq!(policy.to_string().parse(), Ok(policy));
        }
        for policy in Replacement::ALL {
            assert_eq!(policy.to_string().parse(), Ok(policy));
        }
        for mode in ExchangeMode::ALL {
            assert_eq!(mode.to_string().parse(), Ok(mode));
        }
        assert_eq!("tournament".parse(), Ok(Emigrants::Tournament { size: 3 }));
        for wrong in ["", "worst", "best:1", "tournament:0", "tournament:1001", "tournament:x"] {
            assert!(wrong.parse::<Emigrants>().is_err(), "{wrong}");
        }
        assert!("best".parse::<Replacement>().is_err() && "both".parse::<ExchangeMode>().is_err());
    }
}
