//! Genomes whose evaluation panicked: a bug, and nobody finds it without them.

use crate::app::console::say;
use crate::archipelago::Step;
use crate::runs::subject::Subject;
use crate::store::RunDir;

/// Who finds no bug with so many genomes finds none with more, and a run may be long.
const KEPT_MAX: usize = 10;

/// What an island's process keeps of them.
pub struct Panics<'a> {
    dir: &'a RunDir,
    kept: usize,
}

impl<'a> Panics<'a> {
    /// Nothing yet, of a run in a folder.
    pub fn of(dir: &'a RunDir) -> Self {
        Self { dir, kept: 0 }
    }

    /// Writes the genomes of a generation into the run's folder, and tells the user about each. Only the first of a
    /// process are kept. A run whose disk is full goes on: it has its own word about that.
    pub fn keep<P: Subject>(&mut self, problem: &P, step: &Step<P::Gene>) {
        let (island, generation) = (step.report.island, step.report.generation);
        let room = KEPT_MAX - self.kept;
        for (count, genome) in step.panicked.iter().take(room).enumerate() {
            let path = self.dir.panic(island, generation, count);
            let place = path.display();
            say(&match self.dir.write(&path, |file| problem.write_genome(genome, file)) {
                Ok(()) => format!(
                    "warning: evaluating a genome made the program panic, and counts as failed: this is a bug; its \
                     genome is in {place}, see: islands evaluate {place}"
                ),
                Err(error) => format!("warning: a genome that shows a bug is lost: {error}"),
            });
            self.kept += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::island;
    use crate::creature::Gene;
    use crate::creature::encodings::course::PARAMETER_COUNT;
    use crate::evolution::Founders;
    use crate::formats::genome_csv;
    use crate::runs::config::Config;
    use std::fs::File;

    #[test]
    fn genomes_that_made_an_evaluation_panic_are_kept_but_not_without_end() {
        let folder = tempfile::tempdir().unwrap();
        let dir = RunDir::at(folder.path().join("run"));
        let _claim = dir.create().unwrap();
        let config = Config { population: 2, elites: 1, genes: 1, ..Config::default() };
        let problem = config.locomotion();
        let mut step = island::genesis(&problem, &Founders::NONE, &config.archipelago(), 0);
        let genome = |value: usize| vec![Gene([value as f64 / 32.0; PARAMETER_COUNT])];
        step.report.island = 3;
        step.panicked = (0..7).map(genome).collect();
        let mut panics = Panics::of(&dir);
        for generation in 5..8 {
            step.report.generation = generation;
            panics.keep(&problem, &step);
        }
        let read = |generation, count| {
            let file = File::open(dir.panic(3, generation, count)).ok()?;
            Some(genome_csv::read(&problem.encoding, file).unwrap().genome)
        };
        assert_eq!(read(5, 6), Some(genome(6)));
        assert_eq!(read(6, 2), Some(genome(2)));
        assert_eq!((read(6, 3), read(7, 0)), (None, None));
    }
}
