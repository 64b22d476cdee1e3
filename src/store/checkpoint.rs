//! An island's whole state in a file.
//!
//! Layout: the magic bytes, the format version (u32), the length of the body (u64), the body (bincode), and
//! a checksum over all before it. Integers are little-endian.

use super::{BYTES_MAX, StoreError, atomic, checksum, decode, encode, file};
use crate::archipelago::Island;
use crate::evolution::Gene;
use serde::{Deserialize, Deserializer, Serialize};
use std::path::Path;

const MAGIC: [u8; 8] = *b"islands\n";
const VERSION: u32 = 1;

/// What is saved of an island.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "G: Gene")]
pub struct Checkpoint<G> {
    /// The settings that it evolves under, as TOML: a state is of use only under the same ones.
    #[serde(deserialize_with = "text")]
    pub settings: String,
    /// Its state between two generations.
    pub island: Island<G>,
}

/// Saves an island, durably and whole or not at all. `scratch` is a folder of the same file system.
///
/// # Errors
/// If the disk is full or gone.
pub fn save<G: Gene>(
    scratch: &Path,
    path: &Path,
    checkpoint: &Checkpoint<G>,
) -> Result<(), StoreError> {
    let bytes = to_bytes(checkpoint);
    atomic::write(scratch, path, |out| out.write_all(&bytes))
}

/// Loads what [`save`] wrote.
///
/// # Errors
/// If the file cannot be read, is of an unknown version, or is not to the last bit what was saved.
pub fn load<G: Gene>(path: &Path) -> Result<Checkpoint<G>, StoreError> {
    from_bytes(&file::read(path, BYTES_MAX)?, path)
}

/// A text, looked at where it lies before it is copied: bincode would ask for the memory of a String on the word
/// of the file alone.
fn text<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    <&str>::deserialize(from).map(str::to_owned)
}

/// What [`save`] writes.
pub fn to_bytes<G: Gene>(checkpoint: &Checkpoint<G>) -> Vec<u8> {
    let body = encode(checkpoint);
    let mut bytes = Vec::with_capacity(body.len() + 28);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(&body);
    bytes.extend(checksum(&bytes));
    bytes
}

/// What [`load`] reads from bytes that are said to be the file at `path`.
///
/// # Errors
/// If they are of an unknown version, or not to the last bit what was saved.
pub fn from_bytes<G: Gene>(bytes: &[u8], path: &Path) -> Result<Checkpoint<G>, StoreError> {
    let damaged = |reason: &str| StoreError::damaged(path, reason);
    let rest = bytes.strip_prefix(&MAGIC).ok_or_else(|| damaged("it is no checkpoint"))?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(|| damaged("it is cut off"))?;
    let (length, rest) = rest.split_first_chunk().ok_or_else(|| damaged("it is cut off"))?;
    let found = u32::from_le_bytes(*version);
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(BYTES_MAX);
    let (body, sum) = rest.split_at_checked(length).ok_or_else(|| damaged("it is cut off"))?;
    // Of every version the checksum is in the same place: a flipped bit of the version is damage, not another
    // version.
    if sum != checksum(&bytes[..bytes.len() - sum.len()]) {
        return Err(damaged("its checksum is wrong"));
    }
    if found != VERSION {
        return Err(StoreError::Version { path: path.to_owned(), found, known: VERSION });
    }
    decode(body).map_err(|reason| StoreError::damaged(path, reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::Gene;
    use crate::evolution::cma::Cma;
    use crate::evolution::generation::Effort;
    use crate::evolution::{Fitness, Id, Individual, Learned, Memory};

    fn checkpoint() -> Checkpoint<Gene> {
        let individual = Individual {
            id: Id { island: 1, generation: 2, index: 3 },
            parents: [Some(Id { island: 0, generation: 1, index: 9 }), None],
            origin: 0,
            genome: vec![Gene([0.25; 17]); 2],
            fitness: Fitness::new(1.5),
        };
        let failed = Individual { fitness: Fitness::WORST, ..individual.clone() };
        let learned = Learned::Cma(Box::new(Cma::about(vec![0.25, 0.5])));
        let island = Island {
            index: 1,
            generation: 2,
            population: vec![individual.clone(), failed],
            champion: individual,
            effort: Effort::default(),
            memory: Memory { amount_scale: 0.5, learned },
        };
        Checkpoint { settings: "seed = 7\n".to_owned(), island }
    }

    #[test]
    fn a_checkpoint_comes_back_bit_for_bit_and_notices_every_flipped_or_missing_byte() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("2.ckpt");
        save(folder.path(), &path, &checkpoint()).expect("the folder is writable");
        assert_eq!(load::<Gene>(&path).expect("it is whole"), checkpoint());
        let whole = std::fs::read(&path).expect("it is there");
        let is_damaged = |bytes: &[u8]| {
            matches!(from_bytes::<Gene>(bytes, &path), Err(StoreError::Damaged { .. }))
        };
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 0x40;
            assert!(is_damaged(&flipped), "byte {at} flipped");
            assert!(is_damaged(&whole[..at]), "cut at {at}");
        }
        assert!(is_damaged(&[&whole[..], &[0]].concat()), "a byte too many");
    }

    #[test]
    fn another_format_version_is_named() {
        let mut bytes = to_bytes(&checkpoint());
        let sum = bytes.len() - 8;
        bytes[8..12].copy_from_slice(&9_u32.to_le_bytes());
        let right = checksum(&bytes[..sum]);
        bytes[sum..].copy_from_slice(&right);
        let error = from_bytes::<Gene>(&bytes, Path::new("2.ckpt")).expect_err("it is of another");
        let said = "2.ckpt has format version 9, and this program reads version 1";
        assert_eq!(error.to_string(), said);
    }
}
