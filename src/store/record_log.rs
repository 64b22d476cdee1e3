//! A file that only grows: records in the order of their writing.
//!
//! A record is its length (u32), its bytes (bincode) and their checksum. A process that dies while it
//! appends leaves a torn tail, which readers leave out and the next writer cuts off.

use super::{BYTES_MAX, StoreError, checksum, decode, encode};
use serde::{Serialize, de::DeserializeOwned};
use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// A log of records of one type, open for appending.
#[derive(Debug)]
pub struct RecordLog<T> {
    path: PathBuf,
    file: File,
    records: PhantomData<fn(&T)>,
}

impl<T: Serialize + DeserializeOwned> RecordLog<T> {
    /// Opens the log at `path`, new or with the whole records that it has; a torn tail is cut off.
    ///
    /// # Errors
    /// If the file cannot be opened or read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let mut file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(path)
            .map_err(StoreError::io("open", path))?;
        let whole = scan(&std::fs::read(path).map_err(StoreError::io("read", path))?).end;
        file.set_len(whole as u64).map_err(StoreError::io("cut", path))?;
        file.seek(SeekFrom::End(0)).map_err(StoreError::io("read", path))?;
        Ok(Self { path: path.to_owned(), file, records: PhantomData })
    }

    /// Appends a record and makes it durable.
    ///
    /// # Errors
    /// If the disk is full or gone; the record may then be there in part, which readers leave out.
    pub fn append(&mut self, record: &T) -> Result<(), StoreError> {
        let body = encode(record);
        let mut bytes = Vec::with_capacity(body.len() + 12);
        bytes.extend((body.len() as u32).to_le_bytes());
        bytes.extend(&body);
        bytes.extend(checksum(&body));
        let write = self.file.write_all(&bytes).and_then(|()| self.file.sync_data());
        write.map_err(StoreError::io("append to", &self.path))
    }

    /// Reads every whole record of the log at `path`; one that does not exist has none.
    ///
    /// # Errors
    /// If the file cannot be read, or a record whose checksum is right is not one of this type.
    pub fn read(path: &Path) -> Result<Vec<T>, StoreError> {
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(source) => return Err(StoreError::io("read", path)(source)),
        };
        let bodies = scan(&bytes).bodies;
        let decode = |body: &[u8]| decode(body).map_err(|reason| StoreError::damaged(path, reason));
        bodies.into_iter().map(decode).collect()
    }
}

struct Scan<'a> {
    bodies: Vec<&'a [u8]>,
    /// Where the last whole record ends.
    end: usize,
}

fn scan(bytes: &[u8]) -> Scan<'_> {
    let mut scan = Scan { bodies: Vec::new(), end: 0 };
    while let Some((body, rest)) = record(&bytes[scan.end..]) {
        scan.bodies.push(body);
        scan.end = bytes.len() - rest.len();
    }
    scan
}

/// The first record of `bytes` and what follows it, if it is whole.
fn record(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    let length = u32::from_le_bytes(*length) as usize;
    let (body, rest) = rest.split_at_checked(length.min(BYTES_MAX))?;
    let (sum, rest) = rest.split_first_chunk()?;
    (checksum(body) == *sum).then_some((body, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_cut_anywhere_keeps_its_whole_records_and_goes_on() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log");
        let write = |records: &[String]| {
            let mut log = RecordLog::<String>::open(&path).expect("the folder is writable");
            records.iter().for_each(|r| log.append(r).expect("the disk has room"));
        };
        let read = || RecordLog::<String>::read(&path).expect("the log is readable");
        let records: Vec<String> = ["one", "two", "three"].map(str::to_owned).to_vec();
        write(&records);
        let whole = std::fs::read(&path).expect("it is there");
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).expect("it is writable");
            let kept = read();
            assert_eq!(kept, records[..kept.len()]);
            assert!(kept.len() < 3);
            write(&records[kept.len()..]);
            assert_eq!(read(), records);
        }
    }

    #[test]
    fn a_flipped_byte_is_noticed_wherever_it_is() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log");
        let mut log = RecordLog::<u64>::open(&path).expect("the folder is writable");
        log.append(&7_u64).expect("the disk has room");
        let whole = std::fs::read(&path).expect("it is there");
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 0x10;
            std::fs::write(&path, &flipped).expect("it is writable");
            let read = RecordLog::<u64>::read(&path).expect("it is readable");
            assert!(read.is_empty(), "byte {at}");
        }
    }
}
