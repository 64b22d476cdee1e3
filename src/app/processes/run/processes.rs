//! The processes of a run: who they are, what is known of each, and how one is started again.

use super::child::{ChildProcess, Role, Word};
use super::restart_policy::RestartPolicy;
use crate::app::args::cli::{ViewArgs, Watching};
use crate::app::console::Stopwatch;
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::store::RunDir;
use std::collections::BTreeMap;
use std::process::ExitStatus;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// How often is looked whether somebody has ended.
const LOOK: Duration = Duration::from_millis(20);

/// All processes of a run but the launcher.
pub struct Processes {
    dir: RunDir,
    config: Config,
    view: ViewArgs,
    states: BTreeMap<Role, ProcessState>,
    sender: Sender<(Role, Word)>,
    words: Receiver<(Role, Word)>,
}

/// What is known of one of them, and of those that came before it.
#[derive(Default)]
pub struct ProcessState {
    child: Option<ChildProcess>,
    /// Whether it has died, or will in a moment, and was not waited for.
    is_dead: bool,
    restart_policy: RestartPolicy,
    /// Since it was started.
    born: Option<Stopwatch>,
    /// When its successor is to be started: so long after this.
    due: Option<(Stopwatch, Duration)>,
    /// Since the one before it was found dead, until it is ready to do its work.
    vacant: Option<Stopwatch>,
    /// The last thing that it complained of, but for warnings.
    complaint: Option<String>,
    /// The last generation that it has evolved.
    pub generation: Option<u32>,
    /// Whether it has done all its work.
    pub is_finished: bool,
}

impl Processes {
    /// No processes yet.
    pub fn new(dir: RunDir, config: Config, view: ViewArgs) -> Self {
        let (sender, words) = channel();
        Self { dir, config, view, states: BTreeMap::new(), sender, words }
    }

    /// Starts the process for a role, the first or the next.
    ///
    /// # Errors
    /// If no process can be started.
    pub fn start(&mut self, role: Role) -> Result<(), Failure> {
        let child = ChildProcess::start(role, &self.arguments(role), &self.sender)?;
        let state = self.states.entry(role).or_default();
        state.child = Some(child);
        state.born = Some(Stopwatch::start());
        state.due = None;
        state.is_dead = false;
        state.is_finished = false;
        state.complaint = None;
        Ok(())
    }

    /// What somebody says, if anybody does before the time is over.
    pub fn hear(&self, within: Duration) -> Option<(Role, Word)> {
        self.words.recv_timeout(within).ok()
    }

    /// What is known of a role.
    pub fn state(&mut self, role: Role) -> &mut ProcessState {
        self.states.entry(role).or_default()
    }

    /// Those who have died, or will in a moment, and were not waited for.
    pub fn dead(&self) -> Vec<Role> {
        let dead = self.states.iter().filter(|(_, state)| state.is_dead);
        dead.map(|(role, _)| *role).collect()
    }

    /// Those who are to be started by now.
    pub fn due(&self) -> Vec<Role> {
        let is_due =
            |state: &ProcessState| state.due.is_some_and(|(since, pause)| since.elapsed() >= pause);
        self.states.iter().filter(|(_, state)| is_due(state)).map(|(role, _)| *role).collect()
    }

    /// Whether every island has evolved all its generations.
    pub fn is_finished(&self) -> bool {
        self.islands().all(|state| state.is_finished)
    }

    /// The last generation that every island has evolved.
    pub fn generation(&self) -> Option<u32> {
        self.islands().map(|state| state.generation).min().flatten()
    }

    /// Whether there is a process for a role, or will be.
    pub fn has(&self, role: Role) -> bool {
        self.states.get(&role).is_some_and(|state| state.child.is_some() || state.due.is_some())
    }

    /// Waits for the end of one that has died, and until all that it said can be heard. Nothing if it was
    /// waited for already.
    ///
    /// # Errors
    /// If it cannot be waited for.
    pub fn wait_for_end(&mut self, role: Role) -> Result<Option<ExitStatus>, Failure> {
        let state = self.state(role);
        state.is_dead = false;
        let Some(child) = state.child.take() else { return Ok(None) };
        state.vacant = Some(Stopwatch::start());
        child.wait_for_end().map(Some)
    }

    /// Asks those in the roles that are meant to stop.
    pub fn ask_to_stop(&mut self, is_meant: impl Fn(Role) -> bool) {
        self.children(is_meant).filter_map(Option::as_mut).for_each(ChildProcess::ask_to_stop);
    }

    /// Waits until they have ended, for `most`, unless there is a hurry. Returns whether they have.
    pub fn await_end(
        &mut self,
        is_meant: impl Fn(Role) -> bool,
        most: Duration,
        in_a_hurry: impl Fn() -> bool,
    ) -> bool {
        let watch = Stopwatch::start();
        while self.children(&is_meant).filter_map(Option::as_mut).any(ChildProcess::is_alive) {
            if watch.elapsed() > most || in_a_hurry() {
                return false;
            }
            std::thread::sleep(LOOK);
        }
        true
    }

