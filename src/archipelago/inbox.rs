//! The receiving end of the exchange protocol.
//!
//! Channels may lose, repeat and reorder outboxes, and senders may die and be born again; epochs make the
//! exchange exact all the same. An [`Inbox`] keeps what came early, drops what came twice or late, and
//! says what is missing, so that its owner can ask for it again.

use super::migration::Outbox;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What became of an outbox that arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    /// It was kept until its epoch is taken.
    Kept,
    /// The same one is here already.
    Duplicate,
    /// Its epoch was taken before.
    Stale,
    /// Its epoch is so far ahead that nothing was kept of it: it must be asked for when its time comes.
    TooEarly,
    /// It is from an island that is no in-neighbour.
    Stranger,
}

/// Epochs of which an inbox keeps outboxes at once. In a ring of N islands with lag L a sender gets
/// (N - 1)(1 + L) epochs ahead of its reader, and more only while a reborn reader catches up; what is
/// beyond the window costs that reader a request for each window. Without one, memory would have no bound
/// against a sender that makes epochs up.
pub const WINDOW: u32 = 1024;

/// The outboxes that an island has received and not yet taken in.
#[derive(Debug, Clone)]
pub struct Inbox<G> {
    sources: Vec<u32>,
    next_epoch: u32,
    window: u32,
    kept: BTreeMap<(u32, u32), Outbox<G>>,
}

impl<G> Inbox<G> {
    /// An empty inbox for outboxes of these in-neighbours from `next_epoch` on.
    pub fn new(sources: Vec<u32>, next_epoch: u32) -> Self {
        Self { sources, next_epoch, window: WINDOW, kept: BTreeMap::new() }
    }

    /// The inbox with another window than [`WINDOW`], at least 1 epoch.
    #[cfg(test)]
    pub(super) fn with_window(self, window: u32) -> Self {
        Self { window, ..self }
    }

    /// Hands in what arrived.
    pub fn accept(&mut self, outbox: Outbox<G>) -> Arrival {
        let key = (outbox.epoch, outbox.island);
        if !self.sources.contains(&outbox.island) {
            Arrival::Stranger
        } else if outbox.epoch < self.next_epoch {
            Arrival::Stale
        } else if outbox.epoch - self.next_epoch >= self.window {
            Arrival::TooEarly
        } else if let Entry::Vacant(place) = self.kept.entry(key) {
            place.insert(outbox);
            Arrival::Kept
        } else {
            Arrival::Duplicate
        }
    }

    /// The in-neighbours whose outbox of `epoch` is not here.
    pub fn missing(&self, epoch: u32) -> Vec<u32> {
        let absent = |source: &u32| !self.kept.contains_key(&(epoch, *source));
        self.sources.iter().copied().filter(absent).collect()
    }

    /// Takes out all outboxes of `epoch`, in the order of their senders, once none is missing. Older ones
    /// are then no longer accepted.
    pub fn take(&mut self, epoch: u32) -> Option<Vec<Outbox<G>>> {
        if !self.missing(epoch).is_empty() {
            return None;
        }
        self.next_epoch = epoch + 1;
        let later = self.kept.split_off(&(epoch + 1, 0));
        let taken = std::mem::replace(&mut self.kept, later);
        Some(taken.into_values().filter(|outbox| outbox.epoch == epoch).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outbox(island: u32, epoch: u32) -> Outbox<f64> {
        Outbox { island, epoch, migrants: Vec::new() }
    }

    #[test]
    fn an_epoch_is_taken_once_and_only_when_it_is_whole() {
        let mut inbox = Inbox::new(vec![1, 2], 0);
        assert_eq!(inbox.accept(outbox(2, 0)), Arrival::Kept);
        assert_eq!(inbox.missing(0), [1]);
        assert_eq!(inbox.take(0), None);
        assert_eq!(inbox.accept(outbox(1, 1)), Arrival::Kept, "early ones are kept");
        assert_eq!(inbox.accept(outbox(1, 0)), Arrival::Kept);
        assert_eq!(inbox.accept(outbox(1, 0)), Arrival::Duplicate);
        assert_eq!(inbox.take(0), Some(vec![outbox(1, 0), outbox(2, 0)]));
        assert_eq!(inbox.accept(outbox(1, 0)), Arrival::Stale);
        assert_eq!(inbox.accept(outbox(7, 1)), Arrival::Stranger);
        assert_eq!(inbox.missing(1), [2]);
    }

    #[test]
    fn an_epoch_beyond_the_window_is_dropped_until_its_time_comes() {
        let mut inbox = Inbox::new(vec![1], 2).with_window(3);
        assert_eq!(inbox.accept(outbox(1, u32::MAX)), Arrival::TooEarly);
        assert_eq!(inbox.accept(outbox(1, 5)), Arrival::TooEarly);
        assert_eq!(inbox.accept(outbox(1, 4)), Arrival::Kept);
        assert_eq!(inbox.accept(outbox(1, 2)), Arrival::Kept);
        assert_eq!(inbox.take(2), Some(vec![outbox(1, 2)]));
        assert_eq!(inbox.accept(outbox(1, 5)), Arrival::Kept);
        assert_eq!(inbox.missing(5), [0; 0]);
    }

    #[test]
    fn an_island_without_neighbours_never_waits() {
        assert_eq!(Inbox::<f64>::new(Vec::new(), 0).take(3), Some(Vec::new()));
    }
}
