//! Every service of a run: its name, what it carries and how much of it. Written once, for those who create
//! the services and those who open them.

use super::limits::Limits;
use super::wire::{BatchHeader, ReportHeader, ResendRequest, WireGene};
use super::{Domain, TransportError};
use crate::archipelago::migration::MIGRANTS_MAX;
use crate::archipelago::{Archipelago, ExchangeMode, Graph};
use crate::evolution::Gene;
use iceoryx2::prelude::{NodeBuilder, ServiceName, SignalHandlingMode};
use iceoryx2::service::builder::{event, publish_subscribe};
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;
use std::mem::size_of;

/// The thread-safe variant, so that an island's end can be lent to a helper thread. Its lock costs some
/// nanoseconds a call.
pub type Ipc = iceoryx2::prelude::ipc_threadsafe::Service;

pub type Node = iceoryx2::prelude::Node<Ipc>;
pub type OutboxService<G> = PortFactory<Ipc, [WireGene<G>], BatchHeader>;
pub type RequestService = PortFactory<Ipc, ResendRequest, ()>;
pub type ReportService<G> = PortFactory<Ipc, [WireGene<G>], ReportHeader>;
pub type WakeUpService = iceoryx2::service::port_factory::event::PortFactory<Ipc>;

/// Samples that a reader holds at once: one is read, and one may be left over by a dead process.
const BORROWED: usize = 2;
/// Samples that a sender fills at once.
pub const LOANED: usize = 2;
/// A dead process occupies its places until the launcher has cleaned up after it: so one more of all.
pub const WITH_SUCCESSOR: usize = 2;
/// Beyond this a reader that is further behind asks for what it missed; memory stays bounded.
const HISTORY_MAX: usize = 64;
const REQUESTS_KEPT: usize = 16;
const REPORTS_KEPT: usize = 64;
/// What a late reader of reports sees at once of every island.
const REPORTS_HISTORY: usize = 8;
/// The launcher, and one who watches by hand.
const REPORT_READERS: usize = 2;

/// The most edges that a topology may have: all to all among 64 islands. Each takes some twenty open files of its
/// two islands and several objects in shared memory, and the time to open one grows with how many there are: one of
/// 256 islands that all send to all others took 7 s to open its ends, and all would make 200,000 objects.
pub const EDGES_MAX: usize = 64 * 63;
/// Outboxes that are kept for late openers where islands do not wait for each other: only the newest is of use, and
/// one more in case that it dies over sending it.
const HISTORY_ASYNC: usize = 2;

/// How much of everything a run needs.
#[derive(Debug, Clone)]
pub struct Plan {
    pub limits: Limits,
    islands: u32,
    graph: Graph,
    /// Outboxes that a late opener still gets.
    pub history: usize,
    /// Whether only the newest outboxes are of use.
    newest_count: bool,
}

impl Plan {
    /// The plan of a run, unless it asks for more than the wire types hold.
    pub fn new(domain: &Domain, archipelago: &Archipelago) -> Result<Self, TransportError> {
        let migrants = archipelago.migration.migrants;
        if migrants > MIGRANTS_MAX {
            return Err(TransportError::TooManyMigrants { migrants, max: MIGRANTS_MAX });
        }
        let (graph, islands) = (archipelago.graph(), archipelago.islands);
        let edges = graph.edges();
        if edges > EDGES_MAX {
            return Err(TransportError::TooManyEdges { edges, max: EDGES_MAX });
        }
        // A sender waits for whom its reader waits for: so it can be this many epochs ahead of its reader.
        let steps = graph.longest_way_back().unwrap_or(islands) as usize;
        let ahead = steps.saturating_mul(1 + archipelago.migration.lag as usize);
        let newest_count = archipelago.migration.exchange == ExchangeMode::Async;
        let history = match newest_count {
            true => HISTORY_ASYNC,
            false => ahead.saturating_add(2).min(HISTORY_MAX),
        };
        let limits = Limits::of(domain.run_id(), archipelago);
        Ok(Self { limits, islands, graph, history, newest_count })
    }

    /// The files that one process of the run has open at most: the launcher, which holds all services, or the island
    /// with the most neighbours. From above, as measured, with a flat rate for all that is no exchange.
    pub fn files(&self) -> u64 {
        const FLAT: usize = 128;
        let island = |island| 12 * self.in_degree(island) + 10 * self.out_degree(island);
        let most = (0..self.islands).map(island).max().unwrap_or(0);
        (FLAT + most.max(6 * self.islands as usize)) as u64
    }

    /// The most genes in one outbox; at least one, since a slice of none cannot be reserved.
    pub fn outbox_genes_max(&self) -> usize {
        self.limits.migrants.saturating_mul(self.limits.genes_max).max(1)
    }

    /// The most genes in one report.
    pub fn report_genes_max(&self) -> usize {
        self.limits.genes_max.max(1)
    }

