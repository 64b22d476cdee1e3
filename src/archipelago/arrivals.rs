//! Exchange in which nobody waits: what has arrived is taken in, and what was taken in is recorded.
//!
//! Who takes in what depends on who is fast, so the seed alone does not fix the result; the record does. An island
//! writes down what it takes in before it evolves with it. One that is born again takes the same in again, out of its
//! neighbours' journals, as far as its record reaches, so that whatever it had sent stays true; then it is free again.

use super::migration::Outbox;
use super::{Archipelago, Arrival};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};

/// What an island took in at the beginning of an epoch: its record has one for each, in order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Arrivals {
    /// The generation that began.
    pub generation: u32,
    /// The outboxes: sender and epoch, by sender.
    pub taken: Vec<(u32, u32)>,
}

/// The receiving end where nobody waits.
#[derive(Debug, Clone)]
pub struct Mailbox<G> {
    sources: Vec<u32>,
    /// What has arrived, the newest of each source, if it is newer than what was taken.
    newest: BTreeMap<u32, Outbox<G>>,
    /// The newest epoch of each source that was taken.
    taken: BTreeMap<u32, u32>,
    /// What the record says of epochs that are to begin again.
    script: VecDeque<Arrivals>,
    /// Outboxes of the script's first entry.
    recalled: BTreeMap<u32, Outbox<G>>,
    /// What the next generation takes in, on record.
    ready: Option<Vec<Outbox<G>>>,
}

/// What is to be done before an epoch can begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Errand {
    /// What it takes in is to be recorded.
    Record(Arrivals),
    /// These outboxes are to be read in their senders' journals, since they were taken in before.
    Recall(Vec<(u32, u32)>),
}

impl<G: Clone> Mailbox<G> {
    /// A mailbox for outboxes of these in-neighbours, of an island that has evolved `generation` and whose earlier
    /// lives recorded this; none if it begins from its seed.
    pub fn new(sources: Vec<u32>, generation: Option<u32>, record: Vec<Arrivals>) -> Self {
        let is_over = |entry: &Arrivals| generation.is_some_and(|g| entry.generation <= g);
        let (over, script): (Vec<_>, Vec<_>) = record.into_iter().partition(is_over);
        let taken = over.into_iter().flat_map(|entry| entry.taken).collect();
        let (newest, recalled) = (BTreeMap::new(), BTreeMap::new());
        Self { sources, newest, taken, script: script.into(), recalled, ready: None }
    }

    /// Hands in what arrived.
    pub fn accept(&mut self, outbox: Outbox<G>) -> Arrival {
        let Outbox { island, epoch, .. } = outbox;
        let newest = self.newest.get(&island).map(|outbox| outbox.epoch);
        if !self.sources.contains(&island) {
            Arrival::Stranger
        } else if newest == Some(epoch) {
            Arrival::Duplicate
        } else if newest.max(self.taken.get(&island).copied()) >= Some(epoch) {
            Arrival::Stale
        } else {
            self.newest.insert(island, outbox);
            Arrival::Kept
        }
    }

    /// Hands in what was read in a journal. What was not asked for is left out.
    pub fn recall(&mut self, outbox: Outbox<G>) {
        let wanted = (outbox.island, outbox.epoch);
        if self.script.front().is_some_and(|entry| entry.taken.contains(&wanted)) {
            self.recalled.insert(outbox.island, outbox);
        }
    }

    /// What is to be done before the epoch that begins with `generation` can; nothing if [`Mailbox::take`] can be
    /// called. What is to be recorded counts as recorded at the next call.
    pub fn prepare(&mut self, generation: u32) -> Option<Errand> {
        if self.ready.is_some() {
            return None;
        }
        if let Some(entry) = self.script.front() {
            let missing = |&(source, _): &(u32, u32)| !self.recalled.contains_key(&source);
            let missing: Vec<_> = entry.taken.iter().copied().filter(missing).collect();
            if !missing.is_empty() {
                return Some(Errand::Recall(missing));
            }
            self.script.pop_front();
            let recalled = std::mem::take(&mut self.recalled);
            self.make_ready(recalled);
            return None;
        }
        let arrived = std::mem::take(&mut self.newest);
        let taken = arrived.values().map(|outbox| (outbox.island, outbox.epoch)).collect();
        self.make_ready(arrived);
        Some(Errand::Record(Arrivals { generation, taken }))
    }

    /// Takes out what the epoch takes in, by sender.
    pub fn take(&mut self) -> Vec<Outbox<G>> {
        self.ready.take().unwrap_or_default()
    }

    /// What the record says was taken in and is not here, by epoch: the first and who sent it.
    pub fn missing(&self) -> Vec<(u32, u32)> {
        let entry = self.script.front().filter(|_| self.ready.is_none());
        let taken = entry.into_iter().flat_map(|entry| entry.taken.iter().copied());
        taken.filter(|(source, _)| !self.recalled.contains_key(source)).collect()
    }

    fn make_ready(&mut self, outboxes: BTreeMap<u32, Outbox<G>>) {
        self.taken.extend(outboxes.values().map(|outbox| (outbox.island, outbox.epoch)));
        let Self { newest, taken, .. } = self;
        newest.retain(|source, outbox| taken.get(source).is_none_or(|&epoch| epoch < outbox.epoch));
        self.ready = Some(outboxes.into_values().collect());
    }
}

