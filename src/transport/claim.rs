//! Whose a run's shared memory is: a file beside it, which its launcher holds a lock on while it lives.
//!
//! The claim is made before everything else of a run and removed after it, and the system gives the lock free
//! when the launcher ends, however it ends. So whatever of a run is in shared memory has a claim, and a claim
//! without a lock is a dead launcher's. No clock is asked. Who cleans up holds the lock meanwhile.
//!
//! The claim says where the run's folder is, since every launcher may have another folder for temporary
//! files. What it says is not believed but checked.

use super::TransportError;
use super::names;
use super::shared_memory::{PRIVATE, SharedMemory, unless_gone};
use rustix::fs::OFlags;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Read, Write};
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};

/// Longer paths do not exist, in bytes.
const PATH_MAX: u64 = 4096;

/// A run's claim, locked for as long as this lives. Dropping it does not remove it.
#[derive(Debug)]
pub struct Claim {
    run_id: u64,
    memory: SharedMemory,
    /// The run's folder, if there is one.
    folder: PathBuf,
    // Held open: the lock is its own.
    file: File,
}

/// What there is to say about the claim of a run.
#[derive(Debug)]
pub enum Found {
    /// Its launcher is dead, and it is held from now on.
    Abandoned(Claim),
    /// Somebody holds it: its launcher, or somebody who cleans up.
    Held,
    /// There is none, or it is another user's.
    Gone,
}

impl Claim {
    /// Claims a run whose folder will be `root`.
    ///
    /// # Errors
    /// If somebody has claimed it, or the claim cannot be made.
    pub fn make(memory: &SharedMemory, run_id: u64, root: &Path) -> Result<Self, TransportError> {
        let path = memory.claim(run_id);
        let file = make_locked(&path).map_err(|source| TransportError::folder(&path, source))?;
        let (memory, folder) = (memory.clone(), root.to_owned());
        let claim = Self { run_id, memory, folder, file };
        let write = |mut file: &File| {
            // Once more, since the mode that it was made with is subject to the umask.
            file.set_permissions(Permissions::from_mode(PRIVATE))?;
            file.write_all(root.as_os_str().as_bytes())
        };
        write(&claim.file).map_err(|source| {
            claim.withdraw();
            TransportError::folder(&path, source)
        })?;
        Ok(claim)
    }

    /// Looks after the claim of a run, and takes it over if nobody holds it.
    pub fn take_over(memory: &SharedMemory, run_id: u64) -> Found {
        let Some(file) = open(memory, run_id) else { return Found::Gone };
        if file.try_lock().is_err() {
            return Found::Held;
        }
        if !has_name(&file).unwrap_or(false) {
            return Found::Gone;
        }
        let folder = named_folder(&file, run_id);
        let folder = folder.unwrap_or_else(|| names::root(run_id));
        Found::Abandoned(Self { run_id, memory: memory.clone(), folder, file })
    }

    /// The run's folder if it exists and may be removed: it is a folder, no link to one, and this user's.
    pub fn folder(&self) -> Option<&Path> {
        let status = fs::symlink_metadata(&self.folder).ok()?;
        (status.is_dir() && self.memory.owns(&status)).then_some(&self.folder)
    }

    /// Removes all that the run has, and the claim last: what cannot be removed stays claimed, for the next
    /// one who cleans up.
    ///
    /// # Errors
    /// If something cannot be removed.
    pub fn remove(&self) -> Result<(), TransportError> {
        // Islands die a moment after their launcher, and may make something until then: so twice.
        for _ in 0..2 {
            self.memory.remove_objects(self.run_id)?;
            if let Some(folder) = self.folder() {
                unless_gone(fs::remove_dir_all(folder))
                    .map_err(|source| TransportError::folder(folder, source))?;
            }
        }
        let path = self.memory.claim(self.run_id);
        unless_gone(fs::remove_file(&path)).map_err(|source| TransportError::folder(&path, source))
    }

    /// Gives the claim up, and leaves everything else as it is.
    pub fn withdraw(&self) {
        // A claim that stays is one of a dead launcher, as soon as this process ends.
        let _ = fs::remove_file(self.memory.claim(self.run_id));
    }
}

fn make_locked(path: &Path) -> io::Result<File> {
    loop {
        let file = OpenOptions::new().write(true).create_new(true).mode(PRIVATE).open(path)?;
        file.lock()?;
        // Before it had its lock it was like a dead launcher's, and may have been cleaned away.
        if has_name(&file)? {
            return Ok(file);
        }
    }
}

fn has_name(file: &File) -> io::Result<bool> {
    Ok(file.metadata()?.nlink() > 0)
}

// Something else of that name must neither lead elsewhere nor be waited for.
fn open(memory: &SharedMemory, run_id: u64) -> Option<File> {
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed();
    let file = OpenOptions::new().read(true).custom_flags(flags).open(memory.claim(run_id)).ok()?;
    let status = file.metadata().ok()?;
    (status.is_file() && memory.owns(&status)).then_some(file)
}

// The folder that a claim names, if it can be the run's. A claim names none if its launcher died too early.
fn named_folder(file: &File, run_id: u64) -> Option<PathBuf> {
    let mut text = Vec::new();
    file.take(PATH_MAX).read_to_end(&mut text).ok()?;
    let path = PathBuf::from(OsString::from_vec(text));
    let is_it =
        path.is_absolute() && path.file_name().is_some_and(|name| *name == *names::folder(run_id));
    // Put together again, since a slash at its end would follow a link.
    is_it.then(|| path.components().collect())
}
