//! An island's checkpoints: the newest two, so that one of them is whole whatever happened to the other.

use super::checkpoint::{self, Checkpoint};
use super::{RunDir, StoreError};
use crate::evolution::Gene;
use std::path::PathBuf;

/// How many are kept.
const KEPT: usize = 2;

/// The folder of an island's checkpoints.
#[derive(Debug, Clone)]
pub struct Checkpoints {
    dir: RunDir,
    island: u32,
}

impl Checkpoints {
    /// The checkpoints of an island of a run.
    pub fn of(dir: &RunDir, island: u32) -> Self {
        Self { dir: dir.clone(), island }
    }

    /// Saves a state and removes all but it and the newest one before it. Those of later generations are of no
    /// use: the island did not start from them, since they or what belongs to them are damaged.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn save<G: Gene>(&self, checkpoint: &Checkpoint<G>) -> Result<(), StoreError> {
        let generation = checkpoint.island.generation;
        let path = self.dir.checkpoint(self.island, generation);
        checkpoint::save(&self.dir.partial(), &path, checkpoint)?;
        self.remove(|saved| saved > generation)?;
        self.remove_older_than(generation)
    }

    /// Removes all that are older than a whole one but for the newest of them: those that a kill has left over between
    /// saving and removing.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn remove_older_than(&self, generation: u32) -> Result<(), StoreError> {
        let older = self.generations()?.into_iter().filter(|&saved| saved < generation);
        let useless: Vec<u32> = older.skip(KEPT - 1).collect();
        self.remove(|saved| useless.contains(&saved))
    }

    fn remove(&self, is_useless: impl Fn(u32) -> bool) -> Result<(), StoreError> {
        for useless in self.generations()?.into_iter().filter(|&saved| is_useless(saved)) {
            let path = self.dir.checkpoint(self.island, useless);
            std::fs::remove_file(&path).map_err(StoreError::io("remove", &path))?;
        }
        Ok(())
    }

    /// The generations that there is a checkpoint of, whole or not; the newest first.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn generations(&self) -> Result<Vec<u32>, StoreError> {
        let folder = self.dir.checkpoints(self.island);
        let entries = std::fs::read_dir(&folder).map_err(StoreError::io("read", &folder))?;
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let generation = |name: String| {
            let number = name.strip_suffix(".ckpt")?.parse().ok()?;
            // Only one name means a generation: not +7 or 007.
            (self.dir.checkpoint(self.island, number).file_name()? == name.as_str())
                .then_some(number)
        };
        let mut generations: Vec<u32> = names.filter_map(generation).collect();
        generations.sort_unstable_by(|a, b| b.cmp(a));
        Ok(generations)
    }

    /// Every checkpoint as it is, whole or not, the newest first.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn load<G: Gene>(
        &self,
    ) -> Result<impl Iterator<Item = (PathBuf, Result<Checkpoint<G>, StoreError>)>, StoreError>
    {
        let (dir, island) = (self.dir.clone(), self.island);
        Ok(self.generations()?.into_iter().map(move |generation| {
            let path = dir.checkpoint(island, generation);
            let checkpoint = checkpoint::load(&path);
            let is_named_rightly = |checkpoint: &Checkpoint<G>| {
                (checkpoint.island.index, checkpoint.island.generation) == (island, generation)
            };
            let checkpoint =
                checkpoint.and_then(|checkpoint| match is_named_rightly(&checkpoint) {
                    true => Ok(checkpoint),
                    false => {
                        Err(StoreError::damaged(&path, "it is of another island or generation"))
                    }
                });
            (path, checkpoint)
        }))
    }
}
