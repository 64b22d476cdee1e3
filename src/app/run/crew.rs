//! The processes of a run: who they are, what is known of each, and how one is started again.

use super::super::Failure;
use super::super::cli::{ViewArgs, Watching};
use super::super::config::Config;
use super::super::console::Stopwatch;
use super::kin::{Kin, Role, Word};
use super::mortality::Deaths;
use crate::store::RunDir;
use std::collections::BTreeMap;
use std::process::ExitStatus;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// How often is looked whether somebody has ended.
const LOOK: Duration = Duration::from_millis(20);

/// All processes of a run but the launcher.
pub struct Crew {
    dir: RunDir,
    config: Config,
    view: ViewArgs,
    posts: BTreeMap<Role, Post>,
    sender: Sender<(Role, Word)>,
    words: Receiver<(Role, Word)>,
}

/// What is known of one of them, and of those that came before it.
#[derive(Default)]
pub struct Post {
    kin: Option<Kin>,
    /// Whether it has died, or will in a moment, and was not buried.
    has_fallen: bool,
    deaths: Deaths,
    /// Since the one before it was found dead, until it is ready to do its work.
    vacant: Option<Stopwatch>,
    /// The last thing that it complained of, but for warnings.
    complaint: Option<String>,
    /// The last generation that it has evolved.
    pub generation: Option<u32>,
    /// Whether it has done all its work.
    pub is_finished: bool,
}

impl Crew {
    /// A crew of nobody.
    pub fn new(dir: RunDir, config: Config, view: ViewArgs) -> Self {
        let (sender, words) = channel();
        Self { dir, config, view, posts: BTreeMap::new(), sender, words }
    }

    /// Starts the process for a role, the first or the next.
    ///
    /// # Errors
    /// If no process can be started.
    pub fn start(&mut self, role: Role) -> Result<(), Failure> {
        let kin = Kin::start(role, &self.arguments(role), &self.sender)?;
        let post = self.posts.entry(role).or_default();
        post.kin = Some(kin);
        post.has_fallen = false;
        post.is_finished = false;
        post.complaint = None;
        Ok(())
    }

    /// What somebody says, if anybody does before the time is over.
    pub fn hear(&self, within: Duration) -> Option<(Role, Word)> {
        self.words.recv_timeout(within).ok()
    }

    /// What is known of a role.
    pub fn post(&mut self, role: Role) -> &mut Post {
        self.posts.entry(role).or_default()
    }

    /// Those who have died, or will in a moment, and were not buried.
    pub fn fallen(&self) -> Vec<Role> {
        let fallen = self.posts.iter().filter(|(_, post)| post.has_fallen);
        fallen.map(|(role, _)| *role).collect()
    }

    /// Whether every island has evolved all its generations.
    pub fn is_finished(&self) -> bool {
        self.islands().all(|post| post.is_finished)
    }

    /// The last generation that every island has evolved.
    pub fn generation(&self) -> Option<u32> {
        self.islands().map(|post| post.generation).min().flatten()
    }

    /// Whether there is a process for a role.
    pub fn has(&self, role: Role) -> bool {
        self.posts.get(&role).is_some_and(|post| post.kin.is_some())
    }

    /// Waits for the end of one that has fallen, and until all that it said can be heard. Nothing if it was
    /// buried already.
    ///
    /// # Errors
    /// If it cannot be waited for.
    pub fn bury(&mut self, role: Role) -> Result<Option<ExitStatus>, Failure> {
        let post = self.post(role);
        post.has_fallen = false;
        let Some(kin) = post.kin.take() else { return Ok(None) };
        post.vacant = Some(Stopwatch::start());
        kin.bury().map(Some)
    }

    /// Asks those in the roles that are meant to stop.
    pub fn ask_to_stop(&mut self, is_meant: impl Fn(Role) -> bool) {
        self.kin(is_meant).filter_map(Option::as_mut).for_each(Kin::ask_to_stop);
    }

    /// Waits until they have ended, for `most`, unless there is a hurry. Returns whether they have.
    pub fn await_end(
        &mut self,
        is_meant: impl Fn(Role) -> bool,
        most: Duration,
        in_a_hurry: impl Fn() -> bool,
    ) -> bool {
        let watch = Stopwatch::start();
        while self.kin(&is_meant).filter_map(Option::as_mut).any(Kin::is_alive) {
            if watch.elapsed() > most || in_a_hurry() {
                return false;
            }
            std::thread::sleep(LOOK);
        }
        true
    }

    /// Kills those of them who live, and waits for their end.
    pub fn kill(&mut self, is_meant: impl Fn(Role) -> bool) {
        self.kin(is_meant).for_each(|kin| drop(kin.take()));
    }

    fn kin(&mut self, is_meant: impl Fn(Role) -> bool) -> impl Iterator<Item = &mut Option<Kin>> {
        let posts = self.posts.iter_mut();
        posts.filter(move |(role, _)| is_meant(**role)).map(|(_, post)| &mut post.kin)
    }

    fn islands(&self) -> impl Iterator<Item = &Post> {
        self.posts.iter().filter(|(role, _)| **role != Role::Monitor).map(|(_, post)| post)
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

impl Post {
    /// It has died, or will in a moment.
    pub fn falls(&mut self) {
        self.has_fallen = true;
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
    pub fn leave_hope(&mut self, status: ExitStatus) -> bool {
        self.deaths.leave_hope(status, self.generation)
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
        let mut post = Post::default();
        for line in ["warning: it waits", "", "thread 'main' panicked at x.rs:1:2:", "no egg"] {
            post.complains(line);
        }
        post.complains("note: run with `RUST_BACKTRACE=1` to display a backtrace");
        assert_eq!(post.take_complaint().as_deref(), Some("no egg"));
        post.complains("warning: it waits");
        assert_eq!(post.take_complaint(), None);
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
