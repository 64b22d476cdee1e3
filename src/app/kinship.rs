//! Parent and child processes: a child dies with its parent, stops when its standard input ends, and says what
//! it has to say in lines on its standard output.

use super::Failure;
use super::console;
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;

/// What an island tells its launcher when it has evolved all its generations.
pub const FINISHED: &str = "finished";
/// What the monitor tells its launcher, before the address that serves the view.
pub const SERVING: &str = "serving ";
/// What the monitor tells its launcher when it has the last report of every island.
pub const CAUGHT_UP: &str = "caught up";

/// A child process, seen from its parent. Dropped, it is killed and waited for.
pub struct Kin {
    name: String,
    child: Child,
    stdin: Option<ChildStdin>,
    exit: Option<ExitStatus>,
}

impl Kin {
    /// Starts this executable with other arguments. What it prints is sent to `lines`, with its name.
    ///
    /// Call it from the main thread: a child dies with the thread that started it.
    ///
    /// # Errors
    /// If no process can be started.
    pub fn start(
        name: &str,
        arguments: &[String],
        lines: Sender<(String, String)>,
    ) -> Result<Self, Failure> {
        let failed = |error| Failure::failed(format!("cannot start {name}: {error}"));
        let executable = std::env::current_exe().map_err(failed)?;
        let mut child = Command::new(executable)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            // Ctrl-C reaches the whole process group of a terminal, and is the launcher's alone.
            .process_group(0)
            .spawn()
            .map_err(failed)?;
        if let Some(stdout) = child.stdout.take() {
            let name = name.to_owned();
            std::thread::spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    // A launcher that no longer listens is about to end.
                    let _ = lines.send((name.clone(), line));
                }
            });
        }
        let stdin = child.stdin.take();
        Ok(Self { name: name.to_owned(), child, stdin, exit: None })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        if self.exit.is_none() {
            self.exit = self.child.try_wait().ok().flatten();
        }
        self.exit
    }

    /// Asks it to stop.
    pub fn ask_to_stop(&mut self) {
        self.stdin = None;
    }
}

impl Drop for Kin {
    fn drop(&mut self) {
        if self.ended().is_none() {
            // Both fail only if it has ended by itself meanwhile.
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// A child's ear: whether its parent asked it to stop.
#[derive(Debug, Clone)]
pub struct Ear(Arc<AtomicBool>);

impl Ear {
    /// Ties this process to `parent`, and listens for its word.
    ///
    /// # Errors
    /// If the parent is gone already.
    pub fn to(parent: i32) -> Result<Self, Failure> {
        let orphaned = || Failure::failed("the launcher is gone");
        let tied = set_parent_process_death_signal(Some(Signal::KILL));
        tied.map_err(|error| Failure::failed(format!("cannot be tied to the launcher: {error}")))?;
        // The parent may have died before the tie.
        if getppid() != Pid::from_raw(parent) {
            return Err(orphaned());
        }
        let ear = Self(Arc::new(AtomicBool::new(false)));
        let told = ear.clone();
        std::thread::spawn(move || {
            let mut nothing = Vec::new();
            // The end of the input is the word; an error ends it as well.
            let _ = std::io::stdin().lock().read_to_end(&mut nothing);
            told.0.store(true, Ordering::Release);
        });
        Ok(ear)
    }

    /// An ear that hears Ctrl-C and a request to terminate: for a process that nobody started.
    ///
    /// # Errors
    /// If signals cannot be caught.
    pub fn to_signals() -> Result<Self, Failure> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let told = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            // Registered first, so that it acts from the second signal on: at once.
            signal_hook::flag::register_conditional_shutdown(signal, 130, Arc::clone(&told))
                .and_then(|_| signal_hook::flag::register(signal, Arc::clone(&told)))
                .map_err(|error| Failure::failed(format!("cannot catch signals: {error}")))?;
        }
        Ok(Self(told))
    }

    /// Whether to stop.
    pub fn heard_stop(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}

/// Says a line to the parent.
pub fn tell(line: &str) {
    console::print(line);
}
