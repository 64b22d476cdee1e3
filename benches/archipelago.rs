//! How fast whole runs are: evaluations a second of the real program, by islands and threads.
//!
//! Criterion is not for this: a sample is a run of many seconds and as many processes, which it would repeat
//! ten times at least, one setting after the other. Here all settings take turns, so that whatever else the
//! machine does hits all of them, and the median of the rounds counts.
//!
//! All runs evolve the same number of creatures in all, but only those with equally many islands evolve the
//! same creatures, and small bodies are tried faster than large ones: so a run's speed-up is over the one with
//! as many islands and the fewest threads. The processor time of an evaluation says what threads and processes
//! cost even where others use the machine. An island has at least one thread, so that there are no runs with
//! fewer threads than islands.
//!
//! `cargo bench --bench archipelago`

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

mod program;

use program::{median, number};
use serde_json::Value;

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
    /// Evaluations a second of each round.
    speeds: Vec<f64>,
    /// Processor milliseconds an evaluation of each round.
    costs_ms: Vec<f64>,
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
        .map(|(islands, threads)| Setting {
            islands,
            threads,
            speeds: Vec::new(),
            costs_ms: Vec::new(),
        })
        .collect();

    let mut digests = [const { None }; ISLANDS.len()];
    for _ in 0..rounds {
        for setting in &mut settings {
            let before_ms = processor_ms_of_children();
            let summary = run(setting.islands, setting.threads, budget);
            setting.speeds.push(number(&summary, "evaluations_per_second"));
            let used_ms = processor_ms_of_children() - before_ms;
            setting.costs_ms.push(used_ms / number(&summary, "evaluations"));
            let row = ISLANDS.iter().position(|&islands| islands == setting.islands);
            let first = &mut digests[row.expect("it is one of them")];
            let digest = summary["digest"].clone();
            assert_eq!(*first.get_or_insert_with(|| digest.clone()), digest);
        }
    }
    print(&settings, budget);
}

fn run(islands: usize, threads: usize, budget: Budget) -> Value {
    program::run(&[
        format!("--n={islands}"),
        format!("--threads={threads}"),
        format!("--seed={SEED}"),
        format!("--population={}", budget.creatures / islands),
        format!("--generations={}", budget.generations),
        "--migration-interval=1".to_owned(),
    ])
}

fn print(settings: &[Setting], Budget { creatures, generations }: Budget) {
    let rounds = settings[0].speeds.len();
    println!(
        "evaluations/s, {creatures} creatures in all, {generations} generations, seed {SEED}; median of \
         {rounds} interleaved rounds (least–most)\n"
    );
    println!("| islands | threads | evals/s | least–most | × fewest threads | CPU ms/eval |");
    println!("|---|---|---|---|---|---|");
    for Setting { islands, threads, speeds, costs_ms } in settings {
        let speed = median(speeds);
        let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = speeds.iter().copied().fold(0.0, f64::max);
        let fewest = settings.iter().find(|other| other.islands == *islands);
        let ratio = speed / median(&fewest.expect("there is this one at least").speeds);
        let cost_ms = median(costs_ms);
        println!(
            "| {islands} | {threads} | {speed:.1} | {least:.1}–{most:.1} | {ratio:.2} | {cost_ms:.1} |"
        );
    }
}

/// What children and their children have used of all processors, once they were waited for.
fn processor_ms_of_children() -> f64 {
    // Linux counts in hundredths of a second for programs, whatever the kernel's own clock.
    const TICK_MS: f64 = 10.0;
    let stat = std::fs::read_to_string("/proc/self/stat").expect("this is Linux");
    // The second field is a name, and may contain anything but a closing parenthesis at the end.
    let (_, fields) = stat.rsplit_once(')').expect("the second field is in parentheses");
    let ticks = fields.split_whitespace().skip(13).take(2).map(|field| field.parse::<f64>());
    ticks.map(|ticks| ticks.expect("it is a number") * TICK_MS).sum()
}
