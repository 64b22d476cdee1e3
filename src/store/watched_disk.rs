//! A disk that remembers what was made durable, and what a loss of power may leave of the rest.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A folder as a loss of power left it.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub struct Remains {
    /// The contents of each file, by its path within; none for a folder.
    pub files: BTreeMap<PathBuf, Option<Vec<u8>>>,
    /// What had been promised to be on the disk: the newest generation of each island.
    pub promised: BTreeMap<u32, u32>,
}

thread_local! {
    static WATCHED: RefCell<Option<Disk>> = const { RefCell::new(None) };
}

/// Of a folder, as the thread that watches it changes it: what is durable, and what power may have left at any moment so
/// far. A file system promises nothing of what nobody waited for: names and contents may be new or old, whichever came
/// first (Pillai et al. 2014, "All file systems are not created equal").
pub struct Disk {
    root: PathBuf,
    /// Every file that there ever was, held open, so that no other gets its number.
    files: BTreeMap<u64, File>,
    /// What each file surely holds.
    contents: Contents,
    /// Which file surely has which name.
    names: Names,
    promised: BTreeMap<u32, u32>,
    remains: BTreeSet<Remains>,
}

type Names = BTreeMap<PathBuf, Inode>;
type Contents = BTreeMap<u64, Vec<u8>>;

#[derive(Clone, Copy, PartialEq)]
enum Inode {
    Folder,
    File(u64),
}

impl Disk {
    /// Watches what this thread does in an empty folder until [`Disk::take`].
    pub fn watch(root: &Path) {
        let root = root.canonicalize().expect("it is there");
        WATCHED.set(Some(Self {
            root,
            files: BTreeMap::new(),
            contents: BTreeMap::new(),
            names: BTreeMap::new(),
            promised: BTreeMap::new(),
            remains: BTreeSet::new(),
        }));
    }

    /// From now on a generation of an island may not be lost, if anybody watches.
    pub fn promise(island: u32, generation: u32) {
        WATCHED.with_borrow_mut(|disk| {
            disk.iter_mut().for_each(|disk| {
                disk.promised.insert(island, generation);
            });
        });
    }

    /// All that the watched folder may be after a loss of power at any moment so far.
    pub fn take() -> BTreeSet<Remains> {
        let mut disk = WATCHED.take().expect("it was watched");
        let (names, contents) = disk.now();
        disk.lose(&names, &contents);
        disk.remains
    }

    /// What is not durable yet may be lost now, as a whole or in part; after that, what `file` holds is durable.
    fn before_sync(&mut self, file: &File) {
        let (names, contents) = self.now();
        self.lose(&names, &contents);
        let status = file.metadata().expect("it is open");
        if status.is_dir() {
            self.sync_names(status.ino(), names);
        } else if let Some(content) = contents.get(&status.ino()) {
            self.contents.insert(status.ino(), content.clone());
        }
    }

    /// Remembers what a loss of power may leave where a program sees these names and contents.
    fn lose(&mut self, names: &Names, contents: &Contents) {
        let torn = self.mixed(contents, |old, new| [old, &new[..new.len() / 2]].concat());
        let zeroed = self.mixed(contents, |old, new| [old, &vec![0; new.len()][..]].concat());
        for names in mixtures(&self.names, names) {
            for contents in mixtures(&self.contents, contents).iter().chain([&torn, &zeroed]) {
                let files = files(&names, contents);
                self.remains.insert(Remains { files, promised: self.promised.clone() });
            }
        }
    }

    /// What a program sees.
    fn now(&mut self) -> (Names, Contents) {
        let (mut names, mut contents) = (BTreeMap::new(), BTreeMap::new());
        for path in all_within(&self.root) {
            let file = File::open(&path).expect("it is there");
            let status = file.metadata().expect("it is open");
            let inode = match status.is_dir() {
                true => Inode::Folder,
                false => Inode::File(status.ino()),
            };
            if let Inode::File(number) = inode {
                contents.insert(number, std::fs::read(&path).expect("it is readable"));
                self.files.entry(number).or_insert(file);
            }
            names.insert(path.strip_prefix(&self.root).expect("it is within").to_owned(), inode);
        }
        (names, contents)
    }

    /// What files hold whose new ends came to the disk as `end` makes them of the durable beginning and the rest.
    fn mixed(&self, now: &Contents, end: impl Fn(&[u8], &[u8]) -> Vec<u8>) -> Contents {
        let mut mixed = self.contents.clone();
        for (&number, new) in now {
            let old = mixed.entry(number).or_default();
            let same = old.iter().zip(new).take_while(|(old, new)| old == new).count();
            *old = end(&new[..same], &new[same..]);
        }
        mixed
    }

    /// The names in a folder are durable now.
    fn sync_names(&mut self, folder: u64, now: Names) {
        let is_in = |path: &PathBuf| {
            let parent = self.root.join(path.parent().unwrap_or(Path::new("")));
            std::fs::metadata(parent).is_ok_and(|status| status.ino() == folder)
        };
        self.names.retain(|path, _| !is_in(path));
        self.names.extend(now.into_iter().filter(|(path, _)| is_in(path)));
    }
}

/// Tells the disk that is watched, if there is one, what is about to be made durable.
pub fn before_sync(file: &File) {
    WATCHED.with_borrow_mut(|disk| disk.iter_mut().for_each(|disk| disk.before_sync(file)));
}

/// The old and the new, and either with one change more or less: changes may come to the disk in any order.
fn mixtures<K: Ord + Clone, V: PartialEq + Clone>(
    old: &BTreeMap<K, V>,
    new: &BTreeMap<K, V>,
) -> Vec<BTreeMap<K, V>> {
    let keys: BTreeSet<&K> = old.keys().chain(new.keys()).collect();
    let mut mixtures = vec![old.clone(), new.clone()];
    for key in keys.into_iter().filter(|key| old.get(key) != new.get(key)) {
        for (base, other) in [(old, new), (new, old)] {
            let mut mixture = base.clone();
            match other.get(key) {
                Some(value) => mixture.insert(key.clone(), value.clone()),
                None => mixture.remove(key),
            };
            mixtures.push(mixture);
        }
    }
    mixtures
}

/// Only what lies in folders that are there can be found again.
fn files(names: &Names, contents: &Contents) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let is_found = |path: &Path| {
        let mut folders = path.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty());
        folders.all(|folder| names.contains_key(folder))
    };
    let found = names.iter().filter(|(path, _)| is_found(path));
    let content = |inode: &Inode| match inode {
        Inode::Folder => None,
        Inode::File(number) => Some(contents.get(number).cloned().unwrap_or_default()),
    };
    found.map(|(path, inode)| (path.clone(), content(inode))).collect()
}

/// Everything in a folder, folders before what they hold.
fn all_within(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("it is there");
    let mut paths = Vec::new();
    for path in entries.map(|entry| entry.expect("it is readable").path()) {
        let inner = if path.is_dir() { all_within(&path) } else { Vec::new() };
        paths.push(path);
        paths.extend(inner);
    }
    paths
}
