//! When what the islands of a run wrote down is shown, and when that is over.

use super::film_recorder::FilmRecorder;
use super::logs::Logs;
use crate::app::args::cli::{MonitorArgs, Watching};
use crate::app::console::{Stopwatch, print, say};
use crate::app::processes::parent_link::{SERVING, StopSignal, tell};
use crate::app::viewer;
use crate::evolution::Gene;
use crate::runs::Failure;
use crate::runs::catalogue::Visitor;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::store::{Checkpoints, RunDir, file};
use crate::view::Live;
use std::fs::{File, TryLockError};
use std::time::Duration;

/// The monitor looks about so often.
const LOOK: Duration = Duration::from_millis(20);
/// How much the monitor stands back behind the islands: filming must not cost them evaluations.
const NICENESS: i32 = 19;
/// While the islands work, the monitor rests for so many times the time that it has computed: it takes about 5 %
/// of a core, even where a core is idle.
const REST: f64 = 19.0;
/// The rounds of generations that are shown before a full disk is noticed and a viewer gets to see them.
const BATCH: usize = 16;

/// Shows a run, as [`super::run`] says.
///
/// # Errors
/// The same.
pub fn run(args: &MonitorArgs) -> Result<(), Failure> {
    let stop_signal = match args.parent {
        Some(parent) => StopSignal::from_parent(parent)?,
        None => StopSignal::from_signals()?,
    };
    // Standing back is a courtesy: where it is not to be had, filming goes on.
    let _ = rustix::process::nice(NICENESS);
    let dir = RunDir::at(&args.dir);
    let config = Config::of_run(&dir)?;
    config.visit(Projection { args, dir, config: &config, stop_signal })
}

/// A run that is to be shown.
struct Projection<'a> {
    args: &'a MonitorArgs,
    dir: RunDir,
    config: &'a Config,
    stop_signal: StopSignal,
}

impl Visitor for Projection<'_> {
    type Output = Result<(), Failure>;

    fn visit<P: Subject>(self, problem: P) -> Result<(), Failure> {
        self.show(problem)
    }
}

impl Projection<'_> {
    fn show<P: Subject>(self, problem: P) -> Result<(), Failure> {
        let Self { args, dir, config, stop_signal } = self;
        let launched = args.parent.is_some();
        let Some(_turn) = await_turn(&dir, launched, &stop_signal)? else { return Ok(()) };
        // Nobody has the time to attach to a run that is over.
        let is_watched = args.view.view != Watching::Off && (launched || dir.is_under_way()?);
        let live = is_watched.then(|| Live {
            address: args.view.view_address,
            port: args.view.view_port.unwrap_or(Live::default().port),
            ..Live::default()
        });
        let folder = if launched { dir.partial() } else { dir.path().to_owned() };
        let film_recorder =
            FilmRecorder::open(&folder, &dir, live, config, problem, args.clip_every)?;
        if let (Some(wanted), Some(port)) = (args.view.view_port, film_recorder.port())
            && wanted != port
        {
            say(&format!(
                "warning: port {wanted} is taken; the live view is served on port {port}"
            ));
        }
        match film_recorder.address() {
            Some(address) if launched => tell(&format!("{SERVING}{address}")),
            Some(address) => {
                print(&format!("watch it live:  rerun {address}"));
                if args.view.view == Watching::Spawn {
                    viewer::open(address);
                }
            }
            None => {}
        }
        let logs = Logs::of(&dir, config.islands);
        Show {
            dir,
            config: config.clone(),
            launched,
            stop_signal,
            logs,
            film_recorder,
            is_published: false,
        }
        .run()
    }
}

/// One monitor at a time films a run, as long as it holds what this returns; none if it was stopped while
/// another one was still at it. Who was stopped before it began films all the same: it came late.
fn await_turn(
    dir: &RunDir,
    launched: bool,
    stop_signal: &StopSignal,
) -> Result<Option<File>, Failure> {
    let mut folder = dir.champions(0);
    folder.pop();
    let failed = |error| Failure::failed(format!("cannot use {}: {error}", folder.display()));
    let file = file::open_folder(&folder)?;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::Error(error)) => return Err(failed(error)),
            Err(TryLockError::WouldBlock) if stop_signal.is_raised() => return Ok(None),
            Err(TryLockError::WouldBlock) if launched => std::thread::sleep(LOOK),
            Err(TryLockError::WouldBlock) => {
                let path = dir.path().display();
                return Err(Failure::usage(format!("another monitor records {path} already")));
            }
        }
    }
}

/// A run that is being shown.
struct Show<P: Subject> {
    dir: RunDir,
    config: Config,
    launched: bool,
    stop_signal: StopSignal,
    logs: Logs<P::Gene>,
    film_recorder: FilmRecorder<P>,
    /// Whether the recording that is in its place is this one.
    is_published: bool,
}

