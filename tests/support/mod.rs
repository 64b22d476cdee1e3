//! Starting the program in a world of its own, and looking at what it leaves behind.

pub mod forger;
pub mod imports;
#[cfg(feature = "view")]
pub mod onlooker;
#[cfg(feature = "view")]
pub mod reel;

use islands::store::{Checkpoints, Entry, RecordLog, RunDir};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;

/// Settings of a run that takes a moment and in which migrants arrive all the same.
pub const TINY: &str =
    "--population 4 --robustness 0 --generations 3 --genes 2 --migration-interval 1";

const SHARED_MEMORY: &str = "/dev/shm";
/// What the names of all that runs have in shared memory begin with; their id follows.
const NAME: &str = "isl";
const ID_DIGITS: usize = 16;

/// How often a test looks whether something has happened that it waits for.
const LOOK: Duration = Duration::from_millis(20);
/// How often it looks before it gives up.
const LOOKS: usize = 6_000;

/// A folder to work in and one for temporary files, which nobody else has.
pub struct World {
    home: TempDir,
}

/// How the program ended, and what it said.
#[derive(Debug)]
pub struct Ending {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl World {
    pub fn new() -> Self {
        let home = tempfile::tempdir().unwrap();
        for folder in ["work", "tmp"] {
            fs::create_dir(home.path().join(folder)).unwrap();
        }
        Self { home }
    }

    /// A path in the folder that the program works in.
    pub fn path(&self, name: &str) -> PathBuf {
        self.home.path().join("work").join(name)
    }

    /// A path in the folder that the program has for temporary files.
    pub fn temporary(&self, name: &OsStr) -> PathBuf {
        self.home.path().join("tmp").join(name)
    }

    /// Writes a file there.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The program with these arguments, which hold no spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_islands"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.path(""))
            .env("TMPDIR", self.home.path().join("tmp"))
            .stdin(Stdio::null());
        command
    }

    /// Runs the program to its end.
    pub fn islands(&self, arguments: &str) -> Ending {
        self.command(arguments).output().unwrap().into()
    }

    /// Runs the program to its end, which must be a success that nothing is to be said about, and reads the
    /// object that is its last line.
    pub fn json(&self, arguments: &str) -> Value {
        let ending = self.islands(arguments);
        let is_fine = ending.code == Some(0) && !ending.stderr.contains("warning");
        assert!(is_fine, "islands {arguments}: {ending:?}");
        ending.json()
    }

    /// The digest of a run without a monitor, in a folder of this name.
    pub fn digest(&self, name: &str, arguments: &str) -> String {
        let run = self.json(&format!("--out {name} --no-monitor --quiet --json {arguments}"));
        self.assert_left_nothing();
        run["digest"].as_str().unwrap().to_owned()
    }

    /// Runs the program with what it must refuse, and returns the sentence that it refuses it with.
    pub fn refusal(&self, arguments: &str) -> String {
        let [files, others] = [BTreeSet::from_iter(self.files()), runs_in_shared_memory()];
        let ending = self.islands(arguments);
        assert_eq!(ending.code, Some(2), "islands {arguments}: {ending:?}");
        assert_eq!(ending.stdout, "");
        assert_eq!(BTreeSet::from_iter(self.files()), files, "islands {arguments}");
        self.assert_left_nothing();
        // Runs of other tests come to their end; what this one left would stay.
        let new: BTreeSet<_> = runs_in_shared_memory().difference(&others).cloned().collect();
        until("nothing is left in shared memory", || runs_in_shared_memory().is_disjoint(&new));
        let hint = "\n\nFor more information, try '--help'.\n";
        let sentence = ending.stderr.strip_suffix(hint).unwrap_or(&ending.stderr).trim_end();
        assert!(!sentence.contains('\n'), "islands {arguments}: {sentence}");
        sentence.strip_prefix("error: ").unwrap().to_owned()
    }

