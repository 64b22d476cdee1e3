//! The exchange protocol as an island sees it, a state machine: what arrived goes in, what to do next
//! comes out.
//!
//! Channels may lose, repeat, delay and reorder what is sent, and every island may die at any time and be
//! born again from an older state, even from its seed. The run ends in the same bits all the same, if its
//! owner keeps five rules:
//!
//! 1. An outbox is in the journal, durably, before the state after it is saved: from that state on it is
//!    never evolved again, and neighbours may need it for as long as the run lasts. It is there before it is
//!    sent, too, so that the journal knows all that ever travelled.
//! 2. Who is asked for an epoch sends it and what follows it out of the journal, also when its own run
//!    is over.
//! 3. What is handed to [`Protocol::begin`] was saved for the same island.
//! 4. [`Protocol::advance`] is called again and again, also while it has nothing to do.
//! 5. Where nobody waits, what an island takes in is in its record, durably, before it is evolved with, and the
//!    record is handed to [`Protocol::with_record`]. The bits are then those of the records.
//!
//! That a reborn island sends again what it sent last is no rule: it only spares its neighbours a request.

use super::arrivals::{Arrivals, Errand, Mailbox};
use super::inbox::{Arrival, Inbox};
use super::island::{self, Island, Step};
use super::{Archipelago, ExchangeMode, Outbox};
use crate::evolution::{Founders, Problem};
use std::time::Duration;

/// Without what it waits for, an island asks for it after so long, and again each time after as long.
pub const PATIENCE: Duration = Duration::from_millis(200);

/// An island under way: its state, what it waits for, and how far it has to go.
pub struct Protocol<'a, P: Problem> {
    problem: &'a P,
    founders: Founders<P::Gene>,
    archipelago: &'a Archipelago,
    index: u32,
    generations: u32,
    island: Option<Island<P::Gene>>,
    intake: Intake<P::Gene>,
    // When it began to wait or last asked or got something, if it waits.
    silent_since: Option<Duration>,
    asks_at_once: bool,
}

/// Where what arrives is kept.
enum Intake<G> {
    /// Until it is time for it.
    Inbox(Inbox<G>),
    /// Until the next epoch begins, where nobody waits.
    Mailbox(Mailbox<G>),
}

/// What an island does next.
#[derive(Debug, Clone, PartialEq)]
pub enum Action<G> {
    /// It has evolved a generation. Before its owner calls [`Protocol::advance`] again, it records the generation
    /// and appends the outbox to the journal, and only then sends the outbox, and saves the island where that is
    /// due. An outbox whose epoch the journal has already is the same to the last bit.
    Evolved(Box<Step<G>>),
    /// It asks these in-neighbours for their outboxes from `epoch` on.
    Ask {
        /// The in-neighbours, ascending; at least one.
        sources: Vec<u32>,
        /// The first epoch that is missing.
        epoch: u32,
    },
    /// It begins an epoch with this, where nobody waits. Before its owner calls [`Protocol::advance`] again, it appends
    /// this to the record and makes it durable.
    Record(Arrivals),
    /// It needs these outboxes again, by sender and epoch, which an earlier life took in. Its owner reads them in the
    /// senders' journals and hands them to [`Protocol::recall`]; one that is not there will be, when its sender has
    /// evolved it again.
    Recall(Vec<(u32, u32)>),
    /// There is nothing to do until something arrives, or time goes by.
    Wait,
    /// It has evolved all its generations, and only serves its neighbours from then on.
    Arrived,
}

impl<'a, P: Problem> Protocol<'a, P> {
    /// Island `index` on its way to `generations`, from the state that was `saved` last, which must be
    /// one that [`Island::fits`], or else from the seed.
    pub fn begin(
        problem: &'a P,
        archipelago: &'a Archipelago,
        index: u32,
        generations: u32,
        saved: Option<Island<P::Gene>>,
    ) -> Self {
        let generation = saved.as_ref().map(|island| island.generation);
        let migration = archipelago.migration;
        let sources = archipelago.in_neighbours(index);
        let intake = match migration.exchange {
            ExchangeMode::Sync => {
                let next_epoch = migration.next_immigration(generation.unwrap_or(0));
                Intake::Inbox(Inbox::new(sources, next_epoch))
            }
            ExchangeMode::Async => Intake::Mailbox(Mailbox::new(sources, generation, Vec::new())),
        };
        Self {
            problem,
            founders: Founders::NONE,
            archipelago,
            index,
            generations,
            intake,
            silent_since: None,
            // What was on its way to the one that saved this state died with it.
            asks_at_once: saved.is_some(),
            island: saved,
        }
    }

    /// The protocol of an island that begins with founders.
    pub fn with_founders(self, founders: Founders<P::Gene>) -> Self {
        Self { founders, ..self }
    }

