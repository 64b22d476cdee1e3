//! How long an island waits before it says for whom.

use crate::app::console::{Stopwatch, say};
use crate::app::processes::parent_link::tell;

/// An island that hears nothing for so long wonders, in seconds.
const WORRY_S: f64 = 5.0;
/// Neighbours may take some generations longer than the slowest of one's own.
const GENERATIONS: f64 = 3.0;

/// What an island has waited for so far.
pub struct Patience {
    slowest_s: f64,
    waiting: Option<Waiting>,
}

struct Waiting {
    epoch: u32,
    since: Stopwatch,
    has_said: bool,
}

impl Patience {
    /// Nothing was waited for yet.
    pub fn new() -> Self {
        Self { slowest_s: 0.0, waiting: None }
    }

    /// A generation of one's own took so long, in seconds.
    pub fn learn(&mut self, seconds: f64) {
        match self.waiting.take() {
            // What was waited for is no measure of what neighbours need.
            Some(waiting) if waiting.has_said => {
                let waited = waiting.since.seconds();
                tell(&format!("epoch {} came after {waited:.1} s; it goes on", waiting.epoch));
            }
            Some(_) => {}
            None => self.slowest_s = self.slowest_s.max(seconds),
        }
    }

    /// Waits once more for the outboxes of an epoch; says so, once, when that gets long.
    pub fn wait(&mut self, missing: Option<(u32, Vec<u32>)>) {
        let Some((epoch, sources)) = missing else { return };
        let waiting = self.waiting.get_or_insert_with(|| Waiting {
            epoch,
            since: Stopwatch::start(),
            has_said: false,
        });
        let waited = waiting.since.seconds();
        if !waiting.has_said && waited > WORRY_S + GENERATIONS * self.slowest_s {
            waiting.has_said = true;
            let sources: Vec<String> = sources.iter().map(ToString::to_string).collect();
            say(&format!(
                "warning: has waited {waited:.0} s for epoch {epoch} of island {}, which may be stopped, or wait itself",
                sources.join(", ")
            ));
        }
    }
}
