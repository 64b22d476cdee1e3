//! `islands run`: starts the processes of a run, shows their progress, gathers their result.

use super::cli::RunArgs;
use super::config::Config;
use super::console::{Stopwatch, print, say};
use super::kinship::{CAUGHT_UP, Ear, FINISHED, Kin, SERVING};
use super::progress::Progress;
use super::result::{self, Podium, Summary};
use super::{Failure, config};
use crate::creature::Gene;
use crate::problems::Locomotion;
use crate::store::RunDir;
use crate::transport::{Domain, Harbour, Lookout};
use rand::TryRng;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// The launcher looks about so often.
const LOOK: Duration = Duration::from_millis(20);
/// Islands that have finished wait for so long until the monitor has their last reports.
const LAST_LOOK: Duration = Duration::from_secs(30);
/// The monitor may film what it has not filmed yet for so long after the islands have finished.
const LAST_REEL: Duration = Duration::from_secs(300);
/// What takes longer is worth a word to the user.
const SOON: Duration = Duration::from_secs(1);
/// Islands that are asked to stop finish the generation that they are in; for so long.
const LAST_WORDS: Duration = Duration::from_secs(60);

/// Runs a run from its first process to its result.
///
/// # Errors
/// With exit code 2, before anything was made, if what was asked for is impossible; with 1 if the run
/// failed; with 130 if it was interrupted.
pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let domain = Domain::new(entropy()?);
    let config = resolve(args, &domain)?;
    let ear = Ear::to_signals()?;
    let harbour = Harbour::<Gene>::create(&domain, &config.archipelago())?;
    let dir = run_dir(args.out.as_deref(), &config);
    let elsewhere = |error| Failure::usage(format!("{error}; choose another folder with --out"));
    let claim = dir.create(config.islands).map_err(elsewhere)?;
    dir.write(&dir.config(), |out| out.write_all(config.to_toml().as_bytes()))?;

    let mut run = Run::start(args, config, dir, &domain, ear)?;
    let watched = run.watch_over();
    run.progress.finish();
    run.stop();
    let summary = watched.and_then(|()| run.gather());
    drop(run);
    harbour.close()?;
    drop(claim);
    let summary = summary?;
    if args.json {
        let json = serde_json::to_string(&summary);
        print(&json.expect("a summary is plain data, its numbers finite"));
    } else {
        show(&summary);
    }
    Ok(())
}

/// The complete configuration: flags over a file over defaults, with a seed.
fn resolve(args: &RunArgs, domain: &Domain) -> Result<Config, Failure> {
    let mut config = match &args.config {
        Some(path) => args.over(Config::read(path)?),
        None => args.over(Config::default()),
    };
    config.check()?;
    if config.seed.is_none() {
        // Half of it is entropy enough, and a number that people can copy.
        config.seed = Some(entropy()? >> 32);
    }
    config.launch = Some(config::Launch {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        run_id: domain.to_string(),
    });
    Ok(config)
}

/// A run under way.
struct Run {
    config: Config,
    problem: Locomotion,
    dir: RunDir,
    ear: Ear,
    islands: Vec<Kin>,
    monitor: Option<Kin>,
    /// Whether the monitor has the last report of every island.
    monitor_caught_up: bool,
    lines: Receiver<(String, String)>,
    lookout: Lookout<Gene>,
    podium: Podium,
    progress: Progress,
    watch: Stopwatch,
    finished: usize,
}

impl Run {
    fn start(
        args: &RunArgs,
        config: Config,
        dir: RunDir,
        domain: &Domain,
        ear: Ear,
    ) -> Result<Self, Failure> {
        let lookout = Lookout::open(domain, &config.archipelago())?;
        let progress = Progress::new(&config, args.quiet);
        progress.say(&format!(
            "{} islands × {} creatures evolve for {} generations, seed {}, in {}",
            config.islands,
            config.population,
            config.generations,
            config.seed.unwrap_or_default(),
            dir.path().display()
        ));
        let (sender, lines) = channel();
        let watch = Stopwatch::start();
        let islands = (0..config.islands)
            .map(|island| start_island(&dir, &config, island, &sender))
            .collect::<Result<_, _>>()?;
        let watched = cfg!(feature = "view") && !args.no_monitor;
        let monitor = watched.then(|| start_monitor(&dir, &sender)).transpose()?;
        Ok(Self {
            problem: config.problem(),
            podium: Podium::new(),
            finished: 0,
            config,
            dir,
            ear,
            islands,
            monitor,
            monitor_caught_up: false,
            lines,
            lookout,
            progress,
            watch,
        })
    }

    /// Waits until every island has finished.
    fn watch_over(&mut self) -> Result<(), Failure> {
        while self.finished < self.islands.len() {
            self.look()?;
            if self.ear.heard_stop() {
                return Err(Failure::interrupted(format!(
                    "interrupted; what was recorded so far is in {}",
                    self.dir.path().display()
                )));
            }
            self.miss_monitor();
            for island in &mut self.islands {
                if let Some(status) = island.ended() {
                    return Err(Failure::failed(format!(
                        "{} ended before its time ({status}); the run stops, and what was recorded so \
                         far is in {}",
                        island.name(),
                        self.dir.path().display()
                    )));
                }
            }
        }
        self.await_monitor()
    }