    /// Kills those of them who live, and waits for their end.
    pub fn kill(&mut self, is_meant: impl Fn(Role) -> bool) {
        self.children(is_meant).for_each(|child| drop(child.take()));
    }

    fn children(
        &mut self,
        is_meant: impl Fn(Role) -> bool,
    ) -> impl Iterator<Item = &mut Option<ChildProcess>> {
        let states = self.states.iter_mut();
        states.filter(move |(role, _)| is_meant(**role)).map(|(_, state)| &mut state.child)
    }

    fn islands(&self) -> impl Iterator<Item = &ProcessState> {
        self.states.iter().filter(|(role, _)| **role != Role::Monitor).map(|(_, state)| state)
    }

    fn arguments(&self, role: Role) -> Vec<String> {
        let dir = self.dir.path().display().to_string();
        let parent = format!("--parent={}", std::process::id());
        let own = match role {
            Role::Island(index) => {
                let threads = threads_of(&self.config, index);
                vec![
                    "island".to_owned(),
                    format!("--index={index}"),
                    format!("--threads={threads}"),
                ]
            }
            Role::Monitor => {
                let ViewArgs { view, view_port, view_address } = self.view;
                // The launcher opens the viewer: there is one launcher, and there may be many monitors.
                let view = if view == Watching::Spawn { Watching::Live } else { view };
                let port = view_port.map(|port| format!("--view-port={port}"));
                ["monitor".to_owned(), format!("--view={view}")]
                    .into_iter()
                    .chain([format!("--view-address={view_address}")])
                    .chain(port)
                    .collect()
            }
        };
        // The folder's name may look like a flag.
        own.into_iter().chain([parent, "--".to_owned(), dir]).collect()
    }
}

impl ProcessState {
    /// It has died, or will in a moment.
    pub fn dies(&mut self) {
        self.is_dead = true;
    }

    /// Keeps what it complains of, if that may be what it dies of.
    pub fn complains(&mut self, line: &str) {
        // A panic ends with a note about backtraces.
        let is_idle = |line: &str| line.starts_with("warning: ") || line.starts_with("note: ");
        if !line.is_empty() && !is_idle(line) {
            self.complaint = Some(line.to_owned());
        }
    }

    /// What it complained of before it died.
    pub fn take_complaint(&mut self) -> Option<String> {
        self.complaint.take()
    }

    /// Takes note of its death, and returns whether there is hope for a successor.
    pub fn allows_restart(&mut self, status: ExitStatus) -> bool {
        self.restart_policy.allows_restart(status, self.generation)
    }

    /// Has its successor started after a pause, if it was started too often of late. Returns the pause; zero if there is
    /// none, and the successor is to be started at once.
    pub fn delay(&mut self) -> Duration {
        let lived = self.born.map_or(Duration::ZERO, Stopwatch::elapsed);
        let pause = self.restart_policy.pause(lived, self.generation);
        self.due = (!pause.is_zero()).then(|| (Stopwatch::start(), pause));
        pause
    }

    /// Whether its successor is to be started after a pause.
    pub fn is_awaited(&self) -> bool {
        self.due.is_some()
    }

    /// Nobody is to be started any more.
    pub fn give_up(&mut self) {
        self.due = None;
    }

    /// It can do its work. Returns how long nobody did, in seconds, if it is a successor.
    pub fn gets_ready(&mut self) -> Option<f64> {
        self.vacant.take().map(Stopwatch::seconds)
    }
}

/// An island's fair share of all threads, at least one.
fn threads_of(config: &Config, island: u32) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = config.threads.unwrap_or_else(cores);
    let islands = config.islands as usize;
    (threads / islands + usize::from((island as usize) < threads % islands)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_complaint_is_the_reason_and_neither_a_warning_nor_a_note() {
        let mut state = ProcessState::default();
        for line in ["warning: it waits", "", "thread 'main' panicked at x.rs:1:2:", "no egg"] {
            state.complains(line);
        }
        state.complains("note: run with `RUST_BACKTRACE=1` to display a backtrace");
        assert_eq!(state.take_complaint().as_deref(), Some("no egg"));
        state.complains("warning: it waits");
        assert_eq!(state.take_complaint(), None);
    }

    #[test]
    fn threads_are_shared_out_fairly_and_everybody_gets_one() {
        let shares = |islands, threads| -> Vec<usize> {
            let config = Config { islands, threads: Some(threads), ..Config::default() };
            (0..islands).map(|island| threads_of(&config, island)).collect()
        };
        assert_eq!(shares(4, 10), [3, 3, 2, 2]);
        assert_eq!(shares(3, 1), [1, 1, 1]);
    }
}
