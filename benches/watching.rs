//! What it costs to be watched: whole runs with default settings without a monitor, with it, and with it and a
//! viewer that has asked for everything and reads nothing, taking turns. How much of the processors the monitor takes
//! while the islands evolve, and what a film takes on the disk.
//!
//! `cargo bench --bench watching`

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

#[path = "../tests/support/onlooker.rs"]
mod onlooker;
mod program;

use onlooker::{Onlooker, port_of};
use program::{median, number};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

const ROUNDS: usize = 5;
const GENERATIONS: u32 = 12;
const SEED: u64 = 7;
/// More generations than any run has.
const NEVER: u32 = 1_000_000_000;
const SPEED: &str = "evaluations_per_second";
/// So often the processes of a run are looked at.
const LOOK: Duration = Duration::from_millis(50);

/// Who watches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Audience {
    Nobody,
    Monitor,
    HungViewer,
}

/// What is measured of a run.
struct Measured {
    /// Evaluations a second.
    speed: f64,
    /// The monitor's processor time over the islands', as long as all islands evolve.
    share: f64,
    /// The bytes of the film.
    film: u64,
    result: Value,
}

fn main() {
    // As criterion's benches have it: everything once, to see that it works.
    let is_trial = std::env::args().any(|argument| argument == "--test");
    let (rounds, generations, small) = match is_trial {
        true => (1, 2, &["--n=2", "--population=4", "--genes=1"][..]),
        false => (ROUNDS, GENERATIONS, &[][..]),
    };
    let rounds: Vec<_> = (0..rounds).map(|_| round(generations, small)).collect();
    print(&rounds);
    print_sizes(generations, small);
}

fn round(generations: u32, settings: &[&str]) -> [Measured; 3] {
    let audiences = [Audience::Nobody, Audience::Monitor, Audience::HungViewer];
    let runs = audiences.map(|audience| watch(audience, generations, settings));
    assert!(runs.iter().all(|run| run.result["digest"] == runs[0].result["digest"]));
    runs
}

fn print(rounds: &[[Measured; 3]]) {
    println!(
        "| watched by | evals/s, median of {} rounds | over that of nobody | least–most | monitor's CPU over \
         the islands' |",
        rounds.len()
    );
    println!("|---|---|---|---|---|");
    for (column, name) in ["nobody", "the monitor", "it and a viewer that hangs"].iter().enumerate()
    {
        let of = |value: fn(&Measured) -> f64| -> Vec<f64> {
            rounds.iter().map(|round| value(&round[column])).collect()
        };
        let ratios: Vec<f64> =
            rounds.iter().map(|round| round[column].speed / round[0].speed).collect();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let most = ratios.iter().copied().fold(0.0, f64::max);
        println!(
            "| {name} | {:.2} | {:.3} | {least:.3}–{most:.3} | {:.2} % |",
            median(&of(|run| run.speed)),
            median(&ratios),
            100.0 * median(&of(|run| run.share))
        );
    }
}

/// The same run filmed with a clip each generation and with two in all; and a long run of small bodies, which hardly
/// move, in two lengths: the differences are what a clip and what a generation takes.
fn print_sizes(generations: u32, settings: &[&str]) {
    let film = |generations: u32, clip_every: u32, settings: &[&str]| {
        let every = format!("--clip-every={clip_every}");
        let settings: Vec<&str> = settings.iter().copied().chain([&*every]).collect();
        let run = watch(Audience::Monitor, generations, &settings);
        (run.film as f64 / 1e3, number(&run.result, "islands"))
    };
    let (few_kb, islands) = film(generations, generations, settings);
    let (many_kb, _) = film(generations, 1, settings);
    let clip_kb = (many_kb - few_kb) / (f64::from(generations - 1) * islands);
    println!(
        "\na film of {generations} generations of {islands} islands: {few_kb:.0} kB with two clips an island, \
         {many_kb:.0} kB with one each generation: {clip_kb:.1} kB a clip"
    );
    let tiny = ["--n=4", "--population=4", "--genes=1", "--robustness=0", "--judged=false"];
    let (short, long) = (2 * generations, 20 * generations);
    let [short_kb, long_kb] = [short, long].map(|length| film(length, NEVER, &tiny).0);
    let row_kb = (long_kb - short_kb) / (4.0 * f64::from(long - short));
    println!("a generation of an island without a clip: {row_kb:.2} kB");
}

/// Runs the program to its end before an audience.
fn watch(audience: Audience, generations: u32, settings: &[&str]) -> Measured {
    let own = [format!("--seed={SEED}"), format!("--generations={generations}")];
    let settings: Vec<_> =
        own.into_iter().chain(settings.iter().map(ToString::to_string)).collect();
    if audience == Audience::Nobody {
        let result = program::run(&settings);
        return Measured { speed: number(&result, SPEED), share: 0.0, film: 0, result };
    }
    let folder = program::folder();
    let out = folder.path().join("run");
    let usual = ["--json".to_owned(), "--quiet".to_owned(), format!("--out={}", out.display())];
    let mut run = program::start(&[&usual, &settings[..]].concat());
    let (mut viewer, mut used) = (None, Ticks::default());
    while run.try_wait().expect("it is our child").is_none() {
        if audience == Audience::HungViewer && viewer.is_none() {
            viewer = attach(&out);
        }
        // Whoever has ended is not counted any more.
        used = Some(ticks(run.id())).filter(|now| now.islands >= used.islands).unwrap_or(used);
        sleep(LOOK);
    }
    // A trial may be over before a viewer can attach.
    let was_watched = viewer.is_some() || generations < GENERATIONS;
    assert!(was_watched || audience == Audience::Monitor, "nobody could attach");
    let result = program::result(run);
    let film = fs::metadata(out.join("recording.rrd")).expect("there is a film").len();
    let share = used.monitor / used.islands.max(1.0);
    Measured { speed: number(&result, SPEED), share, film, result }
}

/// A viewer of the run in a folder, once it is served.
fn attach(out: &Path) -> Option<Onlooker> {
    let port = port_of(&fs::read_to_string(out.join("run.log")).ok()?)?;
    let mut viewer = Onlooker::attach(port).ok()?;
    // What is answered is not read on.
    viewer.read(1).ok()?;
    Some(viewer)
}

/// The processor time of a run's processes so far, in the kernel's units.
#[derive(Debug, Clone, Copy, Default)]
struct Ticks {
    monitor: f64,
    islands: f64,
}

fn ticks(launcher: u32) -> Ticks {
    let mut all = Ticks::default();
    for entry in fs::read_dir("/proc").expect("this is Linux").flatten() {
        let file = |name| fs::read_to_string(entry.path().join(name)).unwrap_or_default();
        let stat = file("stat");
        // The second field is a name, and may contain anything but a closing parenthesis at the end.
        let Some((_, fields)) = stat.rsplit_once(')') else { continue };
        let fields: Vec<&str> = fields.split_whitespace().collect();
        if fields[1] != launcher.to_string() {
            continue;
        }
        let used: f64 = fields[11..13].iter().filter_map(|ticks| ticks.parse::<f64>().ok()).sum();
        match file("cmdline").split('\0').nth(1) {
            Some("monitor") => all.monitor = used,
            Some("island") => all.islands += used,
            _ => {}
        }
    }
    all
}
