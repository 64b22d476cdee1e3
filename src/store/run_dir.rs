//! Where everything of a run lies.

use super::StoreError;
use std::path::{Path, PathBuf};

/// The folder of one run:
///
/// ```text
/// run.toml                                the complete configuration
/// metrics.csv                             a row an island and generation
/// champion.csv  champion.urdf             the best creature ever: its genome and its body
/// summary.json                            digest, best fitness, evaluations, throughput
/// recording.rrd                           the run as a film
/// champions/island-<i>.log                every champion of an island
/// migrations/island-<i>.log               every outbox that an island sent
/// metrics/island-<i>.csv                  an island's rows of metrics.csv, as it goes
/// checkpoints/island-<i>/<generation>.ckpt   an island's state
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunDir(PathBuf);

impl RunDir {
    /// The run in this folder, which need not exist.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    /// Makes the folder and those in it. It may exist, but only empty.
    ///
    /// # Errors
    /// If it cannot be made or has something in it.
    pub fn create(&self, islands: u32) -> Result<(), StoreError> {
        let occupied = std::fs::read_dir(&self.0).is_ok_and(|mut entries| entries.next().is_some());
        if occupied {
            let source = std::io::Error::other("it is not empty");
            return Err(StoreError::io("use", &self.0)(source));
        }
        let checkpoints = (0..islands).map(|island| self.checkpoints(island));
        let folders = ["champions", "migrations", "metrics"].map(|name| self.0.join(name));
        for folder in folders.into_iter().chain(checkpoints) {
            std::fs::create_dir_all(&folder).map_err(StoreError::io("make the folder", &folder))?;
        }
        Ok(())
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// The configuration.
    pub fn config(&self) -> PathBuf {
        self.0.join("run.toml")
    }

    /// The metrics of all islands.
    pub fn metrics(&self) -> PathBuf {
        self.0.join("metrics.csv")
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

    /// An island's champions.
    pub fn champions(&self, island: u32) -> PathBuf {
        self.0.join("champions").join(format!("island-{island}.log"))
    }

    /// An island's journal.
    pub fn migrations(&self, island: u32) -> PathBuf {
        self.0.join("migrations").join(format!("island-{island}.log"))
    }

    /// An island's metrics.
    pub fn island_metrics(&self, island: u32) -> PathBuf {
        self.0.join("metrics").join(format!("island-{island}.csv"))
    }

    /// The folder of an island's checkpoints; nothing else lies there.
    pub fn checkpoints(&self, island: u32) -> PathBuf {
        self.0.join("checkpoints").join(format!("island-{island}"))
    }

    /// An island's checkpoint after a generation.
    pub fn checkpoint(&self, island: u32, generation: u32) -> PathBuf {
        self.checkpoints(island).join(format!("{generation}.ckpt"))
    }
}
