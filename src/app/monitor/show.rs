//! When what the islands of a run wrote down is shown, and when that is over.

use super::super::Failure;
use super::super::cli::MonitorArgs;
use super::super::config::Config;
use super::super::console::{print, say};
use super::super::kinship::{Ear, SERVING, tell};
use super::super::result;
use super::cinema::Cinema;
use super::logs::Logs;
use crate::store::RunDir;
use crate::view::Live;
use std::fs::{File, TryLockError};
use std::time::Duration;

/// The monitor looks about so often.
const LOOK: Duration = Duration::from_millis(20);
/// How much the monitor stands back behind the islands: filming must not cost them evaluations.
const NICENESS: i32 = 10;
/// The rounds of generations that are shown before a full disk is noticed and a viewer gets to see them.
const BATCH: usize = 64;

/// Shows a run, as [`super::run`] says.
///
/// # Errors
/// The same.
pub fn run(args: &MonitorArgs) -> Result<(), Failure> {
    let ear = match args.parent {
        Some(parent) => Ear::to(parent)?,
        None => Ear::to_signals()?,
    };
    // Standing back is a courtesy: where it is not to be had, filming goes on.
    let _ = rustix::process::nice(NICENESS);
    let dir = RunDir::at(&args.dir);
    let config = Config::of_run(&dir)?;
    let launched = args.parent.is_some();
    let Some(_turn) = await_turn(&dir, launched, &ear)? else { return Ok(()) };
    // Nobody has the time to attach to a run that is over.
    let live = (launched || dir.is_under_way()?)
        .then(|| Live { address: args.view_address, ..Live::default() });
    let folder = if launched { dir.partial() } else { dir.path().to_owned() };
    let cinema = Cinema::open(&folder, &dir.recording(), live, &config)?;
    match cinema.address() {
        Some(address) if launched => tell(&format!("{SERVING}{address}")),
        Some(address) => print(&format!("watch it live:  rerun {address}")),
        None => {}
    }
    let logs = Logs::of(&dir, config.islands);
    Show { dir, config, launched, ear, logs, cinema }.run()
}

/// One monitor at a time films a run, as long as it holds what this returns; none if it was stopped while
/// another one was still at it. Who was stopped before it began films all the same: it came late.
fn await_turn(dir: &RunDir, launched: bool, ear: &Ear) -> Result<Option<File>, Failure> {
    let mut folder = dir.champions(0);
    folder.pop();
    let failed = |error| Failure::failed(format!("cannot use {}: {error}", folder.display()));
    let file = File::open(&folder).map_err(failed)?;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::Error(error)) => return Err(failed(error)),
            Err(TryLockError::WouldBlock) if ear.heard_stop() => return Ok(None),
            Err(TryLockError::WouldBlock) if launched => std::thread::sleep(LOOK),
            Err(TryLockError::WouldBlock) => {
                let path = dir.path().display();
                return Err(Failure::usage(format!("another monitor records {path} already")));
            }
        }
    }
}

/// A run that is being shown.
struct Show {
    dir: RunDir,
    config: Config,
    launched: bool,
    ear: Ear,
    logs: Logs,
    cinema: Cinema,
}

impl Show {
    fn run(mut self) -> Result<(), Failure> {
        let mut last = false;
        loop {
            if self.look()? {
                continue;
            }
            if last {
                return self.end();
            }
            // What was written before this is read after it.
            last = self.ear.heard_stop() || !(self.launched || self.dir.is_under_way()?);
            if !last {
                self.cinema.publish()?;
                std::thread::sleep(LOOK);
            }
        }
    }

    /// Shows what is there, or a part of it; whether there was something.
    fn look(&mut self) -> Result<bool, Failure> {
        for round in 0..BATCH {
            let sightings = self.logs.next_round();
            if sightings.is_empty() {
                self.cinema.flush()?;
                return Ok(round > 0);
            }
            sightings.iter().try_for_each(|sighting| self.cinema.show(sighting))?;
        }
        self.cinema.flush()?;
        Ok(true)
    }

    /// Everything was read.
    fn end(self) -> Result<(), Failure> {
        let Self { dir, config, launched, logs, cinema, .. } = self;
        if launched {
            return cinema.finish();
        }
        let (folder, recording) = (dir.path().display(), dir.recording());
        if !cinema.has_shown() {
            return Err(Failure::failed(format!("there is nothing to film in {folder} yet")));
        }
        let is_over = result::finished(&dir, &config).is_some();
        let short = logs.first_short_of(config.generations).filter(|_| is_over);
        if let Some((island, generations)) = short {
            let news = format!(
                "the run in {folder} is over, but the logs of island {island} hold only the first \
                 {generations} of its {} generations",
                config.generations + 1
            );
            if recording.exists() {
                let news = format!("{news}; {} is left as it was", recording.display());
                return Err(Failure::failed(news));
            }
            say(&format!("warning: {news}"));
        }
        cinema.finish()?;
        print(&format!("view it:  rerun {}", recording.display()));
        Ok(())
    }
}
