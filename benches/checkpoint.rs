//! What it costs that nothing is lost: whole runs with default settings that save every island after every
//! generation, and the same runs that save only the first and last state, taking turns.
//!
//! A run is seconds of evaluation and milliseconds of saving, so that the ratio of whole runs drowns in noise on
//! any machine that does something else, too. So the time of a save itself is measured as well, and what part of
//! a generation it is.
//!
//! `cargo bench --bench checkpoint`

#![expect(clippy::print_stdout, reason = "the table is what it is for")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

mod program;

use islands::archipelago::{Step, island};
use islands::evolution::Founders;
use islands::runs::config::Config;
use islands::store::{Logbook, RunDir};
use program::{median, number};
use serde_json::Value;
use std::time::Instant;

const ROUNDS: usize = 7;
const GENERATIONS: u32 = 6;
const SAVES: usize = 200;
const SEED: u64 = 7;
/// More generations than any of these runs has.
const NEVER: u32 = 1_000_000;

fn main() {
    // As criterion's benches have it: everything once, to see that it works.
    let is_trial = std::env::args().any(|argument| argument == "--test");
    let small = ["--n=2", "--population=4", "--genes=1"];
    let (rounds, generations, saves, settings) = match is_trial {
        true => (1, 2, 2, &small[..]),
        false => (ROUNDS, GENERATIONS, SAVES, &[][..]),
    };
    let intervals = [1, NEVER];
    let mut speeds = intervals.map(|_| Vec::new());
    let mut generation_s = Vec::new();
    for _ in 0..rounds {
        let runs = intervals.map(|interval| run(interval, generations, settings));
        assert_eq!(runs[0]["digest"], runs[1]["digest"]);
        for (speeds, run) in speeds.iter_mut().zip(&runs) {
            speeds.push(number(run, "evaluations_per_second"));
        }
        generation_s.push(number(&runs[0], "wall_seconds") / f64::from(generations + 1));
    }
    println!("| checkpoints | evals/s, median of {rounds} rounds | least–most |");
    println!("|---|---|---|");
    for (name, speeds) in ["after every generation", "first and last"].iter().zip(&speeds) {
        let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = speeds.iter().copied().fold(0.0, f64::max);
        println!("| {name} | {:.2} | {least:.2}–{most:.2} |", median(speeds));
    }
    let ratios: Vec<f64> =
        speeds[0].iter().zip(&speeds[1]).map(|(with, without)| with / without).collect();
    println!("\nratio of the two runs of a round: median {:.3}", median(&ratios));
    let (save_ms, record_ms) = save(saves);
    let share = |ms: f64| ms / 10.0 / median(&generation_s);
    println!(
        "a save takes {save_ms:.2} ms (median of {saves}), {:.2} % of a generation of {:.2} s; its records in \
         the logs {record_ms:.2} ms, {:.2} %",
        share(save_ms),
        median(&generation_s),
        share(record_ms)
    );
}

fn run(checkpoint_interval: u32, generations: u32, settings: &[&str]) -> Value {
    let own = [
        format!("--seed={SEED}"),
        format!("--generations={generations}"),
        format!("--checkpoint-interval={checkpoint_interval}"),
    ];
    program::run(
        &own.into_iter().chain(settings.iter().map(ToString::to_string)).collect::<Vec<_>>(),
    )
}

/// Milliseconds that it takes to save an island with default settings, and to record its generation.
fn save(times: usize) -> (f64, f64) {
    let folder = program::folder();
    let config = Config { seed: Some(SEED), islands: 1, ..Config::default() };
    let archipelago = config.archipelago();
    let dir = RunDir::at(folder.path().join("run"));
    let claim = dir.create().expect("the folder is writable");
    claim.make_folders(1).expect("the folder is writable");
    let restored = Logbook::open(&dir, &archipelago, 0, &config.settings());
    let mut logbook = restored.expect("the folder is writable").logbook;
    let problem = config.locomotion();
    let mut step: Step<_> = island::genesis(&problem, &Founders::NONE, &archipelago, 0);
    let [mut saves, mut records] = [Vec::new(), Vec::new()];
    for generation in 0..times {
        step.report.generation = generation as u32;
        step.island.generation = generation as u32;
        step.champion = None;
        let before = Instant::now();
        logbook.record(&step, 1.0).expect("the disk has room");
        let between = Instant::now();
        logbook.save(&step.island).expect("the disk has room");
        records.push((between - before).as_secs_f64() * 1e3);
        saves.push(between.elapsed().as_secs_f64() * 1e3);
    }
    (median(&saves), median(&records))
}
