//! What an island has learned besides a scale.

use super::cma::Cma;
use super::survival::species::Species;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// What an island has learned besides a scale.
#[derive(Debug, Clone, PartialEq)]
pub enum Learned {
    /// Nothing.
    Nothing,
    /// The distribution that offspring are drawn from.
    Cma(Box<Cma>),
    /// The species of its population.
    Species(Box<Species>),
}

// Files hold a byte that says which, and then it: where there are no species, an `Option<Box<Cma>>` as the first
// checkpoints have it, which bincode writes the same.

impl Serialize for Learned {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Learned::Nothing => 0_u8.serialize(to),
            Learned::Cma(cma) => (1_u8, cma).serialize(to),
            Learned::Species(species) => (2_u8, species).serialize(to),
        }
    }
}

impl<'de> Deserialize<'de> for Learned {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_tuple(2, Tagged)
    }
}

struct Tagged;

impl<'de> Visitor<'de> for Tagged {
    type Value = Learned;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("0, or 1 and a distribution, or 2 and species")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Learned, A::Error> {
        let missing = || A::Error::custom("it ends before what was learned");
        match seq.next_element::<u8>()?.ok_or_else(missing)? {
            0 => Ok(Learned::Nothing),
            1 => seq.next_element()?.map(Learned::Cma).ok_or_else(missing),
            2 => seq.next_element()?.map(Learned::Species).ok_or_else(missing),
            other => Err(A::Error::custom(format!("{other} is nothing that can be learned"))),
        }
    }
}
