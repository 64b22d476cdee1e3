//! A run under way: its processes are started, watched, started again, and stopped.

use super::child::{Role, Word};
use super::processes::Processes;
use super::restart_policy::{FAILURES_MAX, PAUSE_MAX, PAUSE_MIN};
use super::resume::{self, require_folder};
use super::run_log::RunLog;
use crate::app::args::cli::{OutputArgs, Watching};
use crate::app::console::Stopwatch;
use crate::app::processes::parent_link::{FINISHED, READY, SERVING, StopSignal};
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::runs::summary::BestOnDisk;
use crate::store::RunDir;
use crate::transport::{Domain, ReportReader, ServiceHost};
use std::process::ExitStatus;
use std::time::Duration;

/// The launcher looks about so often, if nobody says anything.
const LOOK: Duration = Duration::from_millis(20);
/// The monitor may film what it has not filmed yet for so long after the islands have finished.
const LAST_REEL: Duration = Duration::from_secs(300);
/// What takes longer is worth a word to the user.
const SOON: Duration = Duration::from_secs(1);
/// Who is asked to stop finishes what it is writing, and if it is quick the generation that it is in.
const LAST_WORDS: Duration = Duration::from_secs(5);

/// Who watches over a run.
pub struct Supervisor<'a, P: Subject> {
    dir: &'a RunDir,
    service_host: &'a ServiceHost<P::Gene>,
    problem: &'a P,
    stop_signal: StopSignal,
    processes: Processes,
    report_reader: ReportReader<P::Gene>,
    best_on_disk: BestOnDisk,
    run_log: RunLog,
    watch: Stopwatch,
    /// Whether a viewer is to be opened.
    opens_viewer: bool,
}

impl<'a, P: Subject> Supervisor<'a, P> {
    /// Starts every process of a run.
    ///
    /// # Errors
    /// If one cannot be started, or the run's log cannot be written.
    pub fn launch(
        problem: &'a P,
        config: &'a Config,
        dir: &'a RunDir,
        domain: &Domain,
        service_host: &'a ServiceHost<P::Gene>,
        stop_signal: StopSignal,
        output: &OutputArgs,
    ) -> Result<Self, Failure> {
        let mut supervisor = Self {
            problem,
            stop_signal,
            processes: Processes::new(dir.clone(), config.clone(), output.view),
            report_reader: ReportReader::open(domain, &config.archipelago())?,
            best_on_disk: BestOnDisk::of::<P::Gene>(dir, config)?,
            run_log: RunLog::open(dir, config, output.quiet)?,
            watch: Stopwatch::start(),
            opens_viewer: output.view.view == Watching::Spawn,
            dir,
            service_host,
        };
        supervisor.run_log.tell(&opening_line(config, P::INHABITANTS, dir));
        for island in 0..config.islands {
            supervisor.processes.start(Role::Island(island))?;
        }
        if output.films() {
            supervisor.processes.start(Role::Monitor)?;
        }
        Ok(supervisor)
    }

    /// Watches over the run until every island has evolved all its generations, and stops the islands. The result
    /// is there then, whatever becomes of the film.
    ///
    /// # Errors
    /// If the user interrupts it, or an island cannot go on; nothing is lost then.
    pub fn see_to_the_end(&mut self) -> Result<(), Failure> {
        let watched = self.watch_over();
        self.run_log.finish();
        if let Err(failure) = &watched {
            self.run_log.note(&failure.message);
        }
        self.stop_islands();
        watched
    }

    /// Lets the monitor film what is left, for a while: for longer if the run is finished.
    pub fn let_film_end(mut self, is_finished: bool) {
        let stop_signal = self.stop_signal.clone();
        let (most, watch) = (if is_finished { LAST_REEL } else { LAST_WORDS }, Stopwatch::start());
        while self.processes.has(Role::Monitor) && !stop_signal.is_urgent() {
            self.let_monitor_end(most.saturating_sub(watch.elapsed()));
        }
    }

