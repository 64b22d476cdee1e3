//! Giving free what dead islands held, at whatever instant they died.
//!
//! Every process writes down, below the run's folder, that it lives, and a tag for each service and port before
//! it makes it; iceoryx2 cleans up after a dead one by that. It does not cope with what was being written at
//! the instant of death: an object without a size makes it wait for ever, a tag that is not finished makes it
//! fail, and it overlooks events and connections that were made but not yet in use. So these are seen to here.
//!
//! What a process leaves that dies in the first moments of its life, before it holds anything, is some small
//! files below the run's folder. They look like those of one that is being born, and stay until the run ends.

use super::services::{Ipc, Node};
use super::shared_memory::{SharedMemory, unless_gone};
use super::{Domain, TransportError};
use iceoryx2::node::{DeadNodeView, NodeState, NodeView};
use iceoryx2::prelude::CallbackProgression;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// How often to try. A second time helps where something was short for a moment, as open files.
const ROUNDS: usize = 4;
/// The pause before trying again.
const PAUSE: Duration = Duration::from_millis(5);
/// How long to wait for someone else who cleans up: another thread of this process, since nobody else may.
const WAIT_MAX: Duration = Duration::from_millis(500);

// How iceoryx2 calls its files.
const NODES: &str = "nodes";
const DETAILS: &str = "node.details";
const PORT_TAG: &str = ".port_tag";
const SERVICE_TAG: &str = ".service_tag";
/// That a process lives is said by three files.
const LIVES: [&str; 3] = [".node_monitor", ".node_monitor_owner_lock", ".node_monitor_context"];
/// A listener's socket, which is called after its port.
const EVENT_SOCKET: &str = ".event";

/// The mode of a tag that is not finished. It is read-only then.
const UNFINISHED: u32 = 0o600;

/// Gives free what the dead processes of a domain held, and returns how many there were.
///
/// # Errors
/// If something is still held after several rounds.
pub fn clean_up(domain: &Domain, node: &Node) -> Result<u64, TransportError> {
    let memory = SharedMemory::own();
    let [mut buried, mut failed] = [BTreeSet::new(), BTreeSet::new()];
    for _ in 0..ROUNDS {
        memory.remove_stillborn(domain.run_id());
        let dead = dead(node);
        // Where one is missed that failed before, it holds its places for ever.
        if dead.as_ref().is_some_and(Vec::is_empty) && failed.is_empty() {
            return Ok(buried.len() as u64);
        }
        for dead in dead.into_iter().flatten() {
            let id = dead.id().value();
            if Grave::of(domain, id).bury(dead, &memory) {
                failed.remove(&id);
                buried.insert(id);
            } else {
                failed.insert(id);
            }
        }
        if !failed.is_empty() {
            thread::sleep(PAUSE);
        }
    }
    // None failed if they could not even be listed.
    Err(TransportError::Cleanup { dead: failed.len().max(1) as u64 })
}

/// The dead processes, if they could be listed.
fn dead(node: &Node) -> Option<Vec<DeadNodeView<Ipc>>> {
    let mut found = Vec::new();
    let listed = Node::list(node.config(), |state| {
        if let NodeState::Dead(dead) = state {
            found.push(dead);
        }
        CallbackProgression::Continue
    });
    listed.ok().map(|()| found)
}

/// The files of a dead process.
struct Grave<'a> {
    domain: &'a Domain,
    id: u128,
    folder: PathBuf,
}

impl<'a> Grave<'a> {
    fn of(domain: &'a Domain, id: u128) -> Self {
        Self { domain, id, folder: domain.root().join(NODES).join(id.to_string()) }
    }

    /// Returns whether nothing is left.
    fn bury(&self, dead: DeadNodeView<Ipc>, memory: &SharedMemory) -> bool {
        if dead.details().is_none() {
            return self.bury_empty().is_ok();
        }
        let Ok(ports) = self.remove_unfinished_tags() else { return false };
        let is_clean = dead.blocking_remove_stale_resources(WAIT_MAX).is_ok();
        is_clean && self.remove_called_after(&ports, memory).is_ok()
    }

    // It was killed in the last moments of an orderly end: everything was given back, and its details removed.
    fn bury_empty(&self) -> io::Result<()> {
        let prefix = self.domain.prefix();
        if self.folder.join(prefix.clone() + DETAILS).exists() {
            return Err(io::Error::other("the details could not be read"));
        }
        unless_gone(fs::remove_dir_all(&self.folder))?;
        let nodes = self.domain.root().join(NODES);
        LIVES.iter().try_for_each(|ending| {
            unless_gone(fs::remove_file(nodes.join(format!("{prefix}{}{ending}", self.id))))
        })
    }

    // Nothing was made yet of what they announce. Returns the ports that others announce.
    fn remove_unfinished_tags(&self) -> io::Result<BTreeSet<String>> {
        let mut ports = BTreeSet::new();
        for entry in fs::read_dir(&self.folder)? {
            let entry = entry?;
            let Ok(name) = entry.file_name().into_string() else { continue };
            let is_tag = name.ends_with(PORT_TAG) || name.ends_with(SERVICE_TAG);
            if is_tag && entry.metadata()?.permissions().mode() & 0o777 == UNFINISHED {
                fs::remove_file(entry.path())?;
            } else if let Some(port) = name.strip_suffix(PORT_TAG) {
                ports.extend(port.strip_prefix(&self.domain.prefix()).map(str::to_owned));
            }
        }
        Ok(ports)
    }

    // Of ports that were not in use yet when it was killed. Whoever uses one with it keeps it until he has
    // noticed: only the name goes.
    fn remove_called_after(
        &self,
        ports: &BTreeSet<String>,
        memory: &SharedMemory,
    ) -> io::Result<()> {
        for object in memory.objects(self.domain.run_id()) {
            let name = object.path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
            if name.split('_').any(|part| ports.contains(part)) {
                unless_gone(fs::remove_file(object.path))?;
            }
        }
        let name = |port| format!("{}{port}{EVENT_SOCKET}", self.domain.prefix());
        ports
            .iter()
            .try_for_each(|port| unless_gone(fs::remove_file(self.domain.root().join(name(port)))))
    }
}
