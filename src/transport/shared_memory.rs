//! The files that runs have in shared memory: objects of iceoryx2's, and one claim a run.

use super::{TransportError, names};
use std::collections::BTreeMap;
use std::fs::{self, Metadata, Permissions};
use std::io;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// Where POSIX shared memory is to be found on Linux.
pub const SHARED_MEMORY: &str = "/dev/shm";

/// How long an object stays empty at most while a living process makes it. That takes microseconds, unless
/// the process has to wait for a core; and there is seldom anything to wait for.
const BIRTH_MAX: Duration = Duration::from_millis(50);

/// The mode of what is for one user only.
pub const PRIVATE: u32 = 0o600;

/// The unit of [`MetadataExt::blocks`].
const BLOCK: u64 = 512;

/// A folder with objects and claims, of which only one user's count: nobody else's is ever touched, not even
/// by a user who may.
#[derive(Debug, Clone)]
pub struct SharedMemory {
    folder: PathBuf,
    user: u32,
}

/// An object of a run.
#[derive(Debug)]
pub struct Object {
    pub path: PathBuf,
    /// The memory that it takes, in bytes.
    pub bytes: u64,
    inode: u64,
    is_empty: bool,
}

impl SharedMemory {
    /// This user's part of the machine's.
    pub fn own() -> Self {
        Self::new(SHARED_MEMORY, rustix::process::geteuid().as_raw())
    }

    /// A user's part of what is in a folder.
    pub fn new(folder: impl Into<PathBuf>, user: u32) -> Self {
        Self { folder: folder.into(), user }
    }

    /// The place of a run's claim.
    pub fn claim(&self, run_id: u64) -> PathBuf {
        self.folder.join(names::claim(run_id))
    }

    /// The runs that have a claim, in order.
    pub fn claimed(&self) -> Vec<u64> {
        let mut runs: Vec<u64> =
            self.names().iter().filter_map(|n| names::run_id_of_claim(n)).collect();
        runs.sort_unstable();
        runs
    }

    /// A run's objects. Its claim is none.
    pub fn objects(&self, run_id: u64) -> Vec<Object> {
        let [prefix, claim] = [names::prefix(run_id), names::claim(run_id)];
        let names = self.names().into_iter();
        let names = names.filter(|name| name.starts_with(&prefix) && *name != claim);
        names.filter_map(|name| self.object(self.folder.join(name))).collect()
    }

    /// Closes a run's objects to other users.
    pub fn make_private(&self, run_id: u64) -> Result<(), TransportError> {
        self.objects(run_id).iter().try_for_each(|Object { path, .. }| {
            let set = fs::set_permissions(path, Permissions::from_mode(PRIVATE));
            set.map_err(|source| TransportError::folder(path, source))
        })
    }

    /// Removes a run's objects.
    pub fn remove_objects(&self, run_id: u64) -> Result<(), TransportError> {
        self.objects(run_id).iter().try_for_each(|Object { path, .. }| {
            let removed = unless_gone(fs::remove_file(path));
            removed.map_err(|source| TransportError::folder(path, source))
        })
    }

    /// Removes what processes that were killed over making it have left, and returns how much there was:
    /// objects without a size, on which iceoryx2 waits for ever. What is only just being made is not empty
    /// when looked at twice, so that no clock is needed, which could be set back.
    pub fn remove_stillborn(&self, run_id: u64) -> usize {
        let empty = || {
            let empty = self.objects(run_id).into_iter().filter(|object| object.is_empty);
            empty.map(|object| (object.inode, object.path)).collect::<BTreeMap<_, _>>()
        };
        let before = empty();
        if before.is_empty() {
            return 0;
        }
        thread::sleep(BIRTH_MAX);
        let stillborn = empty().into_iter().filter(|(inode, _)| before.contains_key(inode));
        stillborn.filter(|(_, path)| fs::remove_file(path).is_ok()).count()
    }

    /// Whether a file or folder is this user's.
    pub fn owns(&self, status: &Metadata) -> bool {
        status.uid() == self.user
    }

    fn object(&self, path: PathBuf) -> Option<Object> {
        let status = fs::symlink_metadata(&path).ok()?;
        let is_object = status.is_file() && self.owns(&status);
        is_object.then(|| Object {
            path,
            bytes: status.blocks() * BLOCK,
            inode: status.ino(),
            is_empty: status.len() == 0,
        })
    }

    fn names(&self) -> Vec<String> {
        let Ok(entries) = fs::read_dir(&self.folder) else { return Vec::new() };
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        names.collect()
    }
}

/// A removal that is also content if somebody else was faster.
pub fn unless_gone(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}