    /// Starts the program and goes on.
    pub fn start(&self, arguments: &str) -> Running {
        Running::of(self.command(arguments))
    }

    /// Every file in the folder that the program works in, in order.
    pub fn files(&self) -> Vec<String> {
        let root = self.path("");
        let mut files = files_below(&root);
        files.sort();
        let name = |path: PathBuf| path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned();
        files.into_iter().map(name).collect()
    }

    /// Asserts that the runs of this world, all of which have ended, left nothing outside of their folders.
    pub fn assert_left_nothing(&self) {
        let temporary = fs::read_dir(self.home.path().join("tmp")).unwrap();
        let names: Vec<_> = temporary.map(|entry| entry.unwrap().file_name()).collect();
        assert!(names.is_empty(), "{names:?} is left");
        for file in self.files().iter().filter(|file| file.ends_with("run.toml")) {
            // A test may have spoilt it on purpose.
            let Some(id) = launch_id(&self.read(file)) else { continue };
            self.assert_left_nothing_of(&id);
        }
    }

    /// Asserts that the run with this id left nothing outside of its folder.
    pub fn assert_left_nothing_of(&self, id: &str) {
        let is_left = runs_in_shared_memory().contains(id);
        assert!(!is_left, "the run {id} left something in {SHARED_MEMORY}");
        let folder = format!("{NAME}{id}");
        for folder in [self.temporary(folder.as_ref()), Path::new("/tmp").join(&folder)] {
            assert!(!folder.exists(), "the run {id} left {}", folder.display());
        }
    }
}

