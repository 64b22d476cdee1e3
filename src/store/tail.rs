//! Logs that are read while another process appends to them: from the beginning on, or by number.

use super::record_log::{body_at, record_bytes};
use super::{StoreError, decode, file};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::ErrorKind;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// Reads a log from its beginning while another process appends to it.
#[derive(Debug)]
pub struct Tail<T> {
    path: PathBuf,
    file: Option<File>,
    start: u64,
    records: PhantomData<fn() -> T>,
}

impl<T: DeserializeOwned> Tail<T> {
    /// A reader of the log at `path`, which need not exist yet.
    pub fn of(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), file: None, start: 0, records: PhantomData }
    }

    /// Where the log is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The next whole record, if it is there by now.
    ///
    /// # Errors
    /// If the file cannot be read, or the record is whole and not one of this type.
    pub fn next_record(&mut self) -> Result<Option<T>, StoreError> {
        let Some(body) = self.next_body()? else { return Ok(None) };
        decode(&body).map(Some).map_err(|reason| StoreError::damaged(&self.path, reason))
    }

    /// Leaves out the next `count` records, or as many as there are.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn skip(&mut self, count: usize) -> Result<(), StoreError> {
        for _ in 0..count {
            if self.next_body()?.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn next_body(&mut self) -> Result<Option<Vec<u8>>, StoreError> {
        if self.file.is_none() {
            self.file = match file::open_to_read(&self.path) {
                Ok(file) => Some(file),
                Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => None,
                Err(error) => return Err(error),
            };
        }
        let Some(file) = &self.file else { return Ok(None) };
        let body = body_at(file, self.start).map_err(StoreError::io("read", &self.path))?;
        self.start += body.as_ref().map_or(0, |body| record_bytes(body.len()) as u64);
        Ok(body)
    }
}

/// Reads records of a log by their number, while another process appends to it. Of each it remembers no more than where
/// it is.
#[derive(Debug)]
pub struct Index<T> {
    tail: Tail<T>,
    starts: Vec<u64>,
}

impl<T: DeserializeOwned> Index<T> {
    /// Of the log at `path`, which need not exist yet.
    pub fn of(path: impl Into<PathBuf>) -> Self {
        Self { tail: Tail::of(path), starts: Vec::new() }
    }

    /// The record number `index`, from 0, if it is there by now.
    ///
    /// # Errors
    /// If the file cannot be read, or the record is whole and not one of this type.
    pub fn get(&mut self, index: usize) -> Result<Option<T>, StoreError> {
        while self.starts.len() <= index {
            let start = self.tail.start;
            if self.tail.next_body()?.is_none() {
                return Ok(None);
            }
            self.starts.push(start);
        }
        let Tail { path, file, .. } = &self.tail;
        let Some(file) = file else { return Ok(None) };
        let body = body_at(file, self.starts[index]).map_err(StoreError::io("read", path))?;
        let decoded = body.map(|body| decode(&body)).transpose();
        decoded.map_err(|reason| StoreError::damaged(path, reason))
    }
}

#[cfg(test)]
mod tests {
    use super::super::RecordLog;
    use super::*;

    #[test]
    fn a_tail_follows_a_log_that_comes_late_and_is_cut_and_written_again() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log");
        let mut tail = Tail::<String>::of(&path);
        let mut next = || tail.next_record().expect("it is readable");
        assert_eq!(next(), None);
        let mut log = RecordLog::<String>::open(&path).expect("the folder is writable");
        for record in ["one", "two"] {
            log.append(&record.to_owned()).expect("the disk has room");
        }
        assert_eq!([next(), next(), next()], [Some("one".into()), Some("two".into()), None]);
        log.truncate(1).expect("it is writable");
        assert_eq!(next(), None);
        for record in ["two", "three"] {
            log.append(&record.to_owned()).expect("the disk has room");
        }
        assert_eq!([next(), next()], [Some("three".into()), None]);
    }

    #[test]
    fn records_are_found_by_their_number_as_soon_as_they_are_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log");
        let mut index = Index::<String>::of(&path);
        assert_eq!(index.get(0).expect("there is no file"), None);
        let mut log = RecordLog::<String>::open(&path).expect("the folder is writable");
        for record in ["one", "two", "three"] {
            log.append(&record.to_owned()).expect("the disk has room");
        }
        let mut at = |number| index.get(number).expect("the log is whole");
        assert_eq!([2, 0, 1].map(&mut at), ["three", "one", "two"].map(|it| Some(it.to_owned())));
        assert_eq!(at(3), None);
        log.append(&"four".to_owned()).expect("the disk has room");
        assert_eq!(at(3).as_deref(), Some("four"));
        std::fs::write(&path, "").expect("it is writable");
        assert_eq!(at(1), None, "what was cut back is not there");
    }
}