/// Whether island `index` of a run can have recorded this, all of it from the first epoch on.
///
/// # Errors
/// Why it cannot, as a sentence about it.
pub fn check_record(
    record: &[Arrivals],
    archipelago: &Archipelago,
    index: u32,
) -> Result<(), String> {
    let sources = archipelago.in_neighbours(index);
    let mut newest: BTreeMap<u32, u32> = BTreeMap::new();
    for (epoch, Arrivals { generation, taken }) in (0..).zip(record) {
        let wrong = |reason: &str| Err(format!("what arrived for epoch {epoch} {reason}"));
        if archipelago.migration.beginning(*generation) != Some(epoch) {
            return wrong("is not in its place");
        }
        if !taken.is_sorted_by(|(a, _), (b, _)| a < b) {
            return wrong("is not in the order of the senders");
        }
        for &(source, epoch) in taken {
            let before = newest.insert(source, epoch);
            if !sources.contains(&source) || before >= Some(epoch) {
                return wrong("is not newer, or not from a neighbour");
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::toy::archipelago;
    use super::super::{Migration, Topology};
    use super::*;

    fn outbox(island: u32, epoch: u32) -> Outbox<f64> {
        Outbox { island, epoch, migrants: Vec::new() }
    }

    fn arrivals(generation: u32, taken: &[(u32, u32)]) -> Arrivals {
        Arrivals { generation, taken: taken.to_vec() }
    }

    #[test]
    fn the_newest_of_each_neighbour_is_taken_once_and_only_after_it_was_recorded() {
        let mut mailbox = Mailbox::new(vec![1, 2], None, Vec::new());
        assert_eq!(mailbox.accept(outbox(1, 3)), Arrival::Kept);
        assert_eq!(mailbox.accept(outbox(1, 3)), Arrival::Duplicate);
        assert_eq!(mailbox.accept(outbox(1, 2)), Arrival::Stale);
        assert_eq!(mailbox.accept(outbox(1, 5)), Arrival::Kept);
        assert_eq!(mailbox.accept(outbox(7, 5)), Arrival::Stranger);
        let record = Errand::Record(arrivals(6, &[(1, 5)]));
        assert_eq!(mailbox.prepare(6), Some(record));
        assert_eq!(mailbox.accept(outbox(2, 0)), Arrival::Kept, "it is for the next epoch");
        assert_eq!(mailbox.prepare(6), None);
        assert_eq!(mailbox.take(), [outbox(1, 5)]);
        assert_eq!(mailbox.accept(outbox(1, 5)), Arrival::Stale);
        assert_eq!(mailbox.prepare(11), Some(Errand::Record(arrivals(11, &[(2, 0)]))));
        assert_eq!(mailbox.take(), [outbox(2, 0)]);
        assert_eq!(mailbox.prepare(16), Some(Errand::Record(arrivals(16, &[]))));
    }

    #[test]
    fn what_was_recorded_is_taken_in_again_and_nothing_else_until_the_record_ends() {
        let record =
            vec![arrivals(1, &[]), arrivals(6, &[(1, 4)]), arrivals(11, &[(1, 6), (2, 1)])];
        let mut mailbox = Mailbox::new(vec![1, 2], Some(8), record);
        assert_eq!(mailbox.accept(outbox(1, 4)), Arrival::Stale, "it was taken before");
        for early in [outbox(1, 9), outbox(2, 1)] {
            assert_eq!(mailbox.accept(early), Arrival::Kept);
        }
        let recall = |pairs: &[(u32, u32)]| Some(Errand::Recall(pairs.to_vec()));
        assert_eq!(mailbox.prepare(11), recall(&[(1, 6), (2, 1)]));
        [outbox(2, 1), outbox(1, 7)].into_iter().for_each(|outbox| mailbox.recall(outbox));
        assert_eq!(mailbox.prepare(11), recall(&[(1, 6)]));
        assert_eq!(mailbox.missing(), [(1, 6)]);
        mailbox.recall(outbox(1, 6));
        assert_eq!(mailbox.prepare(11), None);
        assert_eq!(mailbox.take(), [outbox(1, 6), outbox(2, 1)]);
        assert_eq!(mailbox.missing(), []);
        assert_eq!(mailbox.prepare(16), Some(Errand::Record(arrivals(16, &[(1, 9)]))));
    }

    #[test]
    fn a_record_that_cannot_be_is_refused() {
        let migration = Migration { interval: 5, ..Migration::default() };
        let archipelago = Archipelago { topology: Topology::Full, ..archipelago(3, 1, migration) };
        let check = |record: &[Arrivals]| check_record(record, &archipelago, 0);
        let right = [arrivals(1, &[]), arrivals(6, &[(1, 0), (2, 4)]), arrivals(11, &[(1, 1)])];
        assert_eq!(check(&right), Ok(()));
        for wrong in [
            [arrivals(1, &[]), arrivals(5, &[])],
            [arrivals(6, &[]), arrivals(11, &[])],
            [arrivals(1, &[(2, 0), (1, 0)]), arrivals(6, &[])],
            [arrivals(1, &[(1, 0)]), arrivals(6, &[(1, 0)])],
            [arrivals(1, &[(0, 0)]), arrivals(6, &[])],
            [arrivals(1, &[(3, 0)]), arrivals(6, &[])],
        ] {
            assert!(check(&wrong).is_err(), "{wrong:?}");
        }
    }
}
