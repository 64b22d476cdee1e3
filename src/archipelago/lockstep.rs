//! A whole archipelago in one process: the reference that the processes must equal to the last bit.

use super::island::{self, Island, Step};
use super::{Archipelago, Arrivals, Migration, Outbox};
use crate::evolution::{Founders, Problem};
use std::collections::BTreeMap;

/// Outboxes by epoch and sender.
type Sent<G> = BTreeMap<(u32, u32), Outbox<G>>;

/// Runs every island to `generations`, in step, and returns them in order. `observe` sees each step. Islands wait for
/// each other here, whatever the archipelago says of that.
pub fn run<P: Problem>(
    problem: &P,
    archipelago: &Archipelago,
    generations: u32,
    observe: impl FnMut(&Step<P::Gene>),
) -> Vec<Island<P::Gene>> {
    run_from(problem, &Founders::NONE, archipelago, generations, observe)
}

/// The same, where islands begin with founders.
pub fn run_from<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    archipelago: &Archipelago,
    generations: u32,
    observe: impl FnMut(&Step<P::Gene>),
) -> Vec<Island<P::Gene>> {
    run_until(problem, founders, archipelago, generations, observe, |_| false)
}

/// The same, but the run is over earlier if `is_over` says so: it is asked before every generation, and
/// sees all islands.
pub fn run_until<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    archipelago: &Archipelago,
    generations: u32,
    mut observe: impl FnMut(&Step<P::Gene>),
    mut is_over: impl FnMut(&[Island<P::Gene>]) -> bool,
) -> Vec<Island<P::Gene>> {
    let mut mail = Mail(Sent::new());
    let mut islands: Vec<Island<P::Gene>> = (0..archipelago.islands)
        .map(|index| {
            let step = island::genesis(problem, founders, archipelago, index);
            observe(&step);
            step.island
        })
        .collect();
    let graph = archipelago.graph();
    for generation in 1..=generations {
        if is_over(&islands) {
            break;
        }
        let mut outboxes = Vec::new();
        islands = islands
            .into_iter()
            .map(|island| {
                let epoch = archipelago.migration.immigration(generation);
                let immigrants = mail.of(epoch, graph.in_neighbours(island.index));
                let step = island::step(island, &immigrants, problem, archipelago);
                observe(&step);
                outboxes.extend(step.outbox);
                step.island
            })
            .collect();
        mail.close(generation, &archipelago.migration, outboxes);
    }
    islands
}

/// The outboxes that have yet to be taken in.
struct Mail<G>(Sent<G>);

impl<G: Clone> Mail<G> {
    /// What some islands sent at the end of an epoch.
    fn of(&self, epoch: Option<u32>, senders: &[u32]) -> Vec<Outbox<G>> {
        let Some(epoch) = epoch else { return Vec::new() };
        senders.iter().filter_map(|&sender| self.0.get(&(epoch, sender)).cloned()).collect()
    }

    /// Adds what was sent at the end of a generation, and forgets what all have taken in by then.
    fn close(&mut self, generation: u32, migration: &Migration, outboxes: Vec<Outbox<G>>) {
        self.0.extend(outboxes.into_iter().map(|outbox| ((outbox.epoch, outbox.island), outbox)));
        let next = migration.next_immigration(generation);
        self.0.retain(|&(epoch, _), _| epoch >= next);
    }
}

/// A record in which an island has taken in what nobody can have sent by then.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "island {island} cannot have begun epoch {epoch} with what its record says: no order of sending leads there"
)]
pub struct Impossible {
    /// The first island that gets no further.
    pub island: u32,
    /// The epoch that it cannot begin.
    pub epoch: u32,
}

/// Evolves again what islands evolved that did not wait for each other, from what each of them recorded
/// (`arrivals`, in the order of their index): to the last bit the same, in whatever order they were.
///
/// # Errors
/// If a record says nothing of an epoch, or of one that can never have been sent by then.
pub fn replay<P: Problem>(
    problem: &P,
    founders: &Founders<P::Gene>,
    archipelago: &Archipelago,
    generations: u32,
    arrivals: &[Vec<Arrivals>],
    mut observe: impl FnMut(&Step<P::Gene>),
) -> Result<Vec<Island<P::Gene>>, Impossible> {
    let mut sent = Sent::new();
    let mut first = |index| {
        let step = island::genesis(problem, founders, archipelago, index);
        observe(&step);
        Some(step.island)
    };
    let mut islands: Vec<Option<Island<P::Gene>>> =
        (0..archipelago.islands).map(&mut first).collect();
    loop {
        let (mut has_moved, mut stuck) = (false, None);
        for (index, place) in (0..).zip(&mut islands) {
            let record = arrivals.get(index as usize).map_or(&[][..], Vec::as_slice);
            while place.as_ref().is_none_or(|island| island.generation < generations) {
                let Some(step) = next(problem, archipelago, place, record, &sent) else {
                    let generation = place.as_ref().map_or(0, |island| island.generation);
                    let epoch = archipelago.migration.begun(generation);
                    stuck = stuck.or(Some(Impossible { island: index, epoch }));
                    break;
                };
                observe(&step);
                sent.extend(step.outbox.map(|outbox| ((outbox.epoch, index), outbox)));
                *place = Some(step.island);
                has_moved = true;
            }
        }
        match stuck {
            None => return Ok(islands.into_iter().flatten().collect()),
            Some(impossible) if !has_moved => return Err(impossible),
            Some(_) => {}
        }
    }
}

/// The next step of an island, if all that its record says it takes in was sent by now.
fn next<P: Problem>(
    problem: &P,
    archipelago: &Archipelago,
    place: &mut Option<Island<P::Gene>>,
    record: &[Arrivals],
    sent: &Sent<P::Gene>,
) -> Option<Step<P::Gene>> {
    let island = place.as_ref()?;
    let mut immigrants = Vec::new();
    if let Some(epoch) = archipelago.migration.beginning(island.generation + 1) {
        for &(source, epoch) in &record.get(epoch as usize)?.taken {
            immigrants.push(sent.get(&(epoch, source))?.clone());
        }
    }
    Some(island::step(place.take()?, &immigrants, problem, archipelago))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mail_is_kept_until_it_is_taken_in_and_no_longer() {
        for (interval, lag) in [(1, 0), (1, 1), (3, 0), (3, 2), (5, 4)] {
            let migration = Migration { interval, lag, ..Migration::default() };
            let mut mail: Mail<f64> = Mail(Sent::new());
            let (mut taken, mut sent) = (Vec::new(), Vec::new());
            for generation in 1..100 {
                let found = mail.of(migration.immigration(generation), &[1, 0]);
                taken.extend(found.iter().map(|outbox| (outbox.epoch, outbox.island)));
                let epoch = migration.emigration(generation);
                let outbox = |epoch, island| Outbox { island, epoch, migrants: Vec::new() };
                let outboxes =
                    epoch.map_or(Vec::new(), |epoch| vec![outbox(epoch, 1), outbox(epoch, 0)]);
                sent.extend(outboxes.iter().map(|outbox| (outbox.epoch, outbox.island)));
                mail.close(generation, &migration, outboxes);
                assert!(mail.0.len() <= 2 * (1 + lag as usize), "{migration:?}");
            }
            assert_eq!(taken, sent[..taken.len()]);
            assert!(sent.len() - taken.len() <= 2 * (1 + lag as usize), "{migration:?}");
        }
    }
}