    fn watch_over(&mut self) -> Result<(), Failure> {
        while !self.processes.is_finished() {
            self.look()?;
            if self.stop_signal.is_raised() {
                let reached = self.processes.generation();
                let reached =
                    reached.map_or_else(String::new, |g| format!(" after generation {g}"));
                return Err(Failure::interrupted(format!(
                    "interrupted{reached}; nothing is lost; go on with: {}",
                    resume::command(self.dir)
                )));
            }
        }
        Ok(())
    }

    /// Takes in what the others say and report, for a moment, and replaces those that have died.
    fn look(&mut self) -> Result<(), Failure> {
        self.listen(LOOK);
        require_folder(self.dir)?;
        self.take_reports()?;
        // Who dies meanwhile is seen to the next time: so an interruption is heard however often they die.
        self.processes.dead().into_iter().try_for_each(|role| self.replace(role))?;
        self.processes.due().into_iter().try_for_each(|role| self.processes.start(role))
    }

    /// Hears everybody out.
    fn listen(&mut self, within: Duration) {
        let mut word = self.processes.hear(within);
        while let Some((role, what)) = word {
            match what {
                Word::Said(line) => self.heed(role, &line),
                Word::Complained(line) => self.hear_complaint(role, &line),
                Word::Died => self.processes.state(role).dies(),
            }
            word = self.processes.hear(Duration::ZERO);
        }
    }

    fn heed(&mut self, role: Role, line: &str) {
        if line == FINISHED {
            self.processes.state(role).is_finished = true;
        } else if let Some(generation) = line.strip_prefix(READY) {
            self.welcome(role, generation.parse().ok());
        } else if let Some(address) = line.strip_prefix(SERVING) {
            self.processes.state(role).gets_ready();
            self.run_log.tell(&format!("watch it live:  rerun {address}"));
            self.open_viewer(address);
        } else {
            self.run_log.tell(&format!("{role}: {line}"));
        }
    }

    /// Opens a viewer, once, if that is wanted.
    fn open_viewer(&mut self, address: &str) {
        #[cfg(feature = "view")]
        if std::mem::take(&mut self.opens_viewer) {
            crate::app::viewer::open(address.to_owned());
        }
        #[cfg(not(feature = "view"))]
        let _ = (address, self.opens_viewer);
    }

    /// An island can evolve what comes after a generation, none if it begins from the seed.
    fn welcome(&mut self, role: Role, generation: Option<u32>) {
        let state = self.processes.state(role);
        state.generation = generation;
        let after = match generation {
            Some(generation) => format!("after generation {generation}"),
            None => "from the seed".to_owned(),
        };
        if let Some(seconds) = state.gets_ready() {
            self.run_log.tell(&format!("{role} goes on {after}, {seconds:.3} s after its death"));
        } else if generation.is_some() {
            self.run_log.tell(&format!("{role} goes on {after}"));
        }
    }

    fn hear_complaint(&mut self, role: Role, line: &str) {
        self.processes.state(role).complains(line);
        let line = ["warning: ", "error: "]
            .iter()
            .find_map(|kind| line.strip_prefix(kind))
            .unwrap_or(line);
        self.run_log.warn(&format!("{role}: {line}"));
    }

    fn take_reports(&mut self) -> Result<(), Failure> {
        for sighting in self.report_reader.receive() {
            let report = &sighting.report;
            self.processes.state(Role::Island(report.island)).generation = Some(report.generation);
            self.run_log.update(self.problem, &sighting, self.watch.seconds());
            if let Some(champion) = &sighting.champion {
                self.best_on_disk.receive(self.dir, self.problem, champion)?;
            }
        }
        Ok(())
    }

    /// Starts somebody again who has died, unless it would die again.
    fn replace(&mut self, role: Role) -> Result<(), Failure> {
        let Some(status) = self.processes.wait_for_end(role)? else { return Ok(()) };
        // Its last words are here only now.
        self.listen(Duration::ZERO);
        match self.processes.state(role).allows_restart(status) {
            true => self.start_again(role, status)?,
            false if role == Role::Monitor => self.run_log.warn(&format!(
                "the monitor ended {FAILURES_MAX} times ({status}); the run goes on without a film"
            )),
            false => return Err(self.despair(role, status)),
        }
        Ok(())
    }