    /// Shared memory for the whole run, in bytes, from above: what senders reserve for samples, with a
    /// successor for each, and a generous flat rate for the rest.
    pub fn bytes<G: Gene>(&self) -> u64 {
        const PORT: usize = 16 << 10;
        const CHUNK: usize = 256;
        let sample = |header: usize, genes: usize| {
            genes.saturating_mul(size_of::<G>()).saturating_add(header + CHUNK)
        };
        let outbox = sample(size_of::<BatchHeader>(), self.outbox_genes_max());
        let report = sample(size_of::<ReportHeader>(), self.report_genes_max());
        let reports = REPORT_READERS * (REPORTS_KEPT + BORROWED) + REPORTS_HISTORY + LOANED;
        let island = |island| {
            let readers = self.outbox_readers(island);
            let outboxes = readers * (self.buffer() + BORROWED) + self.history + LOANED;
            let ports = readers + self.in_degree(island) + REPORT_READERS + 4;
            let samples =
                outbox.saturating_mul(outboxes).saturating_add(report.saturating_mul(reports));
            samples.saturating_add(ports * PORT).saturating_mul(WITH_SUCCESSOR) as u64
        };
        (0..self.islands).map(island).fold(0, u64::saturating_add)
    }

    /// An island's outboxes. Where all count nothing is pushed out of a full buffer, or epochs would be lost in the
    /// middle: what does not fit is not delivered, and asked for again.
    pub fn outboxes<G: Gene>(
        &self,
        node: &Node,
        island: u32,
    ) -> Result<publish_subscribe::Builder<[WireGene<G>], BatchHeader, Ipc>, TransportError> {
        let builder = node.service_builder(&name("outboxes", island)?);
        Ok(builder
            .publish_subscribe::<[WireGene<G>]>()
            .user_header::<BatchHeader>()
            .enable_safe_overflow(self.newest_count)
            .history_size(self.history)
            .subscriber_max_buffer_size(self.buffer())
            .subscriber_max_borrowed_samples(BORROWED)
            .max_publishers(WITH_SUCCESSOR)
            .max_subscribers(self.outbox_readers(island))
            .max_nodes(self.nodes()))
    }

    /// What an island is asked to send again. The newest requests count: who was forgotten asks again.
    pub fn requests(
        &self,
        node: &Node,
        island: u32,
    ) -> Result<publish_subscribe::Builder<ResendRequest, (), Ipc>, TransportError> {
        let builder = node.service_builder(&name("requests", island)?);
        Ok(builder
            .publish_subscribe::<ResendRequest>()
            .enable_safe_overflow(true)
            .history_size(0)
            .subscriber_max_buffer_size(REQUESTS_KEPT)
            .subscriber_max_borrowed_samples(BORROWED)
            .max_publishers(WITH_SUCCESSOR * self.out_degree(island).max(1))
            .max_subscribers(WITH_SUCCESSOR)
            .max_nodes(self.nodes()))
    }

    /// What wakes an island up: its in-neighbours when they send, its out-neighbours when they ask.
    pub fn wake_up(&self, node: &Node, island: u32) -> Result<event::Builder<Ipc>, TransportError> {
        let builder = node.service_builder(&name("wakeup", island)?);
        let wakers = self.in_degree(island) + self.out_degree(island);
        Ok(builder
            .event()
            .event_id_max_value(0)
            .max_listeners(WITH_SUCCESSOR)
            .max_notifiers(WITH_SUCCESSOR * wakers.max(1))
            .max_nodes(self.nodes()))
    }

    /// All islands' reports. The newest count, and a reader that is slow or dead holds nobody up.
    pub fn reports<G: Gene>(
        &self,
        node: &Node,
    ) -> Result<publish_subscribe::Builder<[WireGene<G>], ReportHeader, Ipc>, TransportError> {
        let builder = node.service_builder(&service_name("reports")?);
        Ok(builder
            .publish_subscribe::<[WireGene<G>]>()
            .user_header::<ReportHeader>()
            .enable_safe_overflow(true)
            .history_size(REPORTS_HISTORY)
            .subscriber_max_buffer_size(REPORTS_KEPT)
            .subscriber_max_borrowed_samples(BORROWED)
            .max_publishers(self.nodes())
            .max_subscribers(REPORT_READERS)
            .max_nodes(self.nodes()))
    }

    // Twice the history: an island that is born again sends it once more to readers that have it.
    fn buffer(&self) -> usize {
        2 * self.history
    }

    // Every island, the launcher's service host and report reader, one who watches by hand, and those dead but not cleaned
    // up.
    fn nodes(&self) -> usize {
        self.islands as usize + 6
    }

    fn outbox_readers(&self, island: u32) -> usize {
        self.out_degree(island) + 2
    }

    fn out_degree(&self, island: u32) -> usize {
        self.graph.out_neighbours(island).len()
    }

    fn in_degree(&self, island: u32) -> usize {
        self.graph.in_neighbours(island).len()
    }
}

/// This process's membership of the domain.
pub fn join(domain: &Domain) -> Result<Node, TransportError> {
    // iceoryx2 would make the domain anew, and nobody would remove it.
    if !domain.root().is_dir() {
        return Err(TransportError::open("folder", format!("no {}", domain.root().display())));
    }
    // Signals are the application's: a library that catches Ctrl-C would keep it from the launcher.
    NodeBuilder::new()
        .config(&domain.config()?)
        .signal_handling_mode(SignalHandlingMode::Disabled)
        .create::<Ipc>()
        .map_err(|e| TransportError::setup("the run's shared memory", e))
}

fn name(kind: &str, island: u32) -> Result<ServiceName, TransportError> {
    service_name(&format!("{kind}/{island}"))
}

fn service_name(name: &str) -> Result<ServiceName, TransportError> {
    ServiceName::new(name).map_err(|e| TransportError::setup(name, e))
}
