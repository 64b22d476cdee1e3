//! Claims and what is left without them, in a folder that stands for shared memory.

use super::super::claim::{Claim, Found};
use super::super::names;
use super::super::remains::{self, Remains};
use super::super::shared_memory::SharedMemory;
use super::*;
use std::os::unix::fs::{PermissionsExt, chown, symlink};
use std::path::PathBuf;
use tempfile::TempDir;

const RUN: u64 = 0x2a;

/// A folder that stands for shared memory, and one that stands for another one's temporary files.
struct Place {
    memory: SharedMemory,
    shm: TempDir,
    tmp: TempDir,
}

impl Place {
    fn new() -> Self {
        let [shm, tmp] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let user = rustix::process::geteuid().as_raw();
        Self { memory: SharedMemory::new(shm.path(), user), shm, tmp }
    }

    fn root(&self) -> PathBuf {
        self.tmp.path().join(names::folder(RUN))
    }

    fn object(&self, name: &str) -> PathBuf {
        self.shm.path().join(names::prefix(RUN) + name)
    }

    /// What the run has while its launcher lives.
    fn launch(&self) -> Claim {
        let claim = Claim::make(&self.memory, RUN, &self.root()).unwrap();
        fs::create_dir_all(self.root().join("nodes")).unwrap();
        fs::write(self.object("x.data"), [1; 5000]).unwrap();
        fs::write(self.object("y.data"), [1]).unwrap();
        claim
    }

    /// What it has after its death.
    fn crash(&self) {
        drop(self.launch());
    }

    fn abandoned(&self) -> Vec<Remains> {
        remains::abandoned(&self.memory)
    }

