//! An island's whole state in a file.
//!
//! Layout: the magic bytes, the format version (u32), the length of the body (u64), the body (bincode), and
//! a checksum over all before it. Integers are little-endian.

use super::{BYTES_MAX, StoreError, atomic, checksum, decode, encode};
use crate::archipelago::Island;
use crate::evolution::Gene;
use std::path::Path;

const MAGIC: [u8; 8] = *b"islands\n";
const VERSION: u32 = 1;

/// Saves an island, durably and whole or not at all.
///
/// # Errors
/// If the disk is full or gone.
pub fn save<G: Gene>(path: &Path, island: &Island<G>) -> Result<(), StoreError> {
    let body = encode(island);
    let mut bytes = Vec::with_capacity(body.len() + 28);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(&body);
    bytes.extend(checksum(&bytes));
    atomic::write(path, |out| out.write_all(&bytes))
}

/// Loads what [`save`] wrote.
///
/// # Errors
/// If the file cannot be read, is of an unknown version, or is not to the last bit what was saved.
pub fn load<G: Gene>(path: &Path) -> Result<Island<G>, StoreError> {
    let bytes = std::fs::read(path).map_err(StoreError::io("read", path))?;
    let damaged = |reason: &str| StoreError::damaged(path, reason);
    let rest = bytes.strip_prefix(&MAGIC).ok_or_else(|| damaged("it is no checkpoint"))?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(|| damaged("it is cut off"))?;
    let found = u32::from_le_bytes(*version);
    if found != VERSION {
        return Err(StoreError::Version { path: path.to_owned(), found, known: VERSION });
    }
    let (length, rest) = rest.split_first_chunk().ok_or_else(|| damaged("it is cut off"))?;
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(BYTES_MAX);
    let (body, sum) = rest.split_at_checked(length).ok_or_else(|| damaged("it is cut off"))?;
    if sum != checksum(&bytes[..bytes.len() - sum.len()]) {
        return Err(damaged("its checksum is wrong"));
    }
    decode(body).map_err(|reason| StoreError::damaged(path, reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::Gene;
    use crate::evolution::generation::Effort;
    use crate::evolution::{Fitness, Id, Individual};

    fn island() -> Island<Gene> {
        let individual = Individual {
            id: Id { island: 1, generation: 2, index: 3 },
            parents: [Some(Id { island: 0, generation: 1, index: 9 }), None],
            genome: vec![Gene([0.25; 17]); 2],
            fitness: Fitness::new(1.5),
        };
        let failed = Individual { fitness: Fitness::WORST, ..individual.clone() };
        Island {
            index: 1,
            generation: 2,
            population: vec![individual.clone(), failed],
            champion: individual,
            effort: Effort::default(),
        }
    }

    #[test]
    fn a_checkpoint_comes_back_bit_for_bit_and_notices_every_flipped_or_missing_byte() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("2.ckpt");
        save(&path, &island()).expect("the folder is writable");
        assert_eq!(load::<Gene>(&path).expect("it is whole"), island());
        let whole = std::fs::read(&path).expect("it is there");
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 0x40;
            std::fs::write(&path, &flipped).expect("it is writable");
            assert!(load::<Gene>(&path).is_err(), "byte {at} flipped");
            std::fs::write(&path, &whole[..at]).expect("it is writable");
            assert!(load::<Gene>(&path).is_err(), "cut at {at}");
        }
    }
}
