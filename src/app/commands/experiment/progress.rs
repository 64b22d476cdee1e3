//! How an experiment is getting on: a bar on a terminal, a plain line a run elsewhere.

use crate::app::console::{printable, say};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Shows how many runs are done.
pub enum Progress {
    /// On a terminal.
    Bar(ProgressBar),
    /// How many lines there were, and how many there will be.
    Lines(usize, usize),
    /// Nothing is shown.
    Nothing,
}

impl Progress {
    /// Of so many runs, of which some are done already.
    pub fn new(done: usize, all: usize, quiet: bool) -> Self {
        if quiet {
            return Self::Nothing;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines(done, all);
        }
        let template = "{pos:>6}/{len} runs {bar:30.cyan/blue} {elapsed_precise}  {msg}";
        let style =
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(all as u64).with_style(style).with_position(done as u64);
        bar.enable_steady_tick(Duration::from_secs(1));
        Self::Bar(bar)
    }

    /// A run has finished.
    pub fn advance(&mut self, news: &str) {
        match self {
            Self::Bar(bar) => {
                bar.inc(1);
                bar.set_message(printable(news).into_owned());
            }
            Self::Lines(done, all) => {
                *done += 1;
                say(&format!("run {done}/{all}  {news}"));
            }
            Self::Nothing => {}
        }
    }

    /// Leaves the bar as it is, and goes on below it.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.abandon();
            say("");
        }
    }
}
