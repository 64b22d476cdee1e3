//! An island's end.

use super::limits::{Limits, Rejection};
use super::ports::{self, Inlet, Outlet, RequestInlet, RequestOutlet};
use super::services::{self, Ipc, Node, Plan, WITH_SUCCESSOR};
use super::wire::{BatchHeader, ReportHeader, ResendRequest};
use super::{Domain, TransportError};
use crate::archipelago::{Archipelago, Champion, Outbox, Report};
use crate::evolution::Gene;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::update_connections::UpdateConnections;
use std::collections::BTreeMap;
use std::time::Duration;

/// The longest that [`Exchange::wait`] waits, since connections must be kept up to date whatever comes.
pub const TICK: Duration = Duration::from_millis(5);

/// An island's connection to the others. It sends, receives, asks and answers, and never waits for anybody:
/// neighbours may be busy, stopped or dead for as long as they like.
#[derive(Debug)]
pub struct Exchange<G: Gene> {
    island: u32,
    limits: Limits,
    history: u32,
    out_neighbours: Vec<u32>,
    outboxes: Outlet<G, BatchHeader>,
    reports: Outlet<G, ReportHeader>,
    requests: RequestInlet,
    sources: BTreeMap<u32, Source<G>>,
    wakers: BTreeMap<u32, Notifier<Ipc>>,
    listener: Listener<Ipc>,
    // Last, since the ports above are its own.
    _node: Node,
}

/// The two services of an in-neighbour: its outboxes, and what it is asked for.
#[derive(Debug)]
struct Source<G: Gene> {
    outboxes: Inlet<G, BatchHeader>,
    requests: RequestOutlet,
}

/// What arrived.
#[derive(Debug, Clone, PartialEq)]
pub struct Received<G> {
    /// In the order of senders and, for each, of arrival. There may be any epoch among them, twice too.
    pub outboxes: Vec<Outbox<G>>,
    /// What was not accepted, by the channel that it came through.
    pub rejected: Vec<(u32, Rejection)>,
}

impl<G: Gene> Exchange<G> {
    /// Opens the ports of `island`. The services must exist: the launcher creates them.
    ///
    /// Call it before other threads make files: iceoryx2 changes the umask of the whole process while it
    /// makes its socket.
    ///
    /// # Errors
    /// If the launcher is gone, or something cannot be opened.
    pub fn open(
        domain: &Domain,
        archipelago: &Archipelago,
        island: u32,
    ) -> Result<Self, TransportError> {
        let plan = Plan::new(domain, archipelago)?;
        let node = services::join(domain)?;
        let in_neighbours = archipelago.in_neighbours(island);
        let out_neighbours = archipelago.out_neighbours(island);
        let sources = in_neighbours.iter().map(|&i| Ok((i, Source::open(&plan, &node, i)?)));
        let neighbours = in_neighbours.iter().chain(&out_neighbours);
        let wakers = neighbours.map(|&i| Ok((i, ports::waker(&plan, &node, i)?)));
        Ok(Self {
            island,
            limits: plan.limits,
            history: plan.history as u32,
            outboxes: ports::outbox_outlet(&plan, &node, island)?,
            reports: ports::report_outlet(&plan, &node)?,
            requests: ports::request_inlet(&plan, &node, island)?,
            sources: sources.collect::<Result<_, _>>()?,
            wakers: wakers.collect::<Result<_, TransportError>>()?,
            listener: ports::listener(&plan, &node, island)?,
            out_neighbours,
            _node: node,
        })
    }

    /// How many of its last outboxes an island publishes again when it is born again: what its neighbours can
    /// still miss, if they ask for nothing.
    pub fn history(&self) -> u32 {
        self.history
    }

    /// Sends an outbox of this island to all its out-neighbours, and returns how many of them had room for
    /// it. The others will ask for it.
    ///
    /// # Errors
    /// If the outbox is none that may travel, or the memory to send from is exhausted.
    pub fn publish(&self, outbox: &Outbox<G>) -> Result<usize, TransportError> {
        if outbox.island != self.island {
            return Err(TransportError::Unsendable { reason: Rejection::Island });
        }
        let header = self.limits.batch(outbox).map_err(TransportError::unsendable)?;
        let genes = outbox.migrants.iter().flat_map(|migrant| &migrant.genome);
        let count = outbox.migrants.iter().map(|migrant| migrant.genome.len()).sum();
        let reached = ports::send(&self.outboxes, header, count, genes)?;
        self.wake(&self.out_neighbours);
        Ok(reached)
    }

