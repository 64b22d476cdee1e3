//! A child process, as its parent sees it.

use crate::runs::Failure;
use std::fmt;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::Sender;
use std::thread::JoinHandle;

/// Who a child is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// An island, by its index.
    Island(u32),
    /// The monitor.
    Monitor,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Role::Island(index) => write!(f, "island {index}"),
            Role::Monitor => f.write_str("the monitor"),
        }
    }
}

/// What is heard of a child.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Word {
    /// A line that it said.
    Said(String),
    /// A line about what went wrong.
    Complained(String),
    /// It has died, or will in a moment: wait for it.
    Died,
}

/// A child process, seen from its parent. Dropped, it is killed and waited for.
pub struct ChildProcess {
    role: Role,
    child: Child,
    stdin: Option<ChildStdin>,
    readers: Vec<JoinHandle<()>>,
}

impl ChildProcess {
    /// Starts this executable with other arguments. What it says is sent to `words`, and that it has died.
    ///
    /// Call it from the main thread: a child dies with the thread that started it.
    ///
    /// # Errors
    /// If no process can be started.
    pub fn start(
        role: Role,
        arguments: &[String],
        words: &Sender<(Role, Word)>,
    ) -> Result<Self, Failure> {
        let failed = |error| Failure::failed(format!("cannot start {role}: {error}"));
        let mut child = Command::new(executable().map_err(failed)?)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            // Ctrl-C reaches the whole process group of a terminal, and is the launcher's alone.
            .process_group(0)
            .spawn()
            .map_err(failed)?;
        let to = || (role, words.clone());
        let complaints =
            child.stderr.take().map(|stream| forward(stream, Word::Complained, None, to()));
        let sayings =
            child.stdout.take().map(|stream| forward(stream, Word::Said, Some(Word::Died), to()));
        let stdin = child.stdin.take();
        Ok(Self { role, child, stdin, readers: complaints.into_iter().chain(sayings).collect() })
    }

    /// Whether it lives.
    pub fn is_alive(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Asks it to stop.
    pub fn ask_to_stop(&mut self) {
        self.stdin = None;
    }

    /// Waits for its end, and until all that it said has been sent.
    ///
    /// # Errors
    /// If it cannot be waited for.
    pub fn wait_for_end(mut self) -> Result<ExitStatus, Failure> {
        let role = self.role;
        let status = self.child.wait();
        for reader in self.readers.drain(..) {
            // A reader that panicked has nothing more to send.
            let _ = reader.join();
        }
        status.map_err(|error| Failure::failed(format!("cannot wait for {role}: {error}")))
    }
}

/// This very program. Where it was built anew or removed since it started, it is the old one that goes on: the
/// new one may evolve otherwise.
fn executable() -> std::io::Result<PathBuf> {
    const RUNNING: &str = "/proc/self/exe";
    let named = std::env::current_exe()?;
    Ok(if named.exists() { named } else { PathBuf::from(RUNNING) })
}

impl Drop for ChildProcess {
    fn drop(&mut self) {
        // Both fail only if it has ended by itself meanwhile.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends each line of a stream as a word of somebody's, and a last word at its end.
fn forward(
    stream: impl Read + Send + 'static,
    word: fn(String) -> Word,
    last: Option<Word>,
    (role, words): (Role, Sender<(Role, Word)>),
) -> JoinHandle<()> {
    std::thread::spawn(move || {
        let lines = BufReader::new(stream).split(b'\n').map_while(Result::ok);
        let lines = lines.map(|line| word(String::from_utf8_lossy(&line).into_owned()));
        for word in lines.chain(last) {
            // A launcher that does not listen is about to end. Its child must be able to speak all the same.
            let _ = words.send((role, word));
        }
    })
}

// How urgently a process is to stop.
