//! Files that are there whole or not at all.

use super::StoreError;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a file: to a temporary one in `scratch`, a folder of the same file system, made durable, then renamed;
/// so that neither a crash nor a full disk leaves half of it under its name, or anything else beside it.
///
/// # Errors
/// If the file system refuses; an older file of that name is then still whole.
pub fn write(
    scratch: &Path,
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    let failed = |source| StoreError::Io { action: "write", path: path.to_owned(), source };
    let mut file = tempfile::NamedTempFile::new_in(scratch).map_err(failed)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    fill(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    sync(file.as_file()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    sync_name(path)
}

/// Makes it durable that a file or a folder has its name. What was written to a file is of no use after a loss of power
/// if the file has none.
///
/// # Errors
/// If the file system refuses.
pub fn sync_name(path: &Path) -> Result<(), StoreError> {
    let folder = File::open(folder_of(path));
    folder.and_then(|folder| sync(&folder)).map_err(StoreError::io("make durable", path))
}

/// Waits until what was written to a file is on the disk with its length, or the names that a folder has. Nothing else in
/// this module does.
///
/// # Errors
/// If the file system refuses.
pub fn sync(file: &File) -> std::io::Result<()> {
    #[cfg(test)]
    super::watched_disk::before_sync(file);
    file.sync_data()
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_that_fails_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("file");
        let old = write(folder.path(), &path, |out| out.write_all(b"old"));
        old.expect("the folder is writable");
        let failure = write(folder.path(), &path, |out| {
            out.write_all(b"half")?;
            Err(std::io::Error::other("disk full"))
        });
        assert!(failure.is_err());
        assert_eq!(std::fs::read(&path).expect("it is there"), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).expect("it is there").count(), 1);
    }
}
