//! Where one run's shared memory lives, apart from every other run's.

use super::TransportError;
use iceoryx2::prelude::{Config, FileName, LogLevel, Path, SemanticString, set_log_level};
use std::fmt;
use std::fs::{self, DirBuilder, File, Metadata, Permissions};
use std::io;
use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
use std::path::{Path as FsPath, PathBuf};
use std::str::FromStr;
use std::time::{Duration, SystemTime};

const SHARED_MEMORY: &str = "/dev/shm";

/// Sockets lie below the root, and the whole path of one must fit in 108 bytes; iceoryx2 itself needs 44
/// of them for its names. Longer ones fail or panic inside of it.
const ROOT_AND_PREFIX_MAX: usize = 64;

/// An object that a process was killed over while it was making it. A living one needs microseconds.
const STILLBORN_AFTER: Duration = Duration::from_millis(5);

/// The file in a domain's folder that its launcher holds a lock on while it lives.
const OWNER: &str = "launcher";
/// A launcher needs microseconds to lock it.
const ABANDONED_AFTER: Duration = Duration::from_secs(60);

/// What folders and prefixes begin with.
const NAME: &str = "isl";

/// The place of one run: a prefix for all its objects in shared memory, and a folder for its files.
///
/// Both follow from the run's id, so that a child needs nothing else to find its run: hand it
/// `domain.to_string()`, and it parses that.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Domain {
    run_id: u64,
    root: PathBuf,
}

impl Domain {
    /// The domain of a run. The id must be one that no other run on this machine has.
    pub fn new(run_id: u64) -> Self {
        let folder = format!("{NAME}{run_id:016x}");
        let root = std::env::temp_dir().join(&folder);
        // A long TMPDIR is common (macOS, build systems), and /tmp always works.
        let root = if fits(run_id, &root) { root } else { FsPath::new("/tmp").join(folder) };
        Self { run_id, root }
    }

    /// The run's id.
    pub fn run_id(&self) -> u64 {
        self.run_id
    }

    /// The folder of the run's files.
    pub fn root(&self) -> &FsPath {
        &self.root
    }

    /// What the names of all objects of the run in shared memory begin with.
    pub fn prefix(&self) -> String {
        prefix(self.run_id)
    }

    /// Makes the root folder, for this user only, and claims it for as long as the file that it returns is
    /// open.
    pub(super) fn create(&self) -> Result<File, TransportError> {
        let claim = || {
            DirBuilder::new().mode(0o700).create(&self.root)?;
            // Once more, since the mode above is subject to the umask.
            fs::set_permissions(&self.root, Permissions::from_mode(0o700))?;
            let owner = File::create_new(self.root.join(OWNER))?;
            owner.try_lock()?;
            Ok(owner)
        };
        claim().map_err(|source| TransportError::folder(&self.root, source))
    }

    /// Removes all domains of this user whose launcher was killed, and returns how many there were: a killed
    /// launcher leaves its shared memory behind until the machine is started again.
    pub fn remove_abandoned() -> usize {
        let here = Self::new(0);
        let Some(Ok(folders)) = here.root.parent().map(fs::read_dir) else { return 0 };
        let domains = folders.filter_map(|entry| {
            let name = entry.ok()?.file_name();
            let id = name.to_str()?.strip_prefix(NAME).filter(|id| id.len() == 16)?;
            id.parse::<Self>().ok()
        });
        domains.filter(Self::is_abandoned).filter(|domain| domain.remove().is_ok()).count()
    }

    // Nobody holds the claim, and not because it is being made just now.
    fn is_abandoned(&self) -> bool {
        let owner = File::open(self.root.join(OWNER));
        owner.is_ok_and(|owner| {
            let age = owner.metadata().ok().and_then(|status| age(&status));
            age.is_some_and(|age| age > ABANDONED_AFTER) && owner.try_lock().is_ok()
        })
    }

    /// The configuration of iceoryx2 that keeps to this domain.
    ///
    /// Nobody cleans up on the way: only the launcher knows who is dead, and two cleaners at once, or one
    /// in an island that is killed meanwhile, leave more behind than they remove.
    pub(super) fn config(&self) -> Result<Config, TransportError> {
        // Its warnings are whole data structures, and every one of them is handled here.
        set_log_level(LogLevel::Error);
        let mut config = Config::default();
        let root = self.root.to_string_lossy();
        let path = Path::new(root.as_bytes()).map_err(|e| TransportError::setup("the path", e))?;
        config.global.set_root_path(&path);
        config.global.prefix = FileName::new(self.prefix().as_bytes())
            .map_err(|e| TransportError::setup("the prefix", e))?;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        Ok(config)
    }

    /// Checks that shared memory has `needed` free bytes. Without them a write into it would end the
    /// process by SIGBUS, in the middle of a run.
    pub fn check_space(&self, needed: u64) -> Result<(), TransportError> {
        // Where there is no such folder, shared memory has no size that could be asked for.
        let Ok(status) = rustix::fs::statvfs(SHARED_MEMORY) else { return Ok(()) };
        let free = status.f_bavail.saturating_mul(status.f_frsize);
        if free < needed {
            let [needed_mib, free_mib] = [needed.div_ceil(1 << 20), free >> 20];
            return Err(TransportError::NoSpace { path: SHARED_MEMORY, needed_mib, free_mib });
        }
        Ok(())
    }

