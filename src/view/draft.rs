//! A recording takes its place when it has something to show, and not before.

use super::ViewError;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Result};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// A file that is being made for a path, where an older one may still lie. Dropped before it was published,
/// it is removed.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    /// Where it is made.
    workshop: PathBuf,
    /// The same; none once it is in its place.
    partial: Option<TempPath>,
    file: File,
}

impl Draft {
    /// A draft of the file `path` in `folder`, which lies in the same file system. Only one process at a time
    /// may make it there: what an earlier one left is removed.
    ///
    /// # Errors
    /// If it cannot be made, or what is at `path` is no file and must not be replaced.
    pub fn within(folder: &Path, path: &Path) -> std::result::Result<Self, ViewError> {
        Self::of(path, |name| folder.join(format!("{name}.partial")))
    }

    /// A draft of the file `path` beside it, which nobody else has.
    ///
    /// # Errors
    /// If it cannot be made, or what is at `path` is no file and must not be replaced.
    pub fn beside(path: &Path) -> std::result::Result<Self, ViewError> {
        Self::of(path, |name| path.with_file_name(format!(".{name}.{}", std::process::id())))
    }

    fn of(
        path: &Path,
        partial: impl FnOnce(&str) -> PathBuf,
    ) -> std::result::Result<Self, ViewError> {
        let failed = |source| ViewError::Create { path: path.to_owned(), source };
        let name = path.file_name().ok_or_else(|| failed(Error::other("it names no file")))?;
        let workshop = partial(&name.to_string_lossy());
        let made = check_replaceable(path).and_then(|()| make(&workshop));
        let (file, partial) = made.map_err(failed)?;
        Ok(Self { path: path.to_owned(), workshop, partial: Some(partial), file })
    }

    /// Another draft for the same path, which is made beside this one.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn anew(&self) -> std::result::Result<Self, ViewError> {
        let mut name = self.workshop.file_name().unwrap_or_default().to_owned();
        name.push(".anew");
        Self::of(&self.path, |_| self.workshop.with_file_name(name))
    }

    /// Where the file is by now.
    pub fn place(&self) -> &Path {
        self.partial.as_deref().unwrap_or(&self.path)
    }

    /// The file that it is for.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file, open for writing, wherever it is put.
    ///
    /// # Errors
    /// If the process has too many files open.
    pub fn file(&self) -> std::result::Result<File, ViewError> {
        self.file.try_clone().map_err(|source| self.failed(source))
    }

    /// Puts it in its place, at once and durably, if it is not there. Whoever has it open writes on in it.
    ///
    /// # Errors
    /// If the file system refuses; what was in its place is still there.
    pub fn publish(&mut self) -> std::result::Result<(), ViewError> {
        let Some(partial) = self.partial.take() else { return Ok(()) };
        self.file.sync_all().map_err(|source| self.failed(source))?;
        partial.persist(&self.path).map_err(|error| self.failed(error.error))?;
        let synced = File::open(folder_of(&self.path)).and_then(|folder| folder.sync_all());
        synced.map_err(|source| self.failed(source))
    }

    pub(super) fn failed(&self, source: Error) -> ViewError {
        ViewError::Create { path: self.path.clone(), source }
    }
}

/// The name of a device or a pipe would be lost to a file.
fn check_replaceable(path: &Path) -> Result<()> {
    match std::fs::metadata(path) {
        Ok(status) if !status.is_file() => Err(Error::other("there is something that is no file")),
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Makes an empty file for its owner alone. What lies there is never written to: it may be a link that leads
/// elsewhere.
fn make(path: &Path) -> Result<(File, TempPath)> {
    if std::fs::symlink_metadata(path).is_ok_and(|old| old.is_file() || old.is_symlink()) {
        std::fs::remove_file(path)?;
    }
    let file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(path)?;
    Ok((file, TempPath::try_from_path(path)?))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::os::unix::fs::{MetadataExt, symlink};

    #[test]
    fn a_draft_never_writes_through_what_lies_in_its_way_and_is_its_owners_alone() {
        let folder = tempfile::tempdir().unwrap();
        let [path, secret] = ["run.rrd", "secret"].map(|name| folder.path().join(name));
        std::fs::write(&secret, "as it was").unwrap();
        symlink(&secret, folder.path().join("run.rrd.partial")).unwrap();
        let mut draft = Draft::within(folder.path(), &path).unwrap();
        let status = draft.file().unwrap().metadata().unwrap();
        assert_eq!((status.mode() & 0o777, status.len()), (0o600, 0));
        draft.file().unwrap().write_all(b"new").unwrap();
        symlink(&secret, &path).unwrap();
        draft.publish().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert!(std::fs::symlink_metadata(&path).unwrap().is_file());
        assert_eq!(std::fs::read(&secret).unwrap(), b"as it was");
    }

    #[test]
    fn what_is_no_file_is_neither_replaced_nor_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.rrd");
        symlink("/dev/null", &path).unwrap();
        for path in [&path, Path::new("/dev/null"), folder.path(), Path::new("/")] {
            for draft in [Draft::beside(path), Draft::within(folder.path(), path)] {
                let error = draft.map(|_| ()).unwrap_err().to_string();
                assert!(error.contains(path.to_str().unwrap()), "{error}");
            }
        }
        assert!(Draft::beside(Path::new("/nowhere/run.rrd")).is_err());
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir(folder.path().join("run.rrd.partial")).unwrap();
        assert!(Draft::within(folder.path(), &path).is_err());
    }

    #[test]
    fn a_draft_that_is_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        drop(Draft::beside(&folder.path().join("run.rrd")).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
