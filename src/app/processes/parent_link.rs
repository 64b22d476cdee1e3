//! How processes of a run are tied to each other: a child dies with its parent, stops when its standard input
//! ends, and says what it has to say in lines on its standard output, and what went wrong on its standard error.
//! Here are the child's end and the words; the parent's end is the launcher's.

use crate::app::console;
use crate::runs::{Failure, INTERRUPTED};
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use signal_hook::iterator::Signals;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

/// What an island tells its launcher before the generation that it goes on from, once it can evolve the next.
pub const READY: &str = "ready after ";
/// What an island tells its launcher when it has evolved all its generations.
pub const FINISHED: &str = "finished";
/// What the monitor tells its launcher, before the address that serves the view.
pub const SERVING: &str = "serving ";

const UNASKED: u8 = 0;
const ASKED: u8 = 1;
const URGED: u8 = 2;

/// Who was urged and still has not ended after so long ends at once.
const LAST_CHANCE: Duration = Duration::from_secs(5);

/// Whether this process was asked to stop, and whether at once.
#[derive(Debug, Clone)]
pub struct StopSignal(Arc<AtomicU8>);

impl StopSignal {
    /// Ties this process to `parent`, and listens for its word.
    ///
    /// # Errors
    /// If the parent is gone already.
    pub fn from_parent(parent: i32) -> Result<Self, Failure> {
        let tied = set_parent_process_death_signal(Some(Signal::KILL));
        tied.map_err(|error| Failure::failed(format!("cannot be tied to the launcher: {error}")))?;
        // The parent may have died before the tie.
        if getppid() != Pid::from_raw(parent) {
            return Err(Failure::failed("the launcher is gone"));
        }
        let stop_signal = Self(Arc::new(AtomicU8::new(UNASKED)));
        let told = stop_signal.clone();
        std::thread::spawn(move || {
            // The end of the input is the word; an error ends it as well.
            let _ = std::io::copy(&mut std::io::stdin().lock(), &mut std::io::sink());
            told.0.store(ASKED, Ordering::Release);
        });
        Ok(stop_signal)
    }

    /// It is raised by Ctrl-C and a request to terminate, once and twice: for a process that nobody started.
    ///
    /// # Errors
    /// If signals cannot be caught.
    pub fn from_signals() -> Result<Self, Failure> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let failed = |error| Failure::failed(format!("cannot catch signals: {error}"));
        let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP]).map_err(failed)?;
        let stop_signal = Self(Arc::new(AtomicU8::new(UNASKED)));
        let told = stop_signal.clone();
        std::thread::spawn(move || {
            let mut signals = signals.forever();
            signals.next();
            told.0.store(ASKED, Ordering::Release);
            signals.next();
            told.0.store(URGED, Ordering::Release);
            std::thread::sleep(LAST_CHANCE);
            std::process::exit(INTERRUPTED.into());
        });
        Ok(stop_signal)
    }

    /// Whether to stop.
    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::Acquire) >= ASKED
    }

    /// Whether to stop at once.
    pub fn is_urgent(&self) -> bool {
        self.0.load(Ordering::Acquire) >= URGED
    }
}

/// Says a line to the parent.
pub fn tell(line: &str) {
    console::print(line);
}
