//! A file that only grows: records in the order of their writing.
//!
//! A record is its length (u32), its bytes (bincode) and their checksum. A process that dies while it
//! appends leaves a torn tail, which readers leave out and the next writer overwrites. What is cut back and
//! written again the same way has the same bytes in the same places, so that a reader need not know of it.

use super::{BYTES_MAX, StoreError, atomic, checksum, decode, encode, file};
use serde::{Serialize, de::DeserializeOwned};
use std::fs::File;
use std::io::ErrorKind;
use std::marker::PhantomData;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

const LENGTH_BYTES: usize = 4;
const CHECKSUM_BYTES: usize = 8;

/// A log of records of one type, open for appending.
#[derive(Debug)]
pub struct RecordLog<T> {
    path: PathBuf,
    file: File,
    /// Where each whole record ends.
    ends: Vec<u64>,
    records: PhantomData<fn(&T)>,
}

impl<T: Serialize + DeserializeOwned> RecordLog<T> {
    /// Opens the log at `path`, new or with the whole records that it has; a torn tail is cut off. It waits
    /// until nobody else has it open like this: a process that was killed may live on for a moment, and two
    /// may not write at once.
    ///
    /// # Errors
    /// If the file cannot be opened, locked or read, or is no regular file.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let file = file::open_to_write(path)?;
        // Also that of a file which is there: who made it may have been killed before it did this.
        atomic::sync_name(path)?;
        file.lock().map_err(StoreError::io("lock", path))?;
        let ends = scan(&file, |_| ()).map_err(StoreError::io("read", path))?.ends;
        let mut log = Self { path: path.to_owned(), file, ends, records: PhantomData };
        log.truncate(log.ends.len())?;
        Ok(log)
    }

    /// The number of records.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Appends a record and makes it durable.
    ///
    /// # Errors
    /// If the disk is full or gone; the record may then be there in part, which counts as nothing.
    pub fn append(&mut self, record: &T) -> Result<(), StoreError> {
        let body = encode(record);
        let mut bytes = Vec::with_capacity(record_bytes(body.len()));
        bytes.extend((body.len() as u32).to_le_bytes());
        bytes.extend(&body);
        bytes.extend(checksum(&body));
        let end = self.end();
        let write = self.file.write_all_at(&bytes, end).and_then(|()| atomic::sync(&self.file));
        write.map_err(StoreError::io("append to", &self.path))?;
        self.ends.push(end + bytes.len() as u64);
        Ok(())
    }

    /// The record number `index`, from 0, if there is one.
    ///
    /// # Errors
    /// If it cannot be read, is not one of this type, or was damaged while the log was open.
    pub fn get(&self, index: usize) -> Result<Option<T>, StoreError> {
        let start = index.checked_sub(1).map_or(Some(0), |before| self.ends.get(before).copied());
        let (Some(start), Some(_)) = (start, self.ends.get(index)) else { return Ok(None) };
        let body = body_at(&self.file, start).map_err(StoreError::io("read", &self.path))?;
        let body = body.ok_or_else(|| self.damaged(format!("record {index} is not whole")))?;
        decode(&body).map(Some).map_err(|reason| self.damaged(reason))
    }

    /// The last record for which `belongs` holds, and its number; those after it are read to find it.
    ///
    /// # Errors
    /// If one cannot be read, or is not of this type.
    pub fn last_that(
        &self,
        belongs: impl Fn(&T) -> bool,
    ) -> Result<Option<(usize, T)>, StoreError> {
        for index in (0..self.len()).rev() {
            if let Some(record) = self.get(index)?.filter(&belongs) {
                return Ok(Some((index, record)));
            }
        }
        Ok(None)
    }

    /// Cuts off all records but the first `count`.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn truncate(&mut self, count: usize) -> Result<(), StoreError> {
        self.ends.truncate(count);
        let end = self.end();
        let length = self.file.metadata().map(|status| status.len());
        let cut = length.and_then(|length| match length == end {
            true => Ok(()),
            false => self.file.set_len(end).and_then(|()| atomic::sync(&self.file)),
        });
        cut.map_err(StoreError::io("cut", &self.path))
    }

    /// Reads the log at `path`; one that does not exist has no record.
    ///
    /// # Errors
    /// If the file cannot be read, or a record whose checksum is right is not one of this type.
    pub fn read(path: &Path) -> Result<Contents<T>, StoreError> {
        let file = match file::open_to_read(path) {
            Ok(file) => file,
            Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                return Ok(Contents { records: Vec::new(), torn_bytes: 0 });
            }
            Err(error) => return Err(error),
        };
        let mut records = Ok(Vec::new());
        let scan = scan(&file, |body| {
            if let Ok(found) = &mut records {
                match decode(body) {
                    Ok(record) => found.push(record),
                    Err(reason) => records = Err(reason),
                }
            }
        });
        let scan = scan.map_err(StoreError::io("read", path))?;
        let records = records.map_err(|reason| StoreError::damaged(path, reason))?;
        Ok(Contents { records, torn_bytes: scan.torn_bytes })
    }

    fn end(&self) -> u64 {
        self.ends.last().copied().unwrap_or(0)
    }

    fn damaged(&self, reason: impl Into<String>) -> StoreError {
        StoreError::damaged(&self.path, reason)
    }
}

/// What a log holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents<T> {
    /// Its whole records.
    pub records: Vec<T>,
    /// What follows them and is none, in bytes: a record that was being written when its process died, or
    /// a damaged one and all that follow it.
    pub torn_bytes: u64,
}

