//! How evaluations end, and how many ended how.
//!
//! What can fail is a problem's to say: it gives each of its failures a name and a slot to be counted in. There is room
//! for more of them, in memory, in files and between processes, without a new format.

use serde::{Deserialize, Serialize};

/// How an evaluation ended. All but [`Outcome::Scored`] carry [`Fitness::WORST`](super::Fitness::WORST).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// The trial ran to its end.
    Scored,
    /// The genome describes more than may be built, or holds a number outside of its range.
    TooLarge,
    /// A gene is no number, or something that was made of it stopped being one.
    NotFinite,
    /// A failure that the problem names.
    Failed(Failure),
    /// The evaluation panicked: a bug, contained.
    Panicked,
}

/// A failure that a problem names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Failure {
    slot: usize,
    name: &'static str,
}

/// The slots of what every problem can come to; all others are for failures that problems name.
const SCORED: usize = 0;
const TOO_LARGE: usize = 1;
const NOT_FINITE: usize = 2;
const PANICKED: usize = 6;
/// All slots.
const SLOTS: usize = 13;
/// The numbers that hold them in files and between processes.
pub const WORDS: usize = 7;

impl Failure {
    /// A failure with its slot, which nothing else that fails may have, and its name.
    ///
    /// # Panics
    /// If there is no such slot for failures: when the program is compiled, for a constant.
    pub const fn new(slot: usize, name: &'static str) -> Self {
        assert!(slot > NOT_FINITE && slot != PANICKED && slot < SLOTS);
        Self { slot, name }
    }
}

impl Outcome {
    fn slot(self) -> usize {
        match self {
            Outcome::Scored => SCORED,
            Outcome::TooLarge => TOO_LARGE,
            Outcome::NotFinite => NOT_FINITE,
            Outcome::Failed(failure) => failure.slot,
            Outcome::Panicked => PANICKED,
        }
    }
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Outcome::Scored => "scored",
            Outcome::TooLarge => "too large",
            Outcome::NotFinite => "not finite",
            Outcome::Failed(failure) => failure.name,
            Outcome::Panicked => "panicked",
        })
    }
}

/// How many evaluations ended how.
///
/// It is seven numbers, in memory, in files and between processes: the scored, and six that each hold two counts of
/// failures, below 2³² (what is more counts as that many). The lower halves are the failures of format version 1, so that
/// its files read as they are; the upper halves are six slots more.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Outcomes([u64; WORDS]);

impl Outcomes {
    /// How some evaluations ended.
    pub fn of(outcomes: impl IntoIterator<Item = Outcome>) -> Self {
        let mut slots = [0; SLOTS];
        outcomes.into_iter().for_each(|outcome| slots[outcome.slot()] += 1);
        Self::packed(&slots)
    }

    /// How many ended so.
    pub fn count(&self, outcome: Outcome) -> u64 {
        self.slots()[outcome.slot()]
    }

    /// How many there are in all; none if that is more than can be counted.
    pub fn total(&self) -> Option<u64> {
        self.slots().iter().try_fold(0_u64, |sum, &count| sum.checked_add(count))
    }

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        let mut slots = self.slots();
        for (sum, more) in slots.iter_mut().zip(other.slots()) {
            *sum = sum.saturating_add(more);
        }
        Self::packed(&slots)
    }

    fn slots(&self) -> [u64; SLOTS] {
        let mut slots = [0; SLOTS];
        slots[SCORED] = self.0[SCORED];
        for (index, word) in self.0.into_iter().enumerate().skip(1) {
            slots[index] = word & u64::from(u32::MAX);
            slots[index + WORDS - 1] = word >> u32::BITS;
        }
        slots
    }

    fn packed(slots: &[u64; SLOTS]) -> Self {
        let half = |slot: usize| slots[slot].min(u64::from(u32::MAX));
        Self(std::array::from_fn(|index| match index {
            SCORED => slots[SCORED],
            _ => half(index) | (half(index + WORDS - 1) << u32::BITS),
        }))
    }
}

impl From<[u64; WORDS]> for Outcomes {
    fn from(words: [u64; WORDS]) -> Self {
        Self(words)
    }
}

impl From<Outcomes> for [u64; WORDS] {
    fn from(Outcomes(words): Outcomes) -> Self {
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATE: Outcome = Outcome::Failed(Failure::new(12, "late"));
    const EARLY: Outcome = Outcome::Failed(Failure::new(3, "early"));

    #[test]
    fn a_further_failure_has_room_and_those_of_version_1_are_where_they_were() {
        let ended = [Outcome::Scored, Outcome::Scored, EARLY, LATE, LATE, Outcome::Panicked];
        let counts = Outcomes::of(ended);
        assert_eq!((counts.count(LATE), counts.count(EARLY), counts.total()), (2, 1, Some(6)));
        let words: [u64; WORDS] = counts.into();
        assert_eq!(words, [2, 0, 0, 1, 0, 0, 1 | (2 << 32)]);
        assert_eq!(Outcomes::from(words), counts);
        let old = Outcomes::from([9, 1, 2, 3, 4, 5, 6]);
        assert_eq!((old.count(Outcome::Scored), old.count(Outcome::Panicked)), (9, 6));
        assert_eq!((old.count(EARLY), old.count(LATE), old.total()), (3, 0, Some(30)));
    }

    #[test]
    fn counts_that_cannot_be_are_no_number() {
        assert_eq!(Outcomes::from([u64::MAX; WORDS]).total(), None);
        let many = Outcomes::from([u64::MAX; WORDS]);
        assert_eq!(many.and(many).count(Outcome::Scored), u64::MAX);
    }
}
