//! Where everything of a run lies, and whose it is.

use super::{StoreError, atomic, file};
use std::fs::{DirBuilder, File, TryLockError};
use std::io::{ErrorKind, Write};
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

/// The folder of one run:
///
/// ```text
/// run.toml                                the complete configuration
/// seed-genomes.csv                        the genomes that it began with, if they are not all random
/// terrain.csv                             what its creatures stood on, if it was another ground than the task's
/// run.log                                 what happened: starts, deaths, restarts, warnings
/// metrics.csv                             a row an island and generation
/// champion.csv  champion.urdf             the best creature ever: its genome and its body
/// map.csv  map/<x>-<y>.csv                the best of each cell of a map of features, if one was drawn
/// summary.json                            digest, best fitness, evaluations, throughput
/// recording.rrd                           the run as a film
/// panic-<i>.<generation>.<k>.csv          a genome whose evaluation panicked on island i: a bug
/// champions/island-<i>.log                every champion of an island
/// reports/island-<i>.log                  what every generation of an island was like
/// lineages/island-<i>.log                 who was born of whom on an island, generation by generation
/// migrations/island-<i>.log               every outbox that an island sent
/// arrivals/island-<i>.log                 what an island took in, where islands do not wait for each other
/// checkpoints/island-<i>/<generation>.ckpt   an island's state: the newest two
/// .partial/                               what is not whole yet, while a launcher is at work
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunDir(PathBuf);

/// The right to write in a run's folder, for one launcher at a time, until it is dropped or its process ends.
#[derive(Debug)]
pub struct Claim {
    dir: RunDir,
    // Held open: the lock on the folder itself.
    _folder: File,
}

impl RunDir {
    /// The run in this folder, which need not exist.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    /// Makes the folder, for this user only, and claims it. It may exist, but only empty, or as a launcher left it
    /// that was killed before it had written the configuration: that is what makes it a run's. After that,
    /// [`Claim::make_folders`] makes the others.
    ///
    /// # Errors
    /// If it cannot be made, has something in it or is another launcher's.
    pub fn create(&self) -> Result<Claim, StoreError> {
        make_durably(&self.0)?;
        let folder = self.lock()?;
        let mut entries = std::fs::read_dir(&self.0).map_err(StoreError::io("read", &self.0))?;
        let (partial, copies) = (self.partial(), [self.seed_genomes(), self.terrain()]);
        let is_known =
            |path: PathBuf| path == partial || (copies.contains(&path) && partial.exists());
        if entries.any(|entry| !entry.is_ok_and(|entry| is_known(entry.path()))) {
            let source = std::io::Error::other("it is not empty");
            return Err(StoreError::io("use", &self.0)(source));
        }
        make(&partial)?;
        let claim = Claim { dir: self.clone(), _folder: folder };
        claim.sweep();
        Ok(claim)
    }

    /// Claims a run that exists, once no other launcher has it.
    ///
    /// # Errors
    /// If there is no such folder, or another launcher has it.
    pub fn claim(&self) -> Result<Claim, StoreError> {
        Ok(Claim { dir: self.clone(), _folder: self.lock()? })
    }

    /// Locks the folder. What is in it may be somebody else's: only a claim, once dropped, removes any of it.
    fn lock(&self) -> Result<File, StoreError> {
        let folder = file::open_folder(&self.0)?;
        match folder.try_lock() {
            Ok(()) => Ok(folder),
            Err(TryLockError::WouldBlock) => Err(StoreError::UnderWay { path: self.0.clone() }),
            Err(TryLockError::Error(source)) => Err(StoreError::io("lock", &self.0)(source)),
        }
    }