    fn only(&self) -> Remains {
        // A process that another test is just starting holds a copy of the lock for a moment.
        for _ in 0..1_000 {
            if let Some(remains) = self.abandoned().pop() {
                return remains;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("nothing is abandoned");
    }

    /// What is left of anything.
    fn left(&self) -> Vec<PathBuf> {
        let below =
            |folder: &Path| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut left: Vec<_> = below(self.shm.path()).chain(below(self.tmp.path())).collect();
        left.sort();
        left
    }
}

#[test]
fn what_a_killed_launcher_left_is_told_and_removed_wherever_its_folder_is() {
    let place = Place::new();
    place.crash();
    let remains = place.only();
    assert_eq!((remains.run_id, remains.objects), (RUN, 2));
    assert_eq!(remains.folder, Some(place.root()));
    assert!(remains.bytes >= 5001, "{} bytes", remains.bytes);
    assert_eq!(place.left().len(), 4, "telling removes nothing");
    assert_eq!(remains.remove().unwrap(), Removal::Done);
    assert_eq!(place.left(), [""; 0].map(PathBuf::from));
}

#[test]
fn a_run_whose_launcher_lives_is_left_alone() {
    let place = Place::new();
    let claim = place.launch();
    assert!(place.abandoned().is_empty());
    assert!(matches!(Claim::take_over(&place.memory, RUN), Found::Held));
    assert!(Claim::make(&place.memory, RUN, &place.root()).is_err());
    assert_eq!(place.left().len(), 4);
    claim.remove().unwrap();
    assert_eq!(place.left(), [""; 0].map(PathBuf::from));
}

#[test]
fn what_changed_since_it_was_told_is_left_alone() {
    let place = Place::new();
    place.crash();
    let [first, second, third] = [place.only(), place.only(), place.only()];
    let Found::Abandoned(claim) = Claim::take_over(&place.memory, RUN) else {
        panic!("it is dead")
    };
    assert_eq!(first.remove().unwrap(), Removal::Held, "another is at it");
    assert_eq!(place.left().len(), 4);
    drop(claim);
    assert_eq!(second.remove().unwrap(), Removal::Done);
    assert_eq!(third.remove().unwrap(), Removal::Gone);
}

#[test]
fn nothing_of_another_users_is_touched() {
    let place = Place::new();
    place.crash();
    let stranger = SharedMemory::new(place.shm.path(), rustix::process::geteuid().as_raw() + 1);
    assert!(remains::abandoned(&stranger).is_empty());
    assert_eq!((stranger.objects(RUN).len(), stranger.remove_stillborn(RUN)), (0, 0));
    stranger.remove_objects(RUN).unwrap();
    assert_eq!(place.left().len(), 4);
}

#[test]
fn a_folder_that_was_given_away_is_kept() {
    let place = Place::new();
    place.crash();
    // Only who may do everything can give something away, and it is he who could remove it.
    let given = chown(place.root(), Some(rustix::process::geteuid().as_raw() + 1), None);
    if let Err(error) = given {
        assert!(!rustix::process::geteuid().is_root(), "{error}");
        return;
    }
    assert_eq!(place.only().folder, None);
    assert_eq!(place.only().remove().unwrap(), Removal::Done);
    assert_eq!(place.left(), [place.root()]);
}

#[test]
fn only_the_own_folder_is_removed_whatever_a_claim_says() {
    let place = Place::new();
    let precious = tempfile::tempdir().unwrap();
    let other = precious.path().join(names::folder(RUN + 1));
    let below = precious.path().join(names::folder(RUN)).join("below");
    let [link, file] =
        ["link", "file"].map(|name| precious.path().join(name).join(names::folder(RUN)));
    fs::create_dir_all(&other).unwrap();
    fs::create_dir_all(&below).unwrap();
    for path in [&link, &file] {
        fs::create_dir(path.parent().unwrap()).unwrap();
    }
    symlink(below.parent().unwrap(), &link).unwrap();
    fs::write(&file, "kept").unwrap();
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let mut long = text(&place.root()).into_bytes();
    long.splice(0..0, b"/".repeat(5 << 20));
    let contents = [
        Vec::new(),
        b"/".to_vec(),
        b"/\xff\xfe".to_vec(),
        names::folder(RUN).into_bytes(),
        text(precious.path()).into_bytes(),
        text(&other).into_bytes(),
        text(&below).into_bytes(),
        text(&below.join("..")).into_bytes(),
        text(&link).into_bytes(),
        (text(&link) + "/").into_bytes(),
        text(&file).into_bytes(),
        (text(below.parent().unwrap()) + "\0").into_bytes(),
        long,
    ];
    for content in contents {
        place.crash();
        fs::write(place.memory.claim(RUN), &content).unwrap();
        let shown = String::from_utf8_lossy(&content[..content.len().min(200)]).into_owned();
        let remains = place.only();
        assert_eq!((remains.objects, &remains.folder), (2, &None), "{shown}");
        assert_eq!(remains.remove().unwrap(), Removal::Done, "{shown}");
        assert_eq!(place.left(), [place.root()], "{shown}");
        let all = [&other, &below, &link, &file];
        assert!(all.iter().all(|path| path.symlink_metadata().is_ok()), "{shown}");
    }
}

#[test]
fn something_else_that_is_called_like_a_claim_is_none() {
    let place = Place::new();
    let secret = place.tmp.path().join("secret");
    fs::write(&secret, "kept").unwrap();
    symlink(&secret, place.memory.claim(RUN)).unwrap();
    fs::create_dir(place.memory.claim(RUN + 1)).unwrap();
    let pipe = place.memory.claim(RUN + 2);
    assert!(Command::new("mkfifo").arg(pipe).status().unwrap().success());
    fs::write(place.shm.path().join("isl2a_launcher"), []).unwrap();
    assert!(place.abandoned().is_empty(), "and nobody waits for a pipe");
    assert_eq!(place.left().len(), 5);
}

#[test]
fn a_claim_that_says_nothing_of_use_stands_for_the_default_folder() {
    let domain = domain(19);
    let place = Place::new();
    for content in [String::new(), names::folder(domain.run_id())] {
        let claim = Claim::make(&place.memory, domain.run_id(), domain.root()).unwrap();
        fs::create_dir(domain.root()).unwrap();
        fs::write(place.memory.claim(domain.run_id()), content).unwrap();
        drop(claim);
        assert_eq!(place.only().remove().unwrap(), Removal::Done);
        assert!(!domain.root().exists());
    }
}

#[test]
fn a_claim_is_for_this_user_only_and_is_no_object() {
    let place = Place::new();
    let claim = Claim::make(&place.memory, RUN, &place.root()).unwrap();
    let path = place.shm.path().join(names::claim(RUN));
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    assert_eq!(fs::read(&path).unwrap(), place.root().to_str().unwrap().as_bytes());
    fs::write(&path, []).unwrap();
    assert_eq!((place.memory.objects(RUN).len(), place.memory.remove_stillborn(RUN)), (0, 0));
    claim.remove().unwrap();
    assert!(!path.exists());
}

#[test]
fn a_launcher_and_a_cleaner_never_take_a_claim_from_each_other() {
    let place = Place::new();
    std::thread::scope(|scope| {
        let launcher = scope.spawn(|| {
            for life in 0..2_000 {
                let claim = Claim::make(&place.memory, RUN, &place.root()).unwrap();
                fs::create_dir(place.root()).unwrap();
                fs::write(place.object("x.data"), [1]).unwrap();
                std::thread::yield_now();
                assert_eq!(place.left().len(), 3, "in life {life}");
                claim.remove().unwrap();
            }
        });
        while !launcher.is_finished() {
            if let Found::Abandoned(claim) = Claim::take_over(&place.memory, RUN) {
                claim.remove().unwrap();
            }
        }
    });
}

#[test]
fn only_what_stays_empty_is_stillborn() {
    let place = Place::new();
    let stranger = place.shm.path().join(names::prefix(RUN + 1) + "x.data");
    let [empty, young, full] = ["e.data", "y.data", "f.data"].map(|name| place.object(name));
    for path in [&empty, &young, &stranger] {
        fs::write(path, []).unwrap();
    }
    fs::write(&full, [1]).unwrap();
    // It is followed by another of the same name, again and again: each is young.
    std::thread::scope(|scope| {
        let removal = scope.spawn(|| place.memory.remove_stillborn(RUN));
        let next = place.shm.path().join("next");
        // Held open: other than shared memory, a disk gives the number of a file that is gone to another one.
        let mut ancestors = Vec::new();
        while !removal.is_finished() {
            fs::write(&next, []).unwrap();
            ancestors.push(fs::File::open(&young).unwrap());
            fs::rename(&next, &young).unwrap();
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(removal.join().unwrap(), 1);
    });
    assert_eq!(place.left(), [full, young, stranger]);
    assert!(!empty.exists());
}

#[test]
fn the_next_launcher_removes_what_a_killed_one_left() {
    let dead = domain(20);
    let memory = SharedMemory::own();
    drop(dead.create().unwrap());
    fs::write(Path::new("/dev/shm").join(dead.prefix() + "x.data"), [1]).unwrap();
    // Another launcher may be at it: then it is the one that finishes.
    for _ in 0..1_000 {
        drop(launch(21, 1));
        if !memory.claimed().contains(&dead.run_id()) {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(remains(&dead), [""; 0]);
}
