//! A film that is over takes less room: many small pieces, as they came, become few large ones.
//!
//! While a run goes on every row is written at once, so that whoever opens the file sees all that there is; each
//! brings a kilobyte that says what it is. In the end rows of a kind are put together. A champion that stays is filmed
//! again in every slot: within one piece compression finds that out, too.

use super::file::RrdFile;
use rerun::StoreId;
use rerun::StoreKind;
use rerun::external::re_log_encoding::DecoderApp;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::LogSink;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A piece with so many rows is large enough: it is what a viewer loads at a time.
const ROWS: usize = 4096;
/// So many pieces of a kind are kept at most: a piece of a row takes kilobytes of memory.
const PIECES: usize = 64;

/// Writes the recording `from` again, in larger pieces. Equal recordings become equal ones, whenever their rows came.
///
/// # Errors
/// If one cannot be read, or the other not be written.
pub fn pack(from: &Path, to: File) -> Result<(), String> {
    let file = BufReader::new(File::open(from).map_err(|error| error.to_string())?);
    let file = RrdFile::new(to).map_err(|error| error.to_string()).map(|to| (file, to));
    let (from, to) = file?;
    let mut packer = Packer { to, heaps: BTreeMap::new() };
    for message in DecoderApp::decode_eager(from).map_err(|error| error.to_string())? {
        packer.take(message.map_err(|error| error.to_string())?)?;
    }
    packer.finish()
}

struct Packer {
    to: RrdFile,
    /// What waits for more of its kind: of one entity, with the same components.
    heaps: BTreeMap<(String, Vec<String>), Heap>,
}

/// Pieces of a kind.
struct Heap {
    store: StoreId,
    chunks: Vec<Chunk>,
}

impl Packer {
    fn take(&mut self, message: LogMsg) -> Result<(), String> {
        match &message {
            LogMsg::ArrowMsg(store, arrow) if store.kind() == StoreKind::Recording => {
                let chunk = Chunk::from_arrow_msg(arrow).map_err(|error| error.to_string())?;
                // Of what stands still there is one row, and the order of writing tells which.
                if !chunk.is_static() {
                    return self.heap(store.clone(), chunk);
                }
            }
            _ => {}
        }
        self.to.send(message);
        Ok(())
    }

    fn heap(&mut self, store: StoreId, chunk: Chunk) -> Result<(), String> {
        let mut components: Vec<_> =
            chunk.components_identifiers().map(|component| component.to_string()).collect();
        components.sort();
        let key = (chunk.entity_path().to_string(), components);
        let heap = self.heaps.entry(key).or_insert_with(|| Heap { store, chunks: Vec::new() });
        heap.chunks.push(chunk);
        if heap.chunks.iter().map(Chunk::num_rows).sum::<usize>() >= ROWS {
            return heap.write(&self.to);
        }
        match heap.chunks.len() {
            PIECES => heap.join(),
            _ => Ok(()),
        }
    }

    fn finish(mut self) -> Result<(), String> {
        self.heaps.values_mut().try_for_each(|heap| heap.write(&self.to))?;
        self.to.finish()
    }
}

impl Heap {
    /// Writes all that there is as one piece.
    fn write(&mut self, to: &RrdFile) -> Result<(), String> {
        self.join()?;
        for chunk in self.chunks.drain(..) {
            let message = chunk.to_arrow_msg().map_err(|error| error.to_string())?;
            to.send(LogMsg::ArrowMsg(self.store.clone(), message));
        }
        Ok(())
    }

    /// Makes one piece of all that there is.
    fn join(&mut self) -> Result<(), String> {
        let mut chunks = std::mem::take(&mut self.chunks);
        // By twos: one after the other would copy the first rows again and again.
        while chunks.len() > 1 {
            let pairs = chunks.chunks(2).map(|pair| match pair {
                [first, second] => {
                    Chunk::concat_and_sort(first, second).map_err(|error| error.to_string())
                }
                rest => Ok(rest[0].clone()),
            });
            chunks = pairs.collect::<Result<_, _>>()?;
        }
        self.chunks = chunks;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::kit;
    use super::*;

    #[test]
    fn a_film_that_is_over_is_in_few_pieces_that_hold_every_row() {
        let generations = ROWS + 4;
        let chunks = kit::record(|recorder| {
            (0..generations as u32).try_for_each(|generation| {
                recorder.report(&kit::report(0, generation))?;
                recorder.event(Some(0), generation, "something")
            })
        });
        let rows = |path: &str| -> Vec<usize> {
            let here = chunks.iter().filter(|chunk| chunk.entity_path().to_string() == path);
            here.filter(|chunk| !chunk.is_static()).map(Chunk::num_rows).collect()
        };
        let mut events = rows("/events/0");
        events.sort_unstable();
        assert_eq!(events, [4, ROWS]);
        // Those of generations that have a row, and that of the last one.
        for path in ["/fitness/best/0", "/diversity/0", "/population/0"] {
            assert_eq!(rows(path), [1_280 + 2], "{path}");
        }
        let curve = chunks.iter().find(|chunk| chunk.num_rows() == ROWS).unwrap();
        assert!(curve.timelines().values().all(|times| times.is_sorted()));
    }

    #[test]
    fn what_is_no_recording_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
        assert!(pack(&from, File::create(&to).unwrap()).is_err());
        std::fs::write(&from, "no recording").unwrap();
        assert!(pack(&from, File::create(&to).unwrap()).is_err());
    }
}
