//! What all islands have reported, in the order of the run's metrics.

use crate::formats::metrics::Row;
use crate::store::{Entry, RunDir, StoreError, Tail};

/// Reads the reports of all islands, ordered by generation, then island. It holds one of each island, however long the
/// run was.
#[derive(Debug)]
pub struct Reports {
    islands: Vec<Source>,
}

#[derive(Debug)]
struct Source {
    tail: Tail<Entry>,
    /// The first that was not given yet.
    next: Option<Entry>,
    /// How long those took that were given.
    seconds: f64,
}

impl Reports {
    /// Those that are there so far.
    ///
    /// # Errors
    /// If one cannot be read.
    pub fn of(dir: &RunDir, islands: u32) -> Result<Self, StoreError> {
        let source = |island| {
            let mut tail = Tail::of(dir.reports(island));
            Ok(Source { next: tail.next_record()?, tail, seconds: 0.0 })
        };
        Ok(Self { islands: (0..islands).map(source).collect::<Result<_, _>>()? })
    }

    /// How long the slowest island took for what was read so far, in seconds.
    pub fn seconds(&self) -> f64 {
        self.islands.iter().map(|source| source.seconds).fold(0.0, f64::max)
    }
}

impl Iterator for Reports {
    type Item = Result<Row, StoreError>;

    fn next(&mut self) -> Option<Self::Item> {
        let waiting = self.islands.iter_mut().filter_map(Source::waiting);
        let (_, source, entry) = waiting.min_by_key(|(order, ..)| *order)?;
        source.seconds += entry.seconds;
        let next = source.tail.next_record();
        Some(next.map(|next| {
            source.next = next;
            Row::new(&entry.report, entry.seconds)
        }))
    }
}

impl Source {
    fn waiting(&mut self) -> Option<((u32, u32), &mut Self, Entry)> {
        let entry = self.next?;
        Some(((entry.report.generation, entry.report.island), self, entry))
    }
}