    /// Whether a launcher has claimed it.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn is_under_way(&self) -> Result<bool, StoreError> {
        let folder = file::open_folder(&self.0)?;
        Ok(matches!(folder.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }

    /// Writes a file of the run, durably and whole or not at all.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn write(
        &self,
        path: &Path,
        fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> Result<(), StoreError> {
        atomic::write(&self.partial(), path, fill)
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Whether a run is in the folder: whether there is a configuration.
    ///
    /// # Errors
    /// If the system does not let that be known.
    pub fn holds_run(&self) -> Result<bool, StoreError> {
        self.config().try_exists().map_err(StoreError::io("look for", &self.config()))
    }

    /// The configuration.
    pub fn config(&self) -> PathBuf {
        self.0.join("run.toml")
    }

    /// The genomes that the run began with, if they were not all random.
    pub fn seed_genomes(&self) -> PathBuf {
        self.0.join("seed-genomes.csv")
    }

    /// What the creatures stood on, if it was another ground than the task's.
    pub fn terrain(&self) -> PathBuf {
        self.0.join("terrain.csv")
    }

    /// What happened.
    pub fn log(&self) -> PathBuf {
        self.0.join("run.log")
    }

    /// The metrics of all islands.
    pub fn metrics(&self) -> PathBuf {
        self.0.join("metrics.csv")
    }

    /// The map of elites.
    pub fn map(&self) -> PathBuf {
        self.0.join("map.csv")
    }

    /// The genome in a cell of it.
    pub fn map_genome(&self, [x, y]: [u32; 2]) -> PathBuf {
        self.0.join("map").join(format!("{x}-{y}.csv"))
    }

    /// Makes the folder of those genomes.
    ///
    /// # Errors
    /// If it cannot be made, or is a link.
    pub fn make_map(&self) -> Result<(), StoreError> {
        make(&self.0.join("map"))
    }

    /// The genome of the best creature ever.
    pub fn champion_genome(&self) -> PathBuf {
        self.0.join("champion.csv")
    }

    /// The body of the best creature ever.
    pub fn champion_body(&self) -> PathBuf {
        self.0.join("champion.urdf")
    }

    /// The result.
    pub fn summary(&self) -> PathBuf {
        self.0.join("summary.json")
    }

    /// The film.
    pub fn recording(&self) -> PathBuf {
        self.0.join("recording.rrd")
    }

    /// A genome whose evaluation panicked, the `count`th of its island and generation.
    pub fn panic(&self, island: u32, generation: u32, count: usize) -> PathBuf {
        self.0.join(format!("panic-{island}.{generation}.{count}.csv"))
    }

    /// An island's champions.
    pub fn champions(&self, island: u32) -> PathBuf {
        self.0.join("champions").join(format!("island-{island}.log"))
    }

    /// An island's generations.
    pub fn reports(&self, island: u32) -> PathBuf {
        self.0.join("reports").join(format!("island-{island}.log"))
    }

    /// Who was born on an island, of whom.
    pub fn lineages(&self, island: u32) -> PathBuf {
        self.0.join("lineages").join(format!("island-{island}.log"))
    }

    /// An island's journal.
    pub fn migrations(&self, island: u32) -> PathBuf {
        self.0.join("migrations").join(format!("island-{island}.log"))
    }

    /// What an island took in, where islands do not wait for each other.
    pub fn arrivals(&self, island: u32) -> PathBuf {
        self.0.join("arrivals").join(format!("island-{island}.log"))
    }

    /// The folder of an island's checkpoints; nothing else lies there.
    pub fn checkpoints(&self, island: u32) -> PathBuf {
        self.0.join("checkpoints").join(format!("island-{island}"))
    }

    /// An island's checkpoint after a generation.
    pub fn checkpoint(&self, island: u32, generation: u32) -> PathBuf {
        self.checkpoints(island).join(format!("{generation}.ckpt"))
    }

    /// The folder of files that are not whole yet.
    pub fn partial(&self) -> PathBuf {
        self.0.join(".partial")
    }
}

impl Claim {
    /// Makes the folders of the run that are missing, and removes what was not whole when its processes died.
    ///
    /// # Errors
    /// If they cannot be made, or are links, which may lead out of the run's folder.
    pub fn make_folders(&self, islands: u32) -> Result<(), StoreError> {
        let RunDir(root) = &self.dir;
        let folders = ["champions", "lineages", "reports", "migrations", "checkpoints"];
        let folders = folders.map(|folder| root.join(folder));
        let checkpoints = (0..islands).map(|island| self.dir.checkpoints(island));
        let partial = [self.dir.partial()];
        folders.into_iter().chain(partial).chain(checkpoints).try_for_each(|f| make(&f))?;
        self.sweep();
        Ok(())
    }

    /// Makes the folder of what islands take in, which only runs have in which they do not wait for each other.
    ///
    /// # Errors
    /// Like [`Claim::make_folders`].
    pub fn make_arrivals(&self) -> Result<(), StoreError> {
        make(&self.dir.path().join("arrivals"))
    }

    pub(super) fn sweep(&self) {
        // What a link leads to is somebody else's.
        if is_link(&self.dir.partial()) {
            return;
        }
        let leftovers = std::fs::read_dir(self.dir.partial()).into_iter().flatten().flatten();
        for leftover in leftovers {
            // What cannot be removed is in nobody's way.
            let _ = std::fs::remove_file(leftover.path());
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        self.sweep();
        // It may never have been made, and an empty folder is in nobody's way.
        let _ = std::fs::remove_dir(self.dir.partial());
    }
}

fn private() -> DirBuilder {
    let mut builder = DirBuilder::new();
    builder.recursive(true).mode(0o700);
    builder
}

/// Makes a folder of a run; it may exist, but not as a link.
pub(super) fn make(folder: &Path) -> Result<(), StoreError> {
    make_durably(folder)?;
    if is_link(folder) {
        return Err(StoreError::damaged(
            folder,
            "it is a link, and may lead out of the run's folder",
        ));
    }
    Ok(())
}

/// Makes a folder and those that it lies in, and makes its name durable, and those of all that are new. Its own also where
/// it is there: who made it may have been killed before doing that.
fn make_durably(folder: &Path) -> Result<(), StoreError> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    private().create(folder).map_err(StoreError::io("make the folder", folder))?;
    if missing.is_empty() {
        // Whose parent may not be read was not made by us.
        return match atomic::sync_name(folder) {
            Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::PermissionDenied => {
                Ok(())
            }
            synced => synced,
        };
    }
    missing.into_iter().rev().try_for_each(atomic::sync_name)
}

fn is_link(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|status| status.is_symlink())
}
