//! Where everything of an experiment lies.

use super::run_dir::{Claim, make};
use super::{RunDir, StoreError, atomic};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of an experiment:
///
/// ```text
/// experiment.toml                   the definition as it was run
/// runs/seed<seed>-<settings>.json   a run that has finished; <settings> is a hash of all that decides it
/// runs.csv  curves.csv              a row a run, and a row a run and generation
/// summary.csv  comparisons.csv      a row a setting, and a row a pair of settings
/// summary.md  convergence.svg       the same for people
/// .partial/                         what is not whole yet, while an experiment is under way
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExperimentDir(RunDir);

impl ExperimentDir {
    /// The experiment in this folder, which need not exist.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self(RunDir::at(path))
    }

    /// Makes the folder, for this user only, and claims it for this process. It may hold an experiment, or nothing.
    ///
    /// # Errors
    /// If it cannot be made, has something else in it or is another process's.
    pub fn claim(&self) -> Result<Claim, StoreError> {
        make(self.path())?;
        let claim = self.0.claim()?;
        if !self.definition().exists() && !self.is_empty()? {
            let source = std::io::Error::other("it holds something that is no experiment");
            return Err(StoreError::io("use", self.path())(source));
        }
        make(&self.0.partial())?;
        make(&self.path().join("runs"))?;
        claim.sweep();
        Ok(claim)
    }

    /// Whether there is nothing but what a claim makes.
    fn is_empty(&self) -> Result<bool, StoreError> {
        let entries =
            std::fs::read_dir(self.path()).map_err(StoreError::io("read", self.path()))?;
        let [partial, runs] = [self.0.partial(), self.path().join("runs")];
        let mut entries = entries.map(|entry| entry.map(|entry| entry.path()));
        Ok(entries.all(|path| path.is_ok_and(|path| path == partial || path == runs)))
    }

    /// Writes a file of the experiment, durably and whole or not at all.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn write(
        &self,
        path: &Path,
        fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> Result<(), StoreError> {
        atomic::write(&self.0.partial(), path, fill)
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// The definition.
    pub fn definition(&self) -> PathBuf {
        self.path().join("experiment.toml")
    }

    /// A run that has finished, with this seed and settings of this hash.
    pub fn run(&self, seed: u64, settings: &str) -> PathBuf {
        self.path().join("runs").join(format!("seed{seed}-{settings}.json"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_one_experiments_and_has_one_owner_at_a_time() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let dir = ExperimentDir::at(folder.path().join("a/b"));
        let claim = dir.claim().expect("it is new");
        assert!(matches!(dir.claim(), Err(StoreError::UnderWay { .. })));
        drop(claim);
        // As it is if it was killed before it had written its definition.
        drop(dir.claim().expect("it has only our folders"));
        std::fs::write(dir.path().join("precious"), "").expect("it is writable");
        assert!(dir.claim().is_err());
        std::fs::write(dir.definition(), "").expect("it is writable");
        assert!(dir.claim().is_ok());
    }
}