    fn start_again(&mut self, role: Role, status: ExitStatus) -> Result<(), Failure> {
        let pause = self.processes.state(role).delay();
        match pause {
            Duration::ZERO => {
                self.run_log.warn(&format!("{role} died ({status}); it is started again"));
            }
            PAUSE_MIN => self.run_log.warn(&format!(
                "{role} dies again and again ({status}): from now on it is started again after longer and longer \
                 pauses, up to {} s",
                PAUSE_MAX.as_secs()
            )),
            _ => {}
        }
        if role != Role::Monitor
            && let Err(error) = self.service_host.cleanup_dead_nodes()
        {
            // Its successor may find a place all the same; if not, it says so itself.
            self.run_log.warn(&error.to_string());
        }
        if pause.is_zero() { self.processes.start(role) } else { Ok(()) }
    }

    fn despair(&mut self, role: Role, status: ExitStatus) -> Failure {
        let state = self.processes.state(role);
        let after = match state.generation {
            Some(generation) => format!("after generation {generation}"),
            None => "before it had evolved anything".to_owned(),
        };
        let complaint = state.take_complaint();
        let words = complaint.map_or_else(String::new, |words| {
            format!(", saying “{}”", words.strip_prefix("error: ").unwrap_or(&words))
        });
        Failure::failed(format!(
            "{role} ended by itself {FAILURES_MAX} times {after} ({status}){words}"
        ))
    }

    /// Asks the islands to stop, and waits for them.
    fn stop_islands(&mut self) {
        let stop_signal = self.stop_signal.clone();
        let is_island = |role| role != Role::Monitor;
        self.processes.ask_to_stop(is_island);
        self.processes.await_end(is_island, LAST_WORDS, || stop_signal.is_urgent());
        self.processes.kill(is_island);
    }

    /// The monitor films what is left; if it dies over it, another one does.
    fn let_monitor_end(&mut self, most: Duration) {
        let stop_signal = self.stop_signal.clone();
        if self.processes.state(Role::Monitor).is_awaited() {
            return self.await_next_monitor(most);
        }
        let is_monitor = |role| role == Role::Monitor;
        self.processes.ask_to_stop(is_monitor);
        let is_quick = self.processes.await_end(is_monitor, SOON, || stop_signal.is_urgent());
        if !is_quick {
            self.run_log.tell(match P::HAS_BODIES {
                true => "the monitor films the last champions …",
                false => "the monitor records the last generations …",
            });
        }
        if !is_quick && !self.processes.await_end(is_monitor, most, || stop_signal.is_urgent()) {
            self.run_log.warn("the monitor was still filming and was stopped; the film has gaps");
            return self.processes.kill(is_monitor);
        }
        let Ok(Some(status)) = self.processes.wait_for_end(Role::Monitor) else { return };
        self.listen(Duration::ZERO);
        let fails = !status.success();
        if fails && self.processes.state(Role::Monitor).allows_restart(status) {
            if let Err(failure) = self.start_again(Role::Monitor, status) {
                self.run_log.warn(&failure.message);
            }
        } else if fails {
            self.run_log.warn(&format!("the monitor failed ({status}); the film has gaps"));
        }
    }

    /// Starts a monitor that was to be started after a pause, when that is over.
    fn await_next_monitor(&mut self, most: Duration) {
        if most.is_zero() {
            self.run_log.warn("the monitor died again and again; the film has gaps");
            return self.processes.state(Role::Monitor).give_up();
        }
        std::thread::sleep(LOOK);
        if self.processes.due().contains(&Role::Monitor)
            && let Err(failure) = self.processes.start(Role::Monitor)
        {
            self.run_log.warn(&failure.message);
            self.processes.state(Role::Monitor).give_up();
        }
    }
}

/// What a run begins with.
fn opening_line(config: &Config, inhabitants: &str, dir: &RunDir) -> String {
    let Config { islands, population, generations, seed, .. } = config;
    format!(
        "{islands} islands × {population} {inhabitants} evolve for {generations} generations, seed {}, in {}",
        seed.unwrap_or_default(),
        dir.path().display()
    )
}
