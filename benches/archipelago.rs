//! How fast whole runs are: evaluations a second of the real program, by islands and threads.
//!
//! Criterion is not for this: a sample is a run of many seconds and as many processes, which it would repeat
//! ten times at least, one setting after the other. Here all settings take turns, so that whatever else the
//! machine does hits all of them, and the median of the rounds counts.
//!
//! All runs evolve the same number of creatures in all. An island has at least one thread, so that there are
//! no runs with fewer threads than islands.
//!
//! `cargo bench --bench archipelago`

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use serde_json::Value;
use std::process::{Command, Stdio};

const ISLANDS: [usize; 3] = [1, 2, 4];
const THREADS: [usize; 3] = [1, 2, 4];
const ROUNDS: usize = 3;
const SEED: u64 = 7;

/// How much is evolved.
#[derive(Clone, Copy)]
struct Budget {
    /// Creatures of all islands together.
    creatures: usize,
    generations: usize,
}

/// What is measured of a setting.
struct Setting {
    islands: usize,
    threads: usize,
    speeds: Vec<f64>,
}

fn main() {
    // As criterion's benches have it: everything once, to see that it works.
    let is_trial = std::env::args().any(|argument| argument == "--test");
    let (rounds, budget) = if is_trial {
        (1, Budget { creatures: 12, generations: 1 })
    } else {
        (ROUNDS, Budget { creatures: 48, generations: 4 })
    };
    let mut settings: Vec<Setting> = ISLANDS
        .iter()
        .flat_map(|&islands| THREADS.iter().map(move |&threads| (islands, threads)))
        .filter(|(islands, threads)| threads >= islands)
        .map(|(islands, threads)| Setting { islands, threads, speeds: Vec::new() })
        .collect();

    let mut digests = [const { None }; ISLANDS.len()];
    for _ in 0..rounds {
        for setting in &mut settings {
            let summary = run(setting.islands, setting.threads, budget);
            let speed = summary["evaluations_per_second"].as_f64();
            setting.speeds.push(speed.expect("a summary says the speed"));
            let row = ISLANDS.iter().position(|&islands| islands == setting.islands);
            let first = &mut digests[row.expect("it is one of them")];
            let digest = summary["digest"].clone();
            assert_eq!(*first.get_or_insert_with(|| digest.clone()), digest);
        }
    }
    print(&settings, budget);
}

fn run(islands: usize, threads: usize, budget: Budget) -> Value {
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_islands"))
        .args(["--json", "--no-monitor", "--quiet"])
        .arg(format!("--n={islands}"))
        .arg(format!("--threads={threads}"))
        .arg(format!("--seed={SEED}"))
        .arg(format!("--population={}", budget.creatures / islands))
        .arg(format!("--generations={}", budget.generations))
        .arg("--migration-interval=1")
        .arg("--out")
        .arg(folder.path())
        .stderr(Stdio::inherit())
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8(output.stdout).expect("it prints text");
    let last = text.lines().last().expect("it prints its result");
    serde_json::from_str(last).expect("its result is JSON")
}

fn print(settings: &[Setting], Budget { creatures, generations }: Budget) {
    let rounds = settings[0].speeds.len();
    println!(
        "evaluations/s, {creatures} creatures in all, {generations} generations, seed {SEED}; median of \
         {rounds} interleaved rounds (least–most)\n"
    );
    println!("| islands | threads | evals/s | least–most | × one thread |");
    println!("|---|---|---|---|---|");
    let one = median(&settings[0].speeds);
    for Setting { islands, threads, speeds } in settings {
        let speed = median(speeds);
        let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = speeds.iter().copied().fold(0.0, f64::max);
        let ratio = speed / one;
        println!("| {islands} | {threads} | {speed:.1} | {least:.1}–{most:.1} | {ratio:.2} |");
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