impl<P: Subject> Show<P> {
    fn run(mut self) -> Result<(), Failure> {
        let mut last = false;
        loop {
            if !self.launched && self.stop_signal.is_raised() {
                return self.break_off();
            }
            let began_s = cpu_s();
            if self.look()? {
                // A recording that replaces none has nothing to wait for, while the islands may long be ahead.
                if self.is_under_way()? && !self.dir.recording().exists() {
                    self.publish()?;
                }
                self.rest(REST * (cpu_s() - began_s))?;
                continue;
            }
            if last {
                return self.end();
            }
            // What was written before this is read after it.
            last = self.stop_signal.is_raised() || !self.is_under_way()?;
            if !last {
                self.publish()?;
                std::thread::sleep(LOOK);
            }
        }
    }

    /// Leaves the cores to the islands for a while, unless they have ended.
    fn rest(&self, seconds: f64) -> Result<(), Failure> {
        let watch = Stopwatch::start();
        while watch.seconds() < seconds && !self.stop_signal.is_raised() && self.is_under_way()? {
            std::thread::sleep(LOOK);
        }
        Ok(())
    }

    fn is_under_way(&self) -> Result<bool, Failure> {
        Ok(self.launched || self.dir.is_under_way()?)
    }

    /// Shows what is there, or a part of it; whether there was something.
    fn look(&mut self) -> Result<bool, Failure> {
        for round in 0..BATCH {
            let sightings = self.logs.next_round();
            if sightings.is_empty() {
                self.film_recorder.flush()?;
                return Ok(round > 0);
            }
            sightings.iter().try_for_each(|sighting| self.film_recorder.show(sighting))?;
        }
        self.film_recorder.flush()?;
        Ok(true)
    }

    /// Somebody has seen enough: the film ends with what was shown, but does not replace one that was there.
    fn break_off(self) -> Result<(), Failure> {
        let recording = self.dir.recording();
        if recording.exists() && !self.is_published {
            let news = format!("interrupted; {} is left as it was", recording.display());
            return Err(Failure::interrupted(news));
        }
        if !self.film_recorder.has_shown() {
            return Err(Failure::interrupted("interrupted before there was anything to film"));
        }
        self.film_recorder.finish()?;
        print(&format!("view it, as far as it was shown:  rerun {}", recording.display()));
        Ok(())
    }

    fn publish(&mut self) -> Result<(), Failure> {
        self.film_recorder.publish()?;
        self.is_published = self.film_recorder.has_shown();
        Ok(())
    }

    /// Everything was read.
    fn end(self) -> Result<(), Failure> {
        let Self { dir, config, launched, logs, film_recorder, .. } = self;
        if launched {
            return film_recorder.finish();
        }
        let (folder, recording) = (dir.path().display(), dir.recording());
        if !film_recorder.has_shown() {
            return Err(Failure::failed(format!("there is nothing to film in {folder} yet")));
        }
        if let Some((island, generations, saved)) = first_short(&dir, &config, &logs) {
            let news = format!(
                "the run in {folder} has come to generation {saved} of island {island}, whose logs hold only the first \
                 {generations} of its {} generations",
                saved + 1
            );
            if recording.exists() {
                let news = format!("{news}; {} is left as it was", recording.display());
                return Err(Failure::failed(news));
            }
            say(&format!("warning: {news}"));
        }
        film_recorder.finish()?;
        print(&format!("view it:  rerun {}", recording.display()));
        Ok(())
    }
}

/// The first island whose film is shorter than what was evolved of it: how many generations were shown, and the last one
/// whose state was saved, whether that is whole or not.
fn first_short<G: Gene>(dir: &RunDir, config: &Config, logs: &Logs<G>) -> Option<(u32, u32, u32)> {
    for (island, shown) in (0..config.islands).zip(logs.shown()) {
        // An island that never got so far has no folder of them.
        let saved =
            Checkpoints::of(dir, island).generations().unwrap_or_default().into_iter().max();
        if let Some(saved) = saved.filter(|&saved| shown <= saved) {
            return Some((island, shown, saved));
        }
    }
    None
}

/// The time that this process has computed for, all threads together, in seconds; 0 where the system does not
/// tell.
fn cpu_s() -> f64 {
    /// Of the kernel's clock, which it has shown in these units for ever.
    const TICKS_PER_S: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The second field, the program's name, may hold anything; it ends with the last parenthesis. Of what
    // follows, fields 12 and 13 are the times in the program and in the kernel.
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / TICKS_PER_S
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_that_was_computed_for_is_counted() {
        let (began_s, watch) = (cpu_s(), Stopwatch::start());
        let mut sum = 0_u64;
        while cpu_s() - began_s < 0.03 && watch.seconds() < 60.0 {
            sum = std::hint::black_box(sum + 1);
        }
        assert!(cpu_s() - began_s >= 0.03, "{sum}");
    }
}
