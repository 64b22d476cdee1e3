//! What happens in a run: told on the terminal, and kept in the run's log.

use super::progress::Progress;
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::store::{RunDir, file};
use crate::transport::Sighting;
use std::sync::Mutex;
use tracing::Dispatch;
use tracing::dispatcher::with_default;

/// The teller of one run.
pub struct RunLog {
    progress: Progress,
    log: Dispatch,
}

impl RunLog {
    /// Goes on with the log of the run in `dir`.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn open(dir: &RunDir, config: &Config, quiet: bool) -> Result<Self, Failure> {
        let log = tracing_subscriber::fmt()
            .with_writer(Mutex::new(file::open_to_append(&dir.log())?))
            // A full disk is noticed by those who write what matters.
            .log_internal_errors(false)
            .with_target(false)
            .with_ansi(false)
            .finish();
        Ok(Self { progress: Progress::new(config, quiet), log: Dispatch::new(log) })
    }

    /// Something that the user wants to know.
    pub fn tell(&self, line: &str) {
        self.progress.say(line);
        self.note(line);
    }

    /// Something that the user must know.
    pub fn warn(&self, line: &str) {
        self.progress.insist(&format!("warning: {line}"));
        with_default(&self.log, || tracing::warn!("{line}"));
    }

    /// Something for the log alone.
    pub fn note(&self, line: &str) {
        with_default(&self.log, || tracing::info!("{line}"));
    }

    /// Shows how far an island has got, `seconds` after the start.
    pub fn update<P: Subject>(&mut self, problem: &P, sighting: &Sighting<P::Gene>, seconds: f64) {
        self.progress.update(problem, sighting, seconds);
    }

    /// Nothing evolves any more.
    pub fn finish(&self) {
        self.progress.finish();
    }
}
