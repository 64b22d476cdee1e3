//! The end of those who only look: the launcher, for its progress bars, or somebody who watches by hand.

use super::limits::{Limits, Sighting};
use super::ports::{self, Inlet};
use super::services::{self, Node, Plan, WITH_SUCCESSOR};
use super::wire::ReportHeader;
use super::{Domain, TransportError};
use crate::archipelago::Archipelago;
use crate::evolution::Gene;

/// A reader of all islands' reports. It may be slow or die: no island notices.
#[derive(Debug)]
pub struct ReportReader<G: Gene> {
    limits: Limits,
    reports: Inlet<G, ReportHeader>,
    // Last, since the port above is its own.
    _node: Node,
}

impl<G: Gene> ReportReader<G> {
    /// Opens the reports of a run whose launcher is running. One that opens late still gets the last few of
    /// every island.
    ///
    /// # Errors
    /// If the launcher is gone, or somebody watches by hand already.
    pub fn open(domain: &Domain, archipelago: &Archipelago) -> Result<Self, TransportError> {
        let plan = Plan::new(domain, archipelago)?;
        let node = services::join(domain)?;
        let reports = ports::report_inlet(&plan, &node)?;
        Ok(Self { limits: plan.limits, reports, _node: node })
    }

    /// Takes all reports that have arrived, each island's in its order. Some may be missing, if nobody
    /// looked for long; an island that was born again repeats some. What is malformed is left out.
    pub fn receive(&self) -> Vec<Sighting<G>> {
        let mut sightings = Vec::new();
        let senders = WITH_SUCCESSOR * self.limits.islands as usize;
        ports::drain(&self.reports, senders, |header, genes| {
            sightings.extend(self.limits.sighting(header, genes).ok());
        });
        sightings
    }
}
