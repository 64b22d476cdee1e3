//! How bytes become the files of a run and what travels between islands, with the checksums that let them
//! through to what lies behind.

use islands::archipelago::{Archipelago, Migration, Topology};
use islands::creature::Gene;
use islands::creature::encodings::course::PARAMETER_COUNT;
use islands::evolution::{Evaluation, Problem, Selection, Strategy, Variation};
use islands::rng::Stream;
use islands::store::RunDir;
use std::fs;
use std::io::Write;
use std::path::Path;

/// What the checkpoints of [`lay_out`]'s run were saved under.
pub const SETTINGS: &str = "seed = 7\n";
/// The run that what travels belongs to.
pub const RUN_ID: u64 = 7;

/// An empty folder in memory: what is made durable there costs no time.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").expect("there is shared memory wherever islands run")
}

/// A small archipelago.
pub fn archipelago() -> Archipelago {
    Archipelago {
        islands: 2,
        seed: 7,
        topology: Topology::Ring,
        migration: Migration { interval: 1, migrants: 2, lag: 1, ..Migration::default() },
        strategy: Strategy {
            population: 3,
            elites: 1,
            selection: Selection::Tournament { size: 2 },
            variation: Variation {
                crossover_rate: 0.5,
                point_rate: 0.2,
                point_amount: 0.5,
                shrink_rate: 0.2,
                grow_rate: 0.2,
                genes_max: 3,
                ..Variation::default()
            },
            ..Strategy::default()
        },
    }
}

/// A problem that takes no time: the sum of all values.
pub struct Sum;

impl Problem for Sum {
    type Gene = Gene;

    fn random_gene(&self, rng: &mut Stream) -> Gene {
        Gene([(); PARAMETER_COUNT].map(|()| rand::RngExt::random(rng)))
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Gene> {
        vec![self.random_gene(rng), self.random_gene(rng)]
    }

    fn mutate_gene(&self, gene: &mut Gene, variation: &Variation, rng: &mut Stream) {
        gene.0[0] = if variation.point_rate > 0.0 { rand::RngExt::random(rng) } else { gene.0[0] };
    }

    fn distance(&self, a: &[Gene], b: &[Gene]) -> f64 {
        f64::from(u8::from(a != b))
    }

    fn evaluate(&self, genome: &[Gene]) -> Evaluation {
        Evaluation::scored(genome.iter().flat_map(|gene| gene.0).sum())
    }
}

/// A checkpoint file with this body, of this version.
pub fn checkpoint_file(version: u32, body: &[u8]) -> Vec<u8> {
    let length = (body.len() as u64).to_le_bytes();
    let file = [b"islands\n", &version.to_le_bytes()[..], &length, body].concat();
    [&file[..], &checksum(&file)].concat()
}

/// A checkpoint file with this body, whole as it seems.
pub fn sealed_checkpoint(body: &[u8]) -> Vec<u8> {
    checkpoint_file(1, body)
}

/// A log of one record with this body, whole as it seems.
pub fn sealed_record(body: &[u8]) -> Vec<u8> {
    [&(body.len() as u32).to_le_bytes()[..], body, &checksum(body)].concat()
}

/// A log of the records that the data is cut into.
pub fn sealed_records(data: &[u8]) -> Vec<u8> {
    parts(data).into_iter().flat_map(|(_, body)| sealed_record(body)).collect()
}

fn checksum(bytes: &[u8]) -> [u8; 8] {
    *blake3::hash(bytes).as_bytes().first_chunk().expect("a hash has 32 bytes")
}

/// Where a part of a run directory goes: the lower three bits say which file, the next whether as it is, the others which
/// checkpoint.
pub mod place {
    pub const CHAMPIONS: u8 = 0;
    pub const REPORTS: u8 = 1;
    pub const MIGRATIONS: u8 = 2;
    pub const LINEAGES: u8 = 3;
    pub const CHECKPOINT: u8 = 4;
    /// The part goes there as it is, without a checksum of its own.
    pub const RAW: u8 = 8;
    pub const GENERATION: u8 = 16;
}

/// A part of the data that [`lay_out`] puts in a place.
pub fn part(place: u8, body: &[u8]) -> Vec<u8> {
    let length = u16::try_from(body.len()).expect("parts are small");
    [&[place][..], &length.to_le_bytes(), body].concat()
}

/// Fills a run directory for island 0 with the parts that the data consists of.
pub fn lay_out(dir: &RunDir, data: &[u8]) {
    for (place, body) in parts(data) {
        let is_raw = place & place::RAW != 0;
        let generation = u32::from(place / place::GENERATION);
        let (path, sealed) = match place & 7 {
            place::CHAMPIONS => (dir.champions(0), sealed_record(body)),
            place::REPORTS => (dir.reports(0), sealed_record(body)),
            place::MIGRATIONS => (dir.migrations(0), sealed_record(body)),
            place::LINEAGES => (dir.lineages(0), sealed_record(body)),
            _ => (dir.checkpoint(0, generation), sealed_checkpoint(body)),
        };
        append(&path, if is_raw { body } else { &sealed });
    }
}

fn append(path: &Path, bytes: &[u8]) {
    let file = fs::OpenOptions::new().create(true).append(true).open(path);
    file.and_then(|mut file| file.write_all(bytes)).expect("the folder is ours");
}

/// Cuts data into parts, each with its place; whatever the data is, something comes out.
fn parts(data: &[u8]) -> Vec<(u8, &[u8])> {
    let mut parts = Vec::new();
    let mut rest = data;
    while let [place, low, high, more @ ..] = rest {
        let length = usize::from(u16::from_le_bytes([*low, *high])).min(more.len());
        parts.push((*place, &more[..length]));
        rest = &more[length..];
    }
    parts
}