    /// Takes all that has arrived.
    pub fn receive(&self) -> Received<G> {
        let mut received = Received { outboxes: Vec::new(), rejected: Vec::new() };
        for (&island, source) in &self.sources {
            ports::drain(&source.outboxes, WITH_SUCCESSOR, |header, genes| {
                match self.limits.outbox(island, header, genes) {
                    Ok(outbox) => received.outboxes.push(outbox),
                    Err(rejection) => received.rejected.push((island, rejection)),
                }
            });
        }
        received
    }

    /// Asks an in-neighbour to send its outboxes from `epoch` on once more. The request may get lost, so ask
    /// again if nothing comes of it. Whoever is no in-neighbour is not asked.
    pub fn request(&self, source: u32, epoch: u32) {
        let Some(to) = self.sources.get(&source) else { return };
        let request = ResendRequest { run_id: self.limits.run_id, asker: self.island, epoch };
        // A request that cannot be sent is a lost one.
        let _ = to.requests.send_copy(request);
        self.wake(&[source]);
    }

    /// The earliest epoch that out-neighbours have asked for since the last call: all outboxes from this one
    /// on are to be published again. Requests that cannot be meant are ignored.
    pub fn requests(&self) -> Option<u32> {
        let mut earliest: Option<u32> = None;
        let senders = WITH_SUCCESSOR * self.out_neighbours.len();
        ports::drain_requests(&self.requests, senders, |request| {
            if let Ok(epoch) = self.limits.requested(request, &self.out_neighbours) {
                earliest = Some(earliest.map_or(epoch, |other| other.min(epoch)));
            }
        });
        earliest
    }

    /// Waits until a neighbour has sent or asked something, for `timeout` or one [`TICK`] at most. Returns
    /// whether somebody did. Call it again and again while there is nothing else to do: it also connects
    /// this island to neighbours that were born meanwhile, who would otherwise wait for it for ever.
    ///
    /// # Errors
    /// If the system does not let it wait.
    pub fn wait(&self, timeout: Duration) -> Result<bool, TransportError> {
        // A socket takes no time-out at all for one without end.
        let heard = if timeout < Duration::from_micros(1) {
            self.listener.try_wait(|_| ())
        } else {
            self.listener.timed_wait(|_| (), timeout.min(TICK))
        };
        let woken = match heard {
            Ok(notifications) => notifications > 0,
            Err(ListenerWaitError::InterruptSignal) => false,
            Err(cause) => return Err(TransportError::Wait { cause: format!("{cause:?}") }),
        };
        self.update_connections();
        Ok(woken)
    }

    /// Tells the launcher about a generation, and about a new champion if there is one. It keeps only
    /// the newest for those that do not look.
    ///
    /// # Errors
    /// If the champion is none that may travel, or the memory to send from is exhausted.
    pub fn report(
        &self,
        report: &Report,
        seconds: f64,
        champion: Option<&Champion<G>>,
    ) -> Result<(), TransportError> {
        let header = self.limits.report(report, seconds, champion);
        let header = header.map_err(TransportError::unsendable)?;
        let genome = champion.map_or(&[][..], |champion| &champion.individual.genome);
        ports::send(&self.reports, header, genome.len(), genome.iter())?;
        Ok(())
    }

    // A connection that cannot be made is one to somebody who has just died, and whose successor changes the
    // list of ports again.
    fn update_connections(&self) {
        let _ = self.outboxes.update_connections();
        let _ = self.reports.update_connections();
        for source in self.sources.values() {
            let _ = source.outboxes.update_connections();
            let _ = source.requests.update_connections();
        }
        let _ = self.requests.update_connections();
    }

    // Who is not woken looks at its next tick.
    fn wake(&self, islands: &[u32]) {
        for waker in islands.iter().filter_map(|island| self.wakers.get(island)) {
            let _ = waker.notify();
        }
    }
}

impl<G: Gene> Source<G> {
    fn open(plan: &Plan, node: &Node, island: u32) -> Result<Self, TransportError> {
        Ok(Self {
            outboxes: ports::outbox_inlet(plan, node, island)?,
            requests: ports::request_outlet(plan, node, island)?,
        })
    }
}