    /// Waits until the monitor has what the islands reported: one that starts more slowly than they evolve
    /// would find them gone, and have nothing to film.
    fn await_monitor(&mut self) -> Result<(), Failure> {
        let watch = Stopwatch::start();
        let is_behind = |run: &Self| run.monitor.is_some() && !run.monitor_caught_up;
        while is_behind(self) && watch.elapsed() < LAST_LOOK && !self.ear.heard_stop() {
            self.look()?;
            self.miss_monitor();
        }
        Ok(())
    }

    /// A run goes on without its monitor, but not without a word.
    fn miss_monitor(&mut self) {
        if let Some(status) = self.monitor.as_mut().and_then(Kin::ended) {
            self.monitor = None;
            say(&format!("warning: the monitor ended ({status}); the run goes on without a film"));
        }
    }

    /// Takes in what islands and monitor report, for a moment.
    fn look(&mut self) -> Result<(), Failure> {
        if let Ok((name, line)) = self.lines.recv_timeout(LOOK) {
            if line == FINISHED {
                self.finished += 1;
            } else if line == CAUGHT_UP {
                self.monitor_caught_up = true;
            } else if let Some(address) = line.strip_prefix(SERVING) {
                self.progress.say(&format!("watch it live:  rerun {address}"));
            } else {
                self.progress.say(&format!("{name}: {line}"));
            }
        }
        for sighting in self.lookout.receive() {
            self.progress.update(&self.problem, &sighting.report, self.watch.seconds());
            if let Some(champion) = &sighting.champion {
                self.podium.receive(&self.dir, &self.problem, champion)?;
            }
        }
        Ok(())
    }

    fn gather(&self) -> Result<Summary, Failure> {
        result::gather(&self.dir, &self.config)
    }

    /// Asks everybody to stop, and waits for them; who does not is killed when it is dropped.
    fn stop(&mut self) {
        self.islands.iter_mut().for_each(Kin::ask_to_stop);
        wait_for(&mut self.islands, LAST_WORDS);
        let Some(mut monitor) = self.monitor.take() else { return };
        monitor.ask_to_stop();
        wait_for(std::slice::from_mut(&mut monitor), SOON);
        if monitor.ended().is_none() {
            self.progress.say("the monitor films the last champions …");
        }
        wait_for(std::slice::from_mut(&mut monitor), LAST_REEL);
        match monitor.ended() {
            Some(status) if status.success() => {}
            Some(status) => {
                say(&format!("warning: the monitor failed ({status}); the film has gaps"))
            }
            None => {
                say("warning: the monitor was still filming and was stopped; the film has gaps")
            }
        }
    }
}

fn wait_for(kin: &mut [Kin], most: Duration) {
    let watch = Stopwatch::start();
    while kin.iter_mut().any(|kin| kin.ended().is_none()) && watch.elapsed() < most {
        std::thread::sleep(LOOK);
    }
}

fn start_island(
    dir: &RunDir,
    config: &Config,
    island: u32,
    lines: &Sender<(String, String)>,
) -> Result<Kin, Failure> {
    let arguments = [
        "island".to_owned(),
        dir.path().display().to_string(),
        format!("--index={island}"),
        format!("--threads={}", threads_of(config, island)),
        format!("--parent={}", std::process::id()),
    ];
    Kin::start(&format!("island {island}"), &arguments, lines.clone())
}

fn start_monitor(dir: &RunDir, lines: &Sender<(String, String)>) -> Result<Kin, Failure> {
    let arguments = [
        "monitor".to_owned(),
        dir.path().display().to_string(),
        format!("--parent={}", std::process::id()),
    ];
    Kin::start("monitor", &arguments, lines.clone())
}

/// An island's fair share of all threads, at least one.
fn threads_of(config: &Config, island: u32) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = config.threads.unwrap_or_else(cores);
    let islands = config.islands as usize;
    (threads / islands + usize::from((island as usize) < threads % islands)).max(1)
}

/// The folder that was asked for, or a new one under `runs` that says what is in it.
fn run_dir(out: Option<&Path>, config: &Config) -> RunDir {
    if let Some(out) = out {
        return RunDir::at(out);
    }
    let name = format!("{}-seed{}", config.task, config.seed.unwrap_or_default());
    let free = |path: &PathBuf| !path.exists();
    let first = Path::new("runs").join(&name);
    let next = (2..).map(|i| Path::new("runs").join(format!("{name}-{i}")));
    RunDir::at(
        std::iter::once(first).chain(next).find(free).expect("there is always a next number"),
    )
}

fn entropy() -> Result<u64, Failure> {
    rand::rngs::SysRng
        .try_next_u64()
        .map_err(|error| Failure::failed(format!("the system has no randomness: {error}")))
}

fn show(summary: &Summary) {
    print(&format!(
        "best     {}, island {}\nfound in {} evaluations, {:.1} a second\ndigest   {}\nfiles    {}\n\
         film     islands replay {} --task {} --profile {} --out champion.rrd",
        summary.best,
        summary.best_island,
        summary.evaluations,
        summary.evaluations_per_second,
        summary.digest,
        summary.run_dir.display(),
        summary.best_genome.display(),
        summary.task,
        summary.profile,
    ));
    if let Some(recording) = &summary.recording {
        print(&format!("view     rerun {}", recording.display()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
