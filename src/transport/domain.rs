//! Where one run's shared memory lives, apart from every other run's.

use super::TransportError;
use super::claim::Claim;
use super::names;
use super::remains::{self, Remains};
use super::shared_memory::{SHARED_MEMORY, SharedMemory};
use iceoryx2::prelude::{Config, FileName, LogLevel, Path, SemanticString, set_log_level};
use std::fmt;
use std::fs::{self, DirBuilder, Permissions};
use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
use std::path::{Path as FsPath, PathBuf};
use std::str::FromStr;

/// The place of one run: a prefix for all its objects in shared memory, and a folder for its files.
///
/// Both follow from the run's id, so that a child needs nothing else to find its run: hand it
/// `domain.to_string()`, and it parses that.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Domain {
    run_id: u64,
    root: PathBuf,
}

impl Domain {
    /// The domain of a run. The id must be one that no other run on this machine has.
    pub fn new(run_id: u64) -> Self {
        Self { run_id, root: names::root(run_id) }
    }

    /// The run's id.
    pub fn run_id(&self) -> u64 {
        self.run_id
    }

    /// The folder of the run's files.
    pub fn root(&self) -> &FsPath {
        &self.root
    }

    /// What the names of all objects of the run in shared memory begin with.
    pub fn prefix(&self) -> String {
        names::prefix(self.run_id)
    }

    /// What runs of this user have left behind on this machine whose launcher was killed, whatever their
    /// folder for temporary files was. Removes nothing.
    ///
    /// Objects without a claim are none of it: claims are made before them and removed after them, so that
    /// they can only come from a claim that was removed by hand. Nobody can tell then whether the run lives;
    /// the same hand has to remove them.
    pub fn abandoned() -> Vec<Remains> {
        remains::abandoned(&SharedMemory::own())
    }

    /// Removes what can be removed of it.
    pub fn remove_abandoned() {
        for remains in Self::abandoned() {
            // Another launcher may be at it, and what cannot be removed is in nobody's way.
            let _ = remains.remove();
        }
    }

    /// Claims the domain and makes its folder, for this user only.
    ///
    /// # Errors
    /// If it is claimed already, or cannot be made.
    pub(super) fn create(&self) -> Result<Claim, TransportError> {
        let claim = Claim::make(&SharedMemory::own(), self.run_id, &self.root)?;
        let made = || {
            DirBuilder::new().mode(0o700).create(&self.root)?;
            // Once more, since the mode above is subject to the umask.
            fs::set_permissions(&self.root, Permissions::from_mode(0o700))
        };
        match made() {
            Ok(()) => Ok(claim),
            Err(source) => {
                claim.withdraw();
                Err(TransportError::folder(&self.root, source))
            }
        }
    }

    /// The configuration of iceoryx2 that keeps to this domain.
    ///
    /// Nobody cleans up on the way: only the launcher knows who is dead, and two cleaners at once, or one
    /// in an island that is killed meanwhile, leave more behind than they remove.
    pub(super) fn config(&self) -> Result<Config, TransportError> {
        // Its warnings are whole data structures, and every one of them is handled here.
        set_log_level(LogLevel::Error);
        let mut config = Config::default();
        let root = self.root.to_string_lossy();
        let path = Path::new(root.as_bytes()).map_err(|e| TransportError::setup("the path", e))?;
        config.global.set_root_path(&path);
        config.global.prefix = FileName::new(self.prefix().as_bytes())
            .map_err(|e| TransportError::setup("the prefix", e))?;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        Ok(config)
    }

    /// Checks that shared memory has `needed` free bytes. Without them a write into it would end the
    /// process by SIGBUS, in the middle of a run.
    ///
    /// # Errors
    /// If there are fewer.
    pub fn check_space(&self, needed: u64) -> Result<(), TransportError> {
        // Where there is no such folder, shared memory has no size that could be asked for.
        let Ok(status) = rustix::fs::statvfs(SHARED_MEMORY) else { return Ok(()) };
        let free = status.f_bavail.saturating_mul(status.f_frsize);
        if free < needed {
            let [needed_mib, free_mib] = [needed.div_ceil(1 << 20), free >> 20];
            return Err(TransportError::NoSpace { path: SHARED_MEMORY, needed_mib, free_mib });
        }
        Ok(())
    }
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.run_id)
    }
}

impl FromStr for Domain {
    type Err = TransportError;

    fn from_str(text: &str) -> Result<Self, TransportError> {
        let run_id = u64::from_str_radix(text, 16);
        run_id.map(Self::new).map_err(|_| TransportError::RunId { text: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_domain_survives_being_an_argument_and_is_unlike_any_other() {
        let domain = Domain::new(0x2a);
        assert_eq!(domain.to_string(), "000000000000002a");
        assert_eq!(domain.to_string().parse::<Domain>().unwrap(), domain);
        assert!("forty-two".parse::<Domain>().is_err());
        assert_ne!(domain.prefix(), Domain::new(0x2b).prefix());
        assert_ne!(domain.root(), Domain::new(0x2b).root());
    }

    #[test]
    fn too_little_shared_memory_is_said_in_numbers() {
        let error = Domain::new(1).check_space(u64::MAX).unwrap_err().to_string();
        assert!(error.contains("17592186044416 MiB") && error.contains("/dev/shm"), "{error}");
        Domain::new(1).check_space(0).unwrap();
    }
}
