//! How a run is getting on: a bar an island on a terminal, plain lines elsewhere.

use crate::app::console::{Stopwatch, say, say_above};
use crate::archipelago::Report;
use crate::evolution::Fitness;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::transport::Sighting;
use indicatif::{HumanDuration, MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Plain lines of one island are at least so far apart, in seconds, but for its last one.
const LINE_EVERY_S: f64 = 5.0;

impl Tally {
    /// The best, what of it holds on fresh trials, how fast it goes, and how long it will.
    fn news<P: Subject>(
        &self,
        problem: &P,
        generation: u32,
        generations: u32,
        seconds: f64,
    ) -> String {
        let best = self.best.map_or_else(String::new, |best| problem.show(best));
        let holds = self.validated.map(|fresh| format!(" ({} holds)", problem.show(fresh)));
        let speed = self.evaluations as f64 / seconds.max(1e-3);
        let done = generation.saturating_sub(self.first.unwrap_or(generation)) + 1;
        let rate = f64::from(done) / seconds.max(1e-3);
        let left_s = f64::from(generations.saturating_sub(generation)) / rate;
        let left = HumanDuration(Duration::from_secs_f64(left_s.min(1e9)));
        format!("best {best}{}  {speed:.1} evals/s  {left:#} left", holds.unwrap_or_default())
    }
}

/// Shows the progress of every island.
pub struct Progress {
    show: Show,
    generations: u32,
    tally: Vec<Tally>,
}

enum Show {
    Bars(MultiProgress, Vec<ProgressBar>),
    Lines,
    Nothing,
}

/// What is known of an island.
#[derive(Clone, Default)]
struct Tally {
    /// The first generation that was seen: a run that goes on does not begin with 0.
    first: Option<u32>,
    generation: Option<u32>,
    evaluations: u64,
    best: Option<Fitness>,
    /// What its newest champion is worth on fresh trials.
    validated: Option<Fitness>,
    last_line: Option<Stopwatch>,
}

impl Progress {
    /// Bars if standard error is a terminal.
    pub fn new(config: &Config, quiet: bool) -> Self {
        let show = if quiet {
            Show::Nothing
        } else if std::io::stderr().is_terminal() {
            bars(config)
        } else {
            Show::Lines
        };
        let tally = vec![Tally::default(); config.islands as usize];
        Self { show, generations: config.generations, tally }
    }

    /// Says something above the bars.
    pub fn say(&self, line: &str) {
        match &self.show {
            Show::Bars(bars, _) => say_above(bars, line),
            Show::Lines => say(line),
            Show::Nothing => {}
        }
    }

    /// The same where nothing is to be shown, too.
    pub fn insist(&self, line: &str) {
        match &self.show {
            Show::Bars(..) => self.say(line),
            Show::Lines | Show::Nothing => say(line),
        }
    }

    /// Shows what an island has told, `seconds` after the start.
    pub fn update<P: Subject>(
        &mut self,
        problem: &P,
        Sighting { report, champion, .. }: &Sighting<P::Gene>,
        seconds: f64,
    ) {
        let Some(tally) = self.tally.get_mut(report.island as usize) else { return };
        // An island that was born again evolves again what it had not saved.
        if tally.generation.is_none_or(|last| report.generation > last) {
            tally.evaluations += report.effort.evaluations;
            tally.generation = Some(report.generation);
            tally.first = tally.first.or(tally.generation);
        }
        tally.best = tally.best.max(Some(report.statistics.best));
        tally.validated = champion.as_ref().map_or(tally.validated, |champion| champion.validated);
        let news = tally.news(problem, report.generation, self.generations, seconds);
        match &self.show {
            Show::Bars(_, bars) => {
                let bar = &bars[report.island as usize];
                bar.set_position(u64::from(report.generation));
                bar.set_message(news);
            }
            Show::Lines => {
                let rested = tally.last_line.is_none_or(|last| last.seconds() >= LINE_EVERY_S);
                if rested || report.generation == self.generations {
                    tally.last_line = Some(Stopwatch::start());
                    let Report { island, generation, .. } = report;
                    say(&format!(
                        "island {island}  generation {generation}/{}  {news}",
                        self.generations
                    ));
                }
            }
            Show::Nothing => {}
        }
    }

    /// Leaves the bars as they are, and goes on below them.
    pub fn finish(&self) {
        if let Show::Bars(_, bars) = &self.show {
            bars.iter().for_each(ProgressBar::abandon);
            say("");
        }
    }
}

fn bars(config: &Config) -> Show {
    let style = ProgressStyle::with_template(
        "{prefix:>10} {bar:30.cyan/blue} {pos:>4}/{len} {elapsed_precise}  {msg}",
    )
    .unwrap_or_else(|_| ProgressStyle::default_bar());
    let all = MultiProgress::with_draw_target(ProgressDrawTarget::stderr());
    let bars = (0..config.islands)
        .map(|island| {
            let bar = all.add(ProgressBar::new(u64::from(config.generations)));
            bar.set_style(style.clone());
            bar.set_prefix(format!("island {island}"));
            bar
        })
        .collect();
    Show::Bars(all, bars)
}