impl Ending {
    /// The object that is the last line.
    pub fn json(&self) -> Value {
        let last = self.stdout.lines().next_back().unwrap_or_default();
        serde_json::from_str(last).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

impl From<Output> for Ending {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self {
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }
}

/// The program under way; a test that fails meanwhile ends it.
pub struct Running(Option<Child>);

impl Running {
    /// Starts a command.
    pub fn of(mut command: Command) -> Self {
        Self(Some(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()))
    }

    pub fn pid(&self) -> u32 {
        self.0.as_ref().unwrap().id()
    }

    /// Sends a signal to it alone.
    pub fn signal(&self, name: &str) {
        signal(self.pid(), name);
    }

    /// Waits for its end.
    pub fn wait(mut self) -> Ending {
        self.0.take().unwrap().wait_with_output().unwrap().into()
    }

    /// The process that it has started with this argument, once there is one.
    pub fn child(&self, argument: &str) -> u32 {
        let mut child = None;
        until("there is such a child", || {
            child = self.find_child(argument);
            child.is_some() || !is_alive(self.pid())
        });
        child.unwrap_or_else(|| panic!("it ended without a child {argument}"))
    }

    /// The same, if there is one at the moment.
    pub fn find_child(&self, argument: &str) -> Option<u32> {
        let is_it = |pid: &u32| {
            let arguments = fs::read_to_string(format!("/proc/{pid}/cmdline"));
            arguments.is_ok_and(|line| line.split('\0').any(|found| found == argument))
        };
        self.children().into_iter().find(is_it)
    }

    /// All processes that it has started and that live.
    pub fn children(&self) -> Vec<u32> {
        children(self.pid()).into_iter().filter(|&pid| is_alive(pid)).collect()
    }

    /// Whether it is under way.
    pub fn is_alive(&self) -> bool {
        is_alive(self.pid())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Sends a signal to a process.
pub fn signal(pid: u32, name: &str) {
    assert!(try_signal(pid, name));
}

/// Sends a signal to a process that may have ended by itself; whether there was one.
pub fn try_signal(pid: u32, name: &str) -> bool {
    let mut kill = Command::new("kill");
    kill.args([format!("-{name}"), pid.to_string()]).stderr(Stdio::null());
    kill.status().unwrap().success()
}

/// Stops a process, and says whether that came before its end.
pub fn stop(pid: u32) -> bool {
    let is_stopped = || status_of(pid, 0).is_some_and(|state| state == "T");
    try_signal(pid, "STOP") && {
        until("it has stopped or ended", || is_stopped() || !is_alive(pid));
        is_stopped()
    }
}

/// Waits until every island of a run has evolved this generation.
pub fn await_generation(dir: &RunDir, islands: u32, generation: u32) {
    let generations = |island| {
        RecordLog::<Entry>::read(&dir.reports(island)).map_or(0, |log| log.records.len() as u32)
    };
    until("every island has evolved", || (0..islands).all(|i| generations(i) > generation));
}

/// Writes a log of these records instead of the one that is there.
pub fn rewrite<'a, T>(path: &Path, records: impl IntoIterator<Item = &'a T>)
where
    T: Serialize + DeserializeOwned + 'a,
{
    let mut log = RecordLog::open(path).unwrap();
    log.truncate(0).unwrap();
    records.into_iter().for_each(|record| log.append(record).unwrap());
}

/// The checkpoints of an island of a run, whole or not, the newest first.
pub fn checkpoints(dir: &RunDir, island: u32) -> Vec<PathBuf> {
    let generations = Checkpoints::of(dir, island).generations().unwrap_or_default();
    generations.into_iter().map(|generation| dir.checkpoint(island, generation)).collect()
}

/// Waits until something is so.
pub fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    for _ in 0..LOOKS {
        if is_so() {
            return;
        }
        sleep(LOOK);
    }
    panic!("waited in vain until {what}");
}

/// The ids of all runs on this machine that have something in shared memory.
pub fn runs_in_shared_memory() -> BTreeSet<String> {
    let names = fs::read_dir(SHARED_MEMORY).unwrap().map(|entry| entry.unwrap().file_name());
    let id = |name: &str| name.strip_prefix(NAME)?.get(..ID_DIGITS).map(str::to_owned);
    names.filter_map(|name| id(name.to_str()?)).collect()
}

/// The id that a run's configuration names.
pub fn run_id(config: &str) -> String {
    launch_id(config).unwrap()
}

fn launch_id(config: &str) -> Option<String> {
    let config: toml::Table = config.parse().ok()?;
    config.get("launch")?.get("run-id")?.as_str().map(str::to_owned)
}

/// Asserts that two JSON values are the same, numbers to the last bit, whether written as 1 or 1.0.
pub fn assert_same(found: &Value, expected: &Value, place: &str) {
    match (found, expected) {
        (Value::Object(found), Value::Object(expected)) => {
            assert!(found.keys().eq(expected.keys()), "{place}: {found:?}, not {expected:?}");
            for (key, value) in expected {
                assert_same(&found[key], value, &format!("{place}.{key}"));
            }
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{place}");
            for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
                assert_same(found, expected, &format!("{place}[{i}]"));
            }
        }
        (Value::Number(_), Value::Number(_)) => {
            let (found, expected) = (found.as_f64().unwrap(), expected.as_f64().unwrap());
            assert_eq!(found.to_bits(), expected.to_bits(), "{place}: {found}, not {expected}");
        }
        _ => assert_eq!(found, expected, "{place}"),
    }
}

/// The processes that a process has started.
fn children(parent: u32) -> Vec<u32> {
    let processes = fs::read_dir("/proc").unwrap();
    let pids = processes.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    pids.filter(|&pid| parent_of(pid) == Some(parent)).collect()
}

fn parent_of(pid: u32) -> Option<u32> {
    status_of(pid, 1)?.parse().ok()
}

/// Whether a process exists and is not merely waiting to be waited for.
pub fn is_alive(pid: u32) -> bool {
    status_of(pid, 0).is_some_and(|state| !matches!(state.as_str(), "Z" | "X"))
}

fn status_of(pid: u32, field: usize) -> Option<String> {
    let status = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name before may hold anything but ends with the last bracket; then come the state and the parent.
    status.rsplit_once(')')?.1.split_whitespace().nth(field).map(str::to_owned)
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else {
            files.push(path);
        }
    }
    files
}
