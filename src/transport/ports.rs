//! The ports of the services, and how they are read and written.

use super::TransportError;
use super::services::{Ipc, LOANED, Node, Plan};
use super::wire::{BatchHeader, ReportHeader, ResendRequest, WireGene};
use crate::evolution::Gene;
use iceoryx2::port::DegradationAction;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy, ZeroCopySend};
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;
use std::fmt::Debug;

pub type Outlet<G, Header> = Publisher<Ipc, [WireGene<G>], Header>;
pub type Inlet<G, Header> = Subscriber<Ipc, [WireGene<G>], Header>;
pub type RequestOutlet = Publisher<Ipc, ResendRequest, ()>;
pub type RequestInlet = Subscriber<Ipc, ResendRequest, ()>;

/// Writes a sample, once, where it will be read, and sends it. Returns how many readers it has reached.
/// `genes` must yield `count` genes.
pub fn send<'a, G: Gene, Header: ZeroCopySend + Debug + Default>(
    outlet: &Outlet<G, Header>,
    header: Header,
    count: usize,
    mut genes: impl Iterator<Item = &'a G>,
) -> Result<usize, TransportError> {
    let mut sample = outlet
        .loan_slice_uninit(count)
        .map_err(|e| TransportError::Memory { cause: e.to_string() })?;
    *sample.user_header_mut() = header;
    let sample =
        sample.write_from_fn(|_| WireGene(*genes.next().expect("as many genes as were counted")));
    // Sending fails where a reader dies at the same moment. Whom it did not reach asks for it.
    Ok(sample.send().unwrap_or(0))
}

/// Hands every sample that has arrived from up to `senders` senders to `each`, header copied.
pub fn drain<G: Gene, Header: ZeroCopySend + Debug + Copy>(
    inlet: &Inlet<G, Header>,
    senders: usize,
    mut each: impl FnMut(Header, &[WireGene<G>]),
) {
    // Bounded, lest a sender that never stops holds the reader for ever. An error is a sender that has just
    // died: what it still had to say comes at the next call, or is asked for.
    for _ in 0..senders * inlet.buffer_size() {
        let Ok(Some(sample)) = inlet.receive() else { break };
        each(*sample.user_header(), sample.payload());
    }
}

/// The same for requests.
pub fn drain_requests(inlet: &RequestInlet, senders: usize, mut each: impl FnMut(ResendRequest)) {
    for _ in 0..senders * inlet.buffer_size() {
        let Ok(Some(sample)) = inlet.receive() else { break };
        each(*sample.payload());
    }
}

/// Where an island sends its outboxes.
pub fn outbox_outlet<G: Gene>(
    plan: &Plan,
    node: &Node,
    island: u32,
) -> Result<Outlet<G, BatchHeader>, TransportError> {
    let service = plan.outboxes(node, island)?.open();
    let service = service.map_err(|e| TransportError::open("outboxes", e))?;
    outlet(&service, plan.outbox_genes_max(), "outboxes")
}

/// Where an island's outboxes arrive.
pub fn outbox_inlet<G: Gene>(
    plan: &Plan,
    node: &Node,
    island: u32,
) -> Result<Inlet<G, BatchHeader>, TransportError> {
    let service = plan.outboxes(node, island)?.open();
    inlet(&service.map_err(|e| TransportError::open("outboxes", e))?, "outboxes")
}

/// Where an island reports.
pub fn report_outlet<G: Gene>(
    plan: &Plan,
    node: &Node,
) -> Result<Outlet<G, ReportHeader>, TransportError> {
    let service = plan.reports(node)?.open().map_err(|e| TransportError::open("reports", e))?;
    outlet(&service, plan.report_genes_max(), "reports")
}

/// Where all islands' reports arrive.
pub fn report_inlet<G: Gene>(
    plan: &Plan,
    node: &Node,
) -> Result<Inlet<G, ReportHeader>, TransportError> {
    let service = plan.reports(node)?.open().map_err(|e| TransportError::open("reports", e))?;
    inlet(&service, "reports")
}

/// Where an island is asked to send again.
pub fn request_outlet(
    plan: &Plan,
    node: &Node,
    island: u32,
) -> Result<RequestOutlet, TransportError> {
    let service = plan.requests(node, island)?.open();
    service
        .map_err(|e| TransportError::open("requests", e))?
        .publisher_builder()
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .set_degradation_handler(|_, _| DegradationAction::Ignore)
        .create()
        .map_err(|e| TransportError::open("requests", e))
}

/// Where an island finds what it is asked for.
pub fn request_inlet(
    plan: &Plan,
    node: &Node,
    island: u32,
) -> Result<RequestInlet, TransportError> {
    let service = plan.requests(node, island)?.open();
    service
        .map_err(|e| TransportError::open("requests", e))?
        .subscriber_builder()
        .set_degradation_handler(|_, _| DegradationAction::Ignore)
        .create()
        .map_err(|e| TransportError::open("requests", e))
}

/// What wakes `island` up.
pub fn waker(plan: &Plan, node: &Node, island: u32) -> Result<Notifier<Ipc>, TransportError> {
    let service = plan.wake_up(node, island)?.open();
    let service = service.map_err(|e| TransportError::open("wake-ups", e))?;
    service.notifier_builder().create().map_err(|e| TransportError::open("wake-ups", e))
}

/// Where `island` waits to be woken up.
pub fn listener(plan: &Plan, node: &Node, island: u32) -> Result<Listener<Ipc>, TransportError> {
    let service = plan.wake_up(node, island)?.open();
    let service = service.map_err(|e| TransportError::open("wake-ups", e))?;
    service.listener_builder().create().map_err(|e| TransportError::open("wake-ups", e))
}

// Memory is reserved once: memory that grows on demand can be lost with the sender's life.
fn outlet<G: Gene, Header: ZeroCopySend + Debug>(
    service: &PortFactory<Ipc, [WireGene<G>], Header>,
    genes_max: usize,
    what: &str,
) -> Result<Outlet<G, Header>, TransportError> {
    service
        .publisher_builder()
        .initial_max_slice_len(genes_max)
        .max_loaned_samples(LOANED)
        .allocation_strategy(AllocationStrategy::Static)
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .set_degradation_handler(|_, _| DegradationAction::Ignore)
        .create()
        .map_err(|e| TransportError::open(what, e))
}

fn inlet<G: Gene, Header: ZeroCopySend + Debug>(
    service: &PortFactory<Ipc, [WireGene<G>], Header>,
    what: &str,
) -> Result<Inlet<G, Header>, TransportError> {
    service
        .subscriber_builder()
        .set_degradation_handler(|_, _| DegradationAction::Ignore)
        .create()
        .map_err(|e| TransportError::open(what, e))
}