    /// Removes what processes killed while they were making it have left: objects of no size, on which the
    /// cleaning up of a dead process would wait for ever. Returns how many there were.
    pub fn remove_stillborn(&self) -> usize {
        let stillborn = |path: &PathBuf| {
            let Ok(status) = fs::metadata(path) else { return false };
            status.len() == 0 && age(&status).is_some_and(|age| age > STILLBORN_AFTER)
        };
        let objects = self.objects().into_iter().filter(stillborn);
        objects.filter(|path| fs::remove_file(path).is_ok()).count()
    }

    /// Removes all that the run has in shared memory and its folder. For the launcher, when all others have
    /// ended: who still uses the domain then loses it.
    pub fn remove(&self) -> Result<(), TransportError> {
        for path in self.objects() {
            unless_gone(fs::remove_file(&path))
                .map_err(|source| TransportError::folder(&path, source))?;
        }
        unless_gone(fs::remove_dir_all(&self.root))
            .map_err(|source| TransportError::folder(&self.root, source))
    }

    fn objects(&self) -> Vec<PathBuf> {
        let prefix = self.prefix();
        let Ok(entries) = fs::read_dir(SHARED_MEMORY) else { return Vec::new() };
        let ours = |path: &PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| name.starts_with(&prefix))
        };
        entries.filter_map(Result::ok).map(|entry| entry.path()).filter(ours).collect()
    }
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.run_id)
    }
}

impl FromStr for Domain {
    type Err = TransportError;

    fn from_str(text: &str) -> Result<Self, TransportError> {
        let run_id = u64::from_str_radix(text, 16);
        run_id.map(Self::new).map_err(|_| TransportError::RunId { text: text.to_owned() })
    }
}

// None for what comes from the future, since a clock was set back.
#[expect(
    clippy::disallowed_methods,
    reason = "how old a file is decides what is removed, not a result"
)]
fn age(status: &Metadata) -> Option<Duration> {
    SystemTime::now().duration_since(status.modified().ok()?).ok()
}

fn prefix(run_id: u64) -> String {
    format!("{NAME}{run_id:016x}_")
}

fn fits(run_id: u64, root: &FsPath) -> bool {
    // iceoryx2 allows only these in a path.
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    let text = root.to_str().filter(|text| text.starts_with('/') && text.chars().all(plain));
    text.is_some_and(|text| text.len() + prefix(run_id).len() <= ROOT_AND_PREFIX_MAX)
}

fn unless_gone(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "files of tests have ages too")]
mod tests {
    use super::*;

    #[test]
    fn a_domain_survives_being_an_argument_and_is_unlike_any_other() {
        let domain = Domain::new(0x2a);
        assert_eq!(domain.to_string(), "000000000000002a");
        assert_eq!(domain.to_string().parse::<Domain>().unwrap(), domain);
        assert!("forty-two".parse::<Domain>().is_err());
        assert_ne!(domain.prefix(), Domain::new(0x2b).prefix());
        assert_ne!(domain.root(), Domain::new(0x2b).root());
    }

    #[test]
    fn a_root_that_is_too_long_for_a_socket_is_not_used() {
        assert!(fits(1, FsPath::new("/tmp/isl0000000000000001")));
        let long = format!("/{}", "a".repeat(ROOT_AND_PREFIX_MAX));
        assert!(!fits(1, FsPath::new(&long)));
        assert!(!fits(1, FsPath::new("/tmp/with a space")));
    }

    #[test]
    fn too_little_shared_memory_is_said_in_numbers() {
        let error = Domain::new(1).check_space(u64::MAX).unwrap_err().to_string();
        assert!(error.contains("17592186044416 MiB") && error.contains("/dev/shm"), "{error}");
        Domain::new(1).check_space(0).unwrap();
    }

    #[test]
    fn only_old_empty_objects_of_the_own_run_are_stillborn() {
        let domain = Domain::new(0x5111_b007_0000_0000 | u64::from(std::process::id()));
        let object = |name: &str| FsPath::new(SHARED_MEMORY).join(domain.prefix() + name);
        let stranger = FsPath::new(SHARED_MEMORY).join(format!("{}x", prefix(!domain.run_id)));
        let now = SystemTime::now();
        let write = |path: &FsPath, bytes: &[u8], modified| {
            fs::write(path, bytes).unwrap();
            File::open(path).unwrap().set_modified(modified).unwrap();
        };
        write(&object("empty"), &[], now - 2 * STILLBORN_AFTER);
        write(&object("full"), &[1], now - 2 * STILLBORN_AFTER);
        write(&stranger, &[], now - 2 * STILLBORN_AFTER);
        write(&object("young"), &[], now + Duration::from_secs(60));
        assert_eq!(domain.remove_stillborn(), 1);
        assert!(!object("empty").exists() && object("young").exists() && object("full").exists());
        domain.remove().unwrap();
        assert!(!object("full").exists() && stranger.exists());
        fs::remove_file(stranger).unwrap();
    }

    #[test]
    fn what_a_killed_launcher_left_is_removed_and_nothing_else() {
        let domain = |test: u64| Domain::new(test << 40 | u64::from(std::process::id()));
        let [dead, alive] = [domain(0xdead), domain(0xa11e)];
        let claims = [&dead, &alive].map(|domain| domain.create().unwrap());
        let object = FsPath::new(SHARED_MEMORY).join(dead.prefix() + "object");
        fs::write(&object, [1]).unwrap();
        for claim in &claims {
            claim.set_modified(SystemTime::now() - 2 * ABANDONED_AFTER).unwrap();
        }
        let [claim, _alive] = claims;
        drop(claim);
        // Another launcher may be at it: then it is the one that finishes.
        for _ in 0..1_000 {
            Domain::remove_abandoned();
            if !dead.root().exists() {
                break;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(!dead.root().exists() && !object.exists() && alive.root().exists());
        alive.remove().unwrap();
    }
}
