//! A run under way: its processes are started, watched, started again, and stopped.

use super::super::Failure;
use super::super::cli::{OutputArgs, Watching};
use super::super::config::Config;
use super::super::console::Stopwatch;
use super::super::kinship::{Ear, FINISHED, READY, SERVING};
use super::super::result::Podium;
use super::super::subject::Subject;
use super::chronicle::Chronicle;
use super::crew::Crew;
use super::kin::{Role, Word};
use super::mortality::DEATHS_MAX;
use super::resume::{self, require_folder};
use crate::store::RunDir;
use crate::transport::{Domain, Harbour, Lookout};
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
    harbour: &'a Harbour<P::Gene>,
    problem: &'a P,
    ear: Ear,
    crew: Crew,
    lookout: Lookout<P::Gene>,
    podium: Podium,
    chronicle: Chronicle,
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
        harbour: &'a Harbour<P::Gene>,
        ear: Ear,
        output: &OutputArgs,
    ) -> Result<Self, Failure> {
        let mut supervisor = Self {
            problem,
            ear,
            crew: Crew::new(dir.clone(), config.clone(), output.view),
            lookout: Lookout::open(domain, &config.archipelago())?,
            podium: Podium::of::<P::Gene>(dir, config)?,
            chronicle: Chronicle::open(dir, config, output.quiet)?,
            watch: Stopwatch::start(),
            opens_viewer: output.view.view == Watching::Spawn,
            dir,
            harbour,
        };
        supervisor.chronicle.tell(&overture(config, P::INHABITANTS, dir));
        for island in 0..config.islands {
            supervisor.crew.start(Role::Island(island))?;
        }
        if cfg!(feature = "view") && !output.no_monitor {
            supervisor.crew.start(Role::Monitor)?;
        }
        Ok(supervisor)
    }

    /// Watches over the run until every island has evolved all its generations, and stops everybody.
    ///
    /// # Errors
    /// If the user interrupts it, or an island cannot go on; nothing is lost then.
    pub fn see_to_the_end(mut self) -> Result<(), Failure> {
        let watched = self.watch_over();
        self.chronicle.finish();
        if let Err(failure) = &watched {
            self.chronicle.note(&failure.message);
        }
        self.stop(watched.is_ok());
        watched
    }

    fn watch_over(&mut self) -> Result<(), Failure> {
        while !self.crew.is_finished() {
            self.look()?;
            if self.ear.heard_stop() {
                let reached = self.crew.generation();
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
        // Who falls meanwhile is seen to the next time: so an interruption is heard however often they die.
        self.crew.fallen().into_iter().try_for_each(|role| self.replace(role))
    }

    /// Hears everybody out.
    fn listen(&mut self, within: Duration) {
        let mut word = self.crew.hear(within);
        while let Some((role, what)) = word {
            match what {
                Word::Said(line) => self.heed(role, &line),
                Word::Complained(line) => self.hear_complaint(role, &line),
                Word::Fell => self.crew.post(role).falls(),
            }
            word = self.crew.hear(Duration::ZERO);
        }
    }

    fn heed(&mut self, role: Role, line: &str) {
        if line == FINISHED {
            self.crew.post(role).is_finished = true;
        } else if let Some(generation) = line.strip_prefix(READY) {
            self.welcome(role, generation.parse().ok());
        } else if let Some(address) = line.strip_prefix(SERVING) {
            self.crew.post(role).gets_ready();
            self.chronicle.tell(&format!("watch it live:  rerun {address}"));
            self.open_viewer(address);
        } else {
            self.chronicle.tell(&format!("{role}: {line}"));
        }
    }

    /// Opens a viewer, once, if that is wanted.
    fn open_viewer(&mut self, address: &str) {
        #[cfg(feature = "view")]
        if std::mem::take(&mut self.opens_viewer) {
            super::super::viewer::open(address.to_owned());
        }
        #[cfg(not(feature = "view"))]
        let _ = (address, self.opens_viewer);
    }

    /// An island can evolve what comes after a generation, none if it begins from the seed.
    fn welcome(&mut self, role: Role, generation: Option<u32>) {
        let post = self.crew.post(role);
        post.generation = generation;
        let after = match generation {
            Some(generation) => format!("after generation {generation}"),
            None => "from the seed".to_owned(),
        };
        if let Some(seconds) = post.gets_ready() {
            self.chronicle.tell(&format!("{role} goes on {after}, {seconds:.3} s after its death"));
        } else if generation.is_some() {
            self.chronicle.tell(&format!("{role} goes on {after}"));
        }
    }

    fn hear_complaint(&mut self, role: Role, line: &str) {
        self.crew.post(role).complains(line);
        let line = ["warning: ", "error: "]
            .iter()
            .find_map(|kind| line.strip_prefix(kind))
            .unwrap_or(line);
        self.chronicle.warn(&format!("{role}: {line}"));
    }

    fn take_reports(&mut self) -> Result<(), Failure> {
        for sighting in self.lookout.receive() {
            let report = &sighting.report;
            self.crew.post(Role::Island(report.island)).generation = Some(report.generation);
            self.chronicle.update(self.problem, &sighting, self.watch.seconds());
            if let Some(champion) = &sighting.champion {
                self.podium.receive(self.dir, self.problem, champion)?;
            }
        }
        Ok(())
    }

    /// Starts somebody again who has died, unless it would die again.
    fn replace(&mut self, role: Role) -> Result<(), Failure> {
        let Some(status) = self.crew.bury(role)? else { return Ok(()) };
        // Its last words are here only now.
        self.listen(Duration::ZERO);
        match self.crew.post(role).leave_hope(status) {
            true => self.start_again(role, status)?,
            false if role == Role::Monitor => self.chronicle.warn(&format!(
                "the monitor ended {DEATHS_MAX} times ({status}); the run goes on without a film"
            )),
            false => return Err(self.despair(role, status)),
        }
        Ok(())
    }

    fn start_again(&mut self, role: Role, status: ExitStatus) -> Result<(), Failure> {
        self.chronicle.warn(&format!("{role} died ({status}); it is started again"));
        if role != Role::Monitor
            && let Err(error) = self.harbour.cleanup_dead_nodes()
        {
            // Its successor may find a place all the same; if not, it says so itself.
            self.chronicle.warn(&error.to_string());
        }
        self.crew.start(role)
    }

    fn despair(&mut self, role: Role, status: ExitStatus) -> Failure {
        let post = self.crew.post(role);
        let after = match post.generation {
            Some(generation) => format!("after generation {generation}"),
            None => "before it had evolved anything".to_owned(),
        };
        let complaint = post.take_complaint();
        let words = complaint.map_or_else(String::new, |words| {
            format!(", saying “{}”", words.strip_prefix("error: ").unwrap_or(&words))
        });
        Failure::failed(format!(
            "{role} ended by itself {DEATHS_MAX} times {after} ({status}){words}"
        ))
    }

    /// Asks everybody to stop, and waits for them.
    fn stop(&mut self, is_finished: bool) {
        let ear = self.ear.clone();
        let is_island = |role| role != Role::Monitor;
        self.crew.ask_to_stop(is_island);
        self.crew.await_end(is_island, LAST_WORDS, || ear.heard_hurry());
        self.crew.kill(is_island);
        while self.crew.has(Role::Monitor) && !ear.heard_hurry() {
            self.let_monitor_end(if is_finished { LAST_REEL } else { LAST_WORDS });
        }
    }

    /// The monitor films what is left; if it dies over it, another one does.
    fn let_monitor_end(&mut self, most: Duration) {
        let ear = self.ear.clone();
        let is_monitor = |role| role == Role::Monitor;
        self.crew.ask_to_stop(is_monitor);
        let is_quick = self.crew.await_end(is_monitor, SOON, || ear.heard_hurry());
        if !is_quick {
            self.chronicle.tell(match P::HAS_BODIES {
                true => "the monitor films the last champions …",
                false => "the monitor records the last generations …",
            });
        }
        if !is_quick && !self.crew.await_end(is_monitor, most, || ear.heard_hurry()) {
            self.chronicle.warn("the monitor was still filming and was stopped; the film has gaps");
            return self.crew.kill(is_monitor);
        }
        let Ok(Some(status)) = self.crew.bury(Role::Monitor) else { return };
        self.listen(Duration::ZERO);
        let fails = !status.success();
        if fails && self.crew.post(Role::Monitor).leave_hope(status) {
            if let Err(failure) = self.start_again(Role::Monitor, status) {
                self.chronicle.warn(&failure.message);
            }
        } else if fails {
            self.chronicle.warn(&format!("the monitor failed ({status}); the film has gaps"));
        }
    }
}

/// What a run begins with.
fn overture(config: &Config, inhabitants: &str, dir: &RunDir) -> String {
    let Config { islands, population, generations, seed, .. } = config;
    format!(
        "{islands} islands × {population} {inhabitants} evolve for {generations} generations, seed {}, in {}",
        seed.unwrap_or_default(),
        dir.path().display()
    )
}
