//! The launcher's end: the services of a run, from before its first island until after its last.

use super::claim::Claim;
use super::dead_nodes;
use super::files;
use super::services::{
    self, Node, OutboxService, Plan, ReportService, RequestService, WakeUpService,
};
use super::shared_memory::SharedMemory;
use super::{Domain, TransportError};
use crate::archipelago::Archipelago;
use crate::evolution::Gene;

/// Holds all services of a run open, so that islands can come, die and come again.
///
/// When it is dropped nothing of the run is left, neither in shared memory nor in the file system: let all
/// islands end first.
#[derive(Debug)]
pub struct ServiceHost<G: Gene> {
    services: Option<Services<G>>,
    domain: Domain,
    // It tells other launchers that this one lives.
    claim: Option<Claim>,
}

#[derive(Debug)]
struct Services<G: Gene> {
    node: Node,
    _outboxes: Vec<OutboxService<G>>,
    _requests: Vec<RequestService>,
    _wake_ups: Vec<WakeUpService>,
    _reports: ReportService<G>,
}

impl<G: Gene> ServiceHost<G> {
    /// Creates the domain's folder and every service of the run, once there is memory enough for it. What
    /// killed launchers have left is removed first.
    ///
    /// # Errors
    /// If the run asks for more migrants, edges, memory or files than there can be, its id is in use, or something
    /// cannot be made.
    pub fn create(domain: &Domain, archipelago: &Archipelago) -> Result<Self, TransportError> {
        let plan = Plan::new(domain, archipelago)?;
        Domain::remove_abandoned();
        domain.check_space(plan.bytes::<G>())?;
        files::provide(plan.files())?;
        let claim = domain.create()?;
        // From here on dropping it removes what was made, also where the rest of the making fails.
        let mut service_host = Self { services: None, domain: domain.clone(), claim: Some(claim) };
        service_host.services = Some(Services::create(domain, &plan, archipelago.islands)?);
        Ok(service_host)
    }

    /// The shared memory that the run needs at most, in bytes.
    ///
    /// # Errors
    /// If the run asks for more migrants than an outbox holds.
    pub fn bytes_needed(domain: &Domain, archipelago: &Archipelago) -> Result<u64, TransportError> {
        Ok(Plan::new(domain, archipelago)?.bytes::<G>())
    }

    /// Gives free what dead islands held, at whatever instant they died, and returns how many there were. Call
    /// it after the death of a child was waited for and before its successor is started. Nobody but the
    /// launcher may.
    ///
    /// # Errors
    /// If it could not be done, though it was tried several times.
    pub fn cleanup_dead_nodes(&self) -> Result<u64, TransportError> {
        let services = self.services.as_ref();
        services.map_or(Ok(0), |services| dead_nodes::clean_up(&self.domain, &services.node))
    }

    /// Ends the services and removes the domain. Dropping does the same and says nothing.
    ///
    /// # Errors
    /// If something cannot be removed. It is found as that of a killed launcher then, when this process has ended.
    pub fn close(mut self) -> Result<(), TransportError> {
        self.remove()
    }

    fn remove(&mut self) -> Result<(), TransportError> {
        self.services = None;
        self.claim.take().map_or(Ok(()), |claim| claim.remove())
    }
}

impl<G: Gene> Drop for ServiceHost<G> {
    fn drop(&mut self) {
        // There is nobody left to tell, and what is left over is some files.
        let _ = self.remove();
    }
}

impl<G: Gene> Services<G> {
    fn create(domain: &Domain, plan: &Plan, islands: u32) -> Result<Self, TransportError> {
        let node = services::join(domain)?;
        // The counter of processes, which the first of them makes, would be open to every user.
        SharedMemory::own().make_private(domain.run_id())?;
        let outboxes = |island| {
            let service = plan.outboxes::<G>(&node, island)?.create();
            service.map_err(|e| TransportError::setup("outboxes", e))
        };
        let requests = |island| {
            let service = plan.requests(&node, island)?.create();
            service.map_err(|e| TransportError::setup("requests", e))
        };
        let wake_ups = |island| {
            let service = plan.wake_up(&node, island)?.create();
            service.map_err(|e| TransportError::setup("wake-ups", e))
        };
        let reports = plan.reports::<G>(&node)?.create();
        Ok(Self {
            _outboxes: (0..islands).map(outboxes).collect::<Result<_, _>>()?,
            _requests: (0..islands).map(requests).collect::<Result<_, _>>()?,
            _wake_ups: (0..islands).map(wake_ups).collect::<Result<_, _>>()?,
            _reports: reports.map_err(|e| TransportError::setup("reports", e))?,
            node,
        })
    }
}
