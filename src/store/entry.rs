//! A line of an island's log of reports.

use crate::archipelago::Report;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A generation of an island.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// What it was like.
    pub report: Report,
    /// Wall seconds that it took, waiting included: all in an island's files that the seed does not fix.
    pub seconds: f64,
}

// The number of species is written last: the first logs end before it, and there were no species then.

impl Serialize for Entry {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        (self.report, self.seconds, self.report.species).serialize(to)
    }
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_tuple(3, Parts)
    }
}

struct Parts;

impl<'de> Visitor<'de> for Parts {
    type Value = Entry;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a report, seconds and maybe a number of species")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Entry, A::Error> {
        let missing = || A::Error::custom("it ends before its seconds");
        let report: Report = seq.next_element()?.ok_or_else(missing)?;
        let seconds = seq.next_element()?.ok_or_else(missing)?;
        // The record is whole, since its checksum is right: what is missing was never there.
        let species = seq.next_element().ok().flatten().unwrap_or(0);
        Ok(Entry { report: Report { species, ..report }, seconds })
    }
}