/// The body of the record at `start`, if there is a whole one.
pub(super) fn body_at(file: &File, start: u64) -> std::io::Result<Option<Vec<u8>>> {
    let left = file.metadata()?.len().saturating_sub(start);
    let mut length = [0; LENGTH_BYTES];
    if left < length.len() as u64 || !is_read(file.read_exact_at(&mut length, start))? {
        return Ok(None);
    }
    let length = u32::from_le_bytes(length) as usize;
    // No memory is asked for on the word of a file that does not have so much.
    if length > BYTES_MAX || left < record_bytes(length) as u64 {
        return Ok(None);
    }
    let mut bytes = vec![0; length + CHECKSUM_BYTES];
    if !is_read(file.read_exact_at(&mut bytes, start + LENGTH_BYTES as u64))? {
        return Ok(None);
    }
    let sum = bytes.split_off(length);
    Ok((checksum(&bytes)[..] == sum).then_some(bytes))
}

/// Whether reading came to an end that it should; a file may be cut while it is read.
fn is_read(result: std::io::Result<()>) -> std::io::Result<bool> {
    match result {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        other => other.map(|()| true),
    }
}

struct Scan {
    /// Where each whole record ends.
    ends: Vec<u64>,
    /// What follows the last one.
    torn_bytes: u64,
}

/// Reads a log from its beginning, and shows the body of each whole record.
fn scan(file: &File, mut see: impl FnMut(&[u8])) -> std::io::Result<Scan> {
    let mut scan = Scan { ends: Vec::new(), torn_bytes: 0 };
    let mut end = 0;
    while let Some(body) = body_at(file, end)? {
        see(&body);
        end += record_bytes(body.len()) as u64;
        scan.ends.push(end);
    }
    scan.torn_bytes = file.metadata()?.len().saturating_sub(end);
    Ok(scan)
}

/// The length of a record whose body is so long.
pub(super) fn record_bytes(body: usize) -> usize {
    LENGTH_BYTES + body + CHECKSUM_BYTES
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder")
    }

    fn write(path: &Path, records: &[&str]) {
        let mut log = RecordLog::<String>::open(path).expect("the folder is writable");
        records.iter().for_each(|r| log.append(&(*r).to_owned()).expect("the disk has room"));
    }

    fn read(path: &Path) -> Vec<String> {
        RecordLog::<String>::read(path).expect("the log is readable").records
    }

    #[test]
    fn a_log_cut_anywhere_keeps_its_whole_records_and_goes_on() {
        let folder = folder();
        let path = folder.path().join("log");
        let records = ["one", "two", "three"];
        write(&path, &records);
        let whole = std::fs::read(&path).expect("it is there");
        for cut in 0..whole.len() {
            std::fs::write(&path, &whole[..cut]).expect("it is writable");
            let kept = read(&path);
            assert_eq!(kept, records[..kept.len()]);
            assert!(kept.len() < 3);
            write(&path, &records[kept.len()..]);
            assert_eq!(read(&path), records);
        }
    }

    #[test]
    fn a_flipped_byte_is_noticed_wherever_it_is_and_what_follows_does_not_count() {
        let folder = folder();
        let path = folder.path().join("log");
        write(&path, &["one", "two"]);
        let whole = std::fs::read(&path).expect("it is there");
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 0x10;
            std::fs::write(&path, &flipped).expect("it is writable");
            let contents = RecordLog::<String>::read(&path).expect("it is readable");
            let intact = usize::from(at >= whole.len() / 2);
            assert_eq!(contents.records, ["one"][..intact], "byte {at}");
            assert_eq!(contents.torn_bytes as usize, whole.len() / (1 + intact), "byte {at}");
        }
    }

    #[test]
    fn records_are_found_by_number_and_cut_back_to_one() {
        let folder = folder();
        let path = folder.path().join("log");
        write(&path, &["one", "two", "three"]);
        let mut log = RecordLog::<String>::open(&path).expect("it is there");
        let get = |log: &RecordLog<String>, index| log.get(index).expect("it is readable");
        assert_eq!(get(&log, 1).as_deref(), Some("two"));
        assert_eq!(get(&log, 3), None);
        let found = log.last_that(|record| record.len() == 3).expect("it is readable");
        assert_eq!(found, Some((1, "two".to_owned())));
        log.truncate(1).expect("it is writable");
        log.append(&"four".to_owned()).expect("the disk has room");
        assert_eq!((log.len(), read(&path)), (2, vec!["one".to_owned(), "four".to_owned()]));
    }

    #[test]
    fn a_record_that_was_damaged_while_the_log_was_open_is_an_error_and_not_a_gap() {
        let folder = folder();
        let path = folder.path().join("log");
        write(&path, &["one", "two"]);
        let log = RecordLog::<String>::open(&path).expect("it is there");
        let whole = std::fs::read(&path).expect("it is there");
        for harmed in [&whole[..whole.len() - 1], &[&whole[..whole.len() - 1], &[0]].concat()] {
            std::fs::write(&path, harmed).expect("it is writable");
            assert_eq!(log.get(0).expect("it is whole").as_deref(), Some("one"));
            let error = log.get(1).expect_err("it is damaged").to_string();
            assert!(error.ends_with("log is damaged: record 1 is not whole"), "{error}");
        }
    }

    #[test]
    fn a_length_that_the_file_does_not_have_asks_for_no_memory() {
        let folder = folder();
        let path = folder.path().join("log");
        std::fs::write(&path, [0xff; 40]).expect("it is writable");
        let contents = RecordLog::<String>::read(&path).expect("it is readable");
        assert_eq!(contents, Contents { records: vec![], torn_bytes: 40 });
    }
}
