//! What was found, as Markdown.

use crate::model::{Order, Plan, makespan_s};
use crate::program::median;
use crate::trace::Trace;
use std::collections::BTreeMap;

/// Generations that are projected.
const GENERATIONS: u32 = 80;
/// Threads among which an island's evaluations are shared out.
const THREADS: [usize; 5] = [2, 4, 8, 16, 64];
/// Islands and threads an island, on 4, 16 and 64 cores.
const PLANS: [(u32, usize); 9] =
    [(4, 1), (1, 4), (16, 1), (4, 4), (1, 16), (64, 1), (16, 4), (4, 16), (1, 64)];

fn spread(values: &[f64], digits: usize) -> String {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    format!("{least:.digits$}–{most:.digits$}")
}

/// `islands evaluate` over threads.
pub fn evaluate(threads: &[usize], speeds: &[Vec<f64>]) {
    println!("`islands evaluate`, median of {} interleaved rounds:\n", speeds[0].len());
    println!("| threads | evals/s | least–most | speed-up | efficiency |\n|---|---|---|---|---|");
    for (threads, rounds) in threads.iter().zip(speeds) {
        // Within a round, since rounds differ more than what is compared.
        let ratios: Vec<f64> = rounds.iter().zip(&speeds[0]).map(|(all, one)| all / one).collect();
        let (speed, ratio) = (median(rounds), median(&ratios));
        let efficiency = ratio / *threads as f64 * 100.0;
        println!(
            "| {threads} | {speed:.1} | {} | {ratio:.2} | {efficiency:.0} % |",
            spread(rounds, 1)
        );
    }
}

/// Whole runs, beside what the model says of them.
pub fn runs(
    runs: &[(u32, usize, u32)],
    walls_s: &[Vec<f64>],
    traces: &BTreeMap<(u32, u32), Trace>,
) {
    println!("\nRuns, median of {} interleaved rounds, and the model of them:\n", walls_s[0].len());
    println!(
        "| islands | threads | lag | s | least–most | one core, s | efficiency | model, s | its waits |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (&(islands, threads, lag), walls_s) in runs.iter().zip(walls_s) {
        let trace = &traces[&(islands, lag)];
        let outcome = Plan::of(trace, threads / islands as usize).run(trace);
        let wall_s = median(walls_s);
        let efficiency = outcome.one_core_s / wall_s / threads as f64 * 100.0;
        println!(
            "| {islands} | {threads} | {lag} | {wall_s:.2} | {} | {:.2} | {efficiency:.0} % | {:.2} | {:.1} % |",
            spread(walls_s, 2),
            outcome.one_core_s,
            outcome.wall_s,
            outcome.waits(islands)
        );
    }
}

/// The parts of a generation.
pub fn parts(trace: &Trace) {
    let all: Vec<_> = trace.all().collect();
    let total_s: f64 = all.iter().map(|it| it.serial_s() + it.work_s()).sum();
    println!("\nParts of {} generations on one thread:\n", all.len());
    println!("| part | ms, median | least–most | share of all |\n|---|---|---|---|");
    let row = |name: &str, seconds: Vec<f64>| {
        let share = seconds.iter().sum::<f64>() / total_s * 100.0;
        let ms: Vec<f64> = seconds.iter().map(|s| s * 1e3).collect();
        println!("| {name} | {:.3} | {} | {share:.3} % |", median(&ms), spread(&ms, 3));
    };
    row("evaluate", all.iter().map(|it| it.work_s()).collect());
    row("all other phases", all.iter().map(|it| it.phases_s).collect());
    row("logs, journal, checkpoint", all.iter().map(|it| it.files_s).collect());
    let jobs: Vec<_> = trace.all().flat_map(|it| &it.jobs).collect();
    let ms: Vec<f64> = jobs.iter().map(|job| job.seconds * 1e3).collect();
    println!("\n{} evaluations took {:.1} ms each, {} ms", ms.len(), median(&ms), spread(&ms, 1));
    // What is refused costs nothing and says nothing of the estimate.
    let tried = jobs.iter().filter(|job| job.estimate > 0);
    let us: Vec<f64> = tried.map(|job| job.seconds * 1e6 / job.estimate as f64).collect();
    println!("and {:.2} µs a link and step, {} µs", median(&us), spread(&us, 2));
}

/// How much of the threads' time is lost at the end of each generation.
pub fn sharing(trace: &Trace) {
    println!(
        "\nIdle at the end of a generation's evaluations, by the order in which they are begun:\n"
    );
    println!("| threads | arbitrary | dearest first, estimated | dearest first, known |");
    println!("|---|---|---|---|");
    for threads in THREADS {
        let idle = |order| {
            let work_s: f64 = trace.all().map(|it| it.work_s()).sum();
            let makespans_s: f64 = trace.all().map(|it| makespan_s(&it.jobs, threads, order)).sum();
            (1.0 - work_s / makespans_s / threads as f64) * 100.0
        };
        let [arbitrary, estimated, known] =
            [Order::Arbitrary, Order::Estimated, Order::Known].map(idle);
        println!("| {threads} | {arbitrary:.1} % | {estimated:.1} % | {known:.1} % |");
    }
}

/// Runs on more cores than there are.
pub fn projection(trace: &Trace) {
    println!("\nProjected efficiency of {GENERATIONS} generations, and waiting for immigrants:\n");
    println!(
        "| cores | islands × threads | Amdahl | arbitrary order, lag 1 | lag 0 | waits | lag 1 | waits | speed-up |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (islands, threads) in PLANS {
        let plan = Plan { islands, generations: GENERATIONS, ..Plan::of(trace, threads) };
        let cores = plan.cores();
        let run = |lag, order| {
            let mut plan = Plan { order, ..plan };
            plan.migration.lag = lag;
            plan.run(trace)
        };
        let (eager, usual) = (run(0, Order::Estimated), run(1, Order::Estimated));
        let arbitrary = run(1, Order::Arbitrary);
        let efficiency = |seconds: f64| usual.one_core_s / seconds / cores * 100.0;
        println!(
            "| {cores} | {islands} × {threads} | {:.1} % | {:.1} % | {:.1} % | {:.1} % | {:.1} % | {:.1} % | {:.1} |",
            efficiency(usual.amdahl_s),
            efficiency(arbitrary.wall_s),
            efficiency(eager.wall_s),
            eager.waits(islands),
            efficiency(usual.wall_s),
            usual.waits(islands),
            usual.one_core_s / usual.wall_s,
        );
    }
}