    /// The protocol of an island whose earlier lives recorded this, which fits it
    /// ([`check_record`](super::arrivals::check_record)). Where islands wait for each other there is no record.
    pub fn with_record(mut self, record: Vec<Arrivals>) -> Self {
        if let Intake::Mailbox(mailbox) = &mut self.intake {
            let generation = self.island.as_ref().map(|island| island.generation);
            let sources = self.archipelago.in_neighbours(self.index);
            *mailbox = Mailbox::new(sources, generation, record);
        }
        self
    }

    /// The island as it is; none before generation 0 was evolved.
    pub fn island(&self) -> Option<&Island<P::Gene>> {
        self.island.as_ref()
    }

    /// Hands in what arrived.
    pub fn receive(&mut self, outbox: Outbox<P::Gene>) -> Arrival {
        let is_due = self.due_epoch() == Some(outbox.epoch);
        let arrival = match &mut self.intake {
            Intake::Inbox(inbox) => inbox.accept(outbox),
            Intake::Mailbox(mailbox) => mailbox.accept(outbox),
        };
        if is_due && arrival == Arrival::Kept {
            self.silent_since = None;
        }
        arrival
    }

    /// Hands in what was read in a journal because of a [`Action::Recall`].
    pub fn recall(&mut self, outbox: Outbox<P::Gene>) {
        if let Intake::Mailbox(mailbox) = &mut self.intake {
            mailbox.recall(outbox);
        }
    }

    /// Does what is next, and says what that was. `now` is a reading of a monotonic clock, from any start.
    pub fn advance(&mut self, now: Duration) -> Action<P::Gene> {
        if self.has_arrived() {
            return Action::Arrived;
        }
        let beginning = self.beginning();
        if let (Intake::Mailbox(mailbox), Some(generation)) = (&mut self.intake, beginning) {
            match mailbox.prepare(generation) {
                Some(Errand::Record(arrivals)) => return Action::Record(arrivals),
                Some(Errand::Recall(outboxes)) => return Action::Recall(outboxes),
                None => {}
            }
        } else if let Some((epoch, sources)) = self.waits_for() {
            return if self.asks(now) { Action::Ask { sources, epoch } } else { Action::Wait };
        }
        self.silent_since = None;
        let immigrants = self.take_in();
        let Self { problem, archipelago, .. } = *self;
        let step = match self.island.take() {
            None => island::genesis(problem, &self.founders, archipelago, self.index),
            Some(island) => island::step(island, &immigrants, problem, archipelago),
        };
        self.island = Some(step.island.clone());
        Action::Evolved(Box::new(step))
    }

    /// The epoch that it cannot go on without, and the in-neighbours whose outbox of it is missing; none if
    /// it need not wait.
    pub fn waits_for(&self) -> Option<(u32, Vec<u32>)> {
        match &self.intake {
            Intake::Inbox(inbox) => {
                let epoch = self.due_epoch()?;
                let missing = inbox.missing(epoch);
                (!missing.is_empty()).then_some((epoch, missing))
            }
            Intake::Mailbox(mailbox) => {
                let (source, epoch) = self.beginning().and(mailbox.missing().first().copied())?;
                Some((epoch, vec![source]))
            }
        }
    }

    /// What the next generation takes in.
    fn take_in(&mut self) -> Vec<Outbox<P::Gene>> {
        let (due, beginning) = (self.due_epoch(), self.beginning());
        match &mut self.intake {
            Intake::Inbox(inbox) => due.and_then(|epoch| inbox.take(epoch)).unwrap_or_default(),
            Intake::Mailbox(mailbox) => beginning.map(|_| mailbox.take()).unwrap_or_default(),
        }
    }

    /// The next generation, if an epoch begins with it.
    fn beginning(&self) -> Option<u32> {
        let next = self.island.as_ref().filter(|_| !self.has_arrived())?.generation + 1;
        self.archipelago.migration.beginning(next).map(|_| next)
    }

    /// The epoch that the next generation takes in, where islands wait for each other.
    fn due_epoch(&self) -> Option<u32> {
        let is_sync = self.archipelago.migration.exchange == ExchangeMode::Sync;
        let next = self.beginning().filter(|_| is_sync)?;
        self.archipelago.migration.immigration(next)
    }

    fn has_arrived(&self) -> bool {
        self.island.as_ref().is_some_and(|island| island.generation >= self.generations)
    }

    /// Whether it has waited for long enough; if so it begins to wait anew.
    fn asks(&mut self, now: Duration) -> bool {
        let since = *self.silent_since.get_or_insert(now);
        let has_waited = now.saturating_sub(since) >= PATIENCE;
        let asks = std::mem::take(&mut self.asks_at_once) || has_waited;
        if asks {
            self.silent_since = Some(now);
        }
        asks
    }
}

#[cfg(test)]
impl<P: Problem> Protocol<'_, P> {
    /// The protocol with another window of its inbox.
    pub(super) fn with_window(self, window: u32) -> Self {
        let intake = match self.intake {
            Intake::Inbox(inbox) => Intake::Inbox(inbox.with_window(window)),
            mailbox => mailbox,
        };
        Self { intake, ..self }
    }
}
