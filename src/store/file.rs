//! Opening files that anybody may have put there.
//!
//! A run directory can come from anywhere: what is read is bounded, a pipe is not waited for, and nothing is
//! written through a link.

use super::StoreError;
use rustix::fs::OFlags;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

/// Reads a whole file of at most so many bytes.
///
/// # Errors
/// If it cannot be read, is no regular file or is larger.
pub fn read(path: &Path, bytes_max: usize) -> Result<Vec<u8>, StoreError> {
    let too_large = || StoreError::damaged(path, format!("it is larger than {bytes_max} bytes"));
    let file = open_to_read(path)?;
    let length = file.metadata().map_err(StoreError::io("read", path))?.len();
    let length = usize::try_from(length).ok().filter(|&length| length <= bytes_max);
    let mut bytes = Vec::with_capacity(length.ok_or_else(too_large)?);
    // One byte more than may be there, lest a file that grows meanwhile seems to be whole.
    file.take(bytes_max as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(StoreError::io("read", path))?;
    if bytes.len() > bytes_max {
        return Err(too_large());
    }
    Ok(bytes)
}

/// The same as text.
///
/// # Errors
/// Also if it is not UTF-8.
pub fn read_text(path: &Path, bytes_max: usize) -> Result<String, StoreError> {
    String::from_utf8(read(path, bytes_max)?)
        .map_err(|_| StoreError::damaged(path, "it is not text"))
}

/// Opens a file to read it.
///
/// # Errors
/// If there is none, or it is no regular file.
pub fn open_to_read(path: &Path) -> Result<File, StoreError> {
    let mut options = OpenOptions::new();
    // Otherwise opening a pipe would wait for its other end.
    options.read(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed());
    let file = options.open(path).map_err(StoreError::io("read", path))?;
    regular(file, path)
}

/// Opens a file to read and write it, for this user only; it is made if there is none.
///
/// # Errors
/// If it cannot be opened, or is a link or anything else that is no regular file.
pub fn open_to_write(path: &Path) -> Result<File, StoreError> {
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).read(true).write(true).mode(0o600);
    options.custom_flags((OFlags::NONBLOCK | OFlags::NOFOLLOW).bits().cast_signed());
    let file = options.open(path).map_err(StoreError::io("open", path))?;
    regular(file, path)
}

/// Opens a file to go on writing at its end; otherwise like [`open_to_write`].
///
/// # Errors
/// The same.
pub fn open_to_append(path: &Path) -> Result<File, StoreError> {
    let mut file = open_to_write(path)?;
    file.seek(SeekFrom::End(0)).map_err(StoreError::io("open", path))?;
    Ok(file)
}

/// Opens a folder.
///
/// # Errors
/// If there is none, or it is something else.
pub fn open_folder(path: &Path) -> Result<File, StoreError> {
    let mut options = OpenOptions::new();
    options.read(true).custom_flags(OFlags::DIRECTORY.bits().cast_signed());
    options.open(path).map_err(StoreError::io("open", path))
}

fn regular(file: File, path: &Path) -> Result<File, StoreError> {
    let status = file.metadata().map_err(StoreError::io("read", path))?;
    if status.is_file() {
        Ok(file)
    } else {
        Err(StoreError::damaged(path, "it is no regular file"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_regular_file_is_neither_waited_for_nor_followed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("outside"), "precious").expect("it is writable");
        std::os::unix::fs::symlink(at("outside"), at("link")).expect("links can be made");
        rustix::fs::mkfifoat(rustix::fs::CWD, at("pipe"), rustix::fs::Mode::RWXU)
            .expect("pipes can be made");
        assert!(open_to_write(&at("link")).is_err());
        for name in ["pipe", "."] {
            assert!(open_to_read(&at(name)).is_err(), "{name}");
            assert!(open_to_write(&at(name)).is_err(), "{name}");
        }
        for name in ["pipe", "outside"] {
            assert!(open_folder(&at(name)).is_err(), "{name}");
        }
        assert!(read(Path::new("/dev/zero"), 8).is_err());
        assert_eq!(read_text(&at("outside"), 8).expect("it is text"), "precious");
        assert!(read_text(&at("outside"), 7).is_err());
    }
}
