//! Islands that do not wait for each other: what arrived is recorded, and leads to the same bits again.

use crate::support::{World, await_generation, is_alive, signal, try_signal, until};
use islands::archipelago::arrivals::check_record;
use islands::archipelago::{Arrivals, Digest, lockstep};
use islands::evolution::Founders;
use islands::rng::Stream;
use islands::runs::catalogue::Visitor;
use islands::runs::config::Config;
use islands::runs::subject::Subject;
use islands::store::{RecordLog, RunDir};
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

const ISLANDS: u32 = 4;
const GENERATIONS: u32 = 14;
/// A run of a second or two.
const RUN: &str = "--n 4 --seed 43 --population 5 --robustness 0 --generations 14 --genes 2 --migration-interval 2 \
                   --exchange async --topology full";

fn dir(world: &World) -> RunDir {
    RunDir::at(world.path("run"))
}

fn record(dir: &RunDir, island: u32) -> Vec<Arrivals> {
    RecordLog::read(&dir.arrivals(island)).unwrap().records
}

/// What each island has on record at the moment.
fn records(dir: &RunDir) -> Vec<Vec<Arrivals>> {
    (0..ISLANDS).map(|island| record(dir, island)).collect()
}

fn forge(dir: &RunDir, island: u32, forge: impl FnOnce(&mut Vec<Arrivals>)) {
    let mut records = record(dir, island);
    forge(&mut records);
    let mut log = RecordLog::open(&dir.arrivals(island)).unwrap();
    log.truncate(0).unwrap();
    records.iter().for_each(|record| log.append(record).unwrap());
}

/// The finished run's digest, once `islands verify` has found it again out of the record.
fn verified(world: &World) -> String {
    let table = world.islands("verify run --thorough");
    assert_eq!(table.code, Some(0), "{table:?}");
    let replay = table.stdout.lines().find(|line| line.starts_with("replay")).unwrap();
    assert!(replay.ends_with("the same digest"), "{replay}");
    let verdict = world.islands("verify run --json").json();
    verdict["digest"].as_str().unwrap().to_owned()
}

/// What such records of the run lead to, in this process.
fn replayed(world: &World, records: &[Vec<Arrivals>]) -> String {
    replay(&dir(world), records)
}

fn replay(dir: &RunDir, records: &[Vec<Arrivals>]) -> String {
    let config = Config::read(&dir.config()).unwrap();
    config.visit(Replay(&config, records))
}

struct Replay<'a>(&'a Config, &'a [Vec<Arrivals>]);

impl Visitor for Replay<'_> {
    type Output = String;

    fn visit<P: Subject>(self, problem: P) -> String {
        let Self(config, records) = self;
        let (archipelago, generations) = (config.archipelago(), config.generations);
        let islands =
            lockstep::replay(&problem, &Founders::NONE, &archipelago, generations, records, |_| ());
        Digest::of(&islands.unwrap()).to_string()
    }
}

/// A run of `--problem trap --dimensions 30 --n 3 --exchange async` that was recorded once.
#[test]
fn a_record_of_old_leads_to_the_digest_that_it_led_to() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/async");
    let dir = RunDir::at(&folder);
    let records: Vec<_> = (0..3).map(|island| record(&dir, island)).collect();
    assert!(records.iter().flatten().any(|arrivals| !arrivals.taken.is_empty()));
    let digest = fs::read_to_string(folder.join("digest")).unwrap();
    assert_eq!(replay(&dir, &records), digest.trim_end());
    let mut without = records;
    without.iter_mut().flatten().for_each(|arrivals| arrivals.taken.clear());
    assert_ne!(replay(&dir, &without), digest.trim_end(), "who came makes a difference");
}

#[test]
fn a_run_in_which_nobody_waits_says_so_and_its_record_leads_to_its_digest() {
    let world = World::new();
    let ending = world.islands(&format!("--out run --no-monitor --quiet --json {RUN}"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let note = "note: islands do not wait for each other: the seed alone does not fix the result; what each \
                takes in is recorded, so that it can be evolved again to the same digest\n";
    assert_eq!(ending.stderr, note);
    let digest = ending.json()["digest"].as_str().unwrap().to_owned();
    let replayed = replayed(&world, &records(&dir(&world)));
    assert_eq!([verified(&world), replayed], [digest.clone(), digest]);
    let taken = records(&dir(&world)).concat().iter().map(|it| it.taken.len()).sum::<usize>();
    assert!(taken > 0, "somebody travels");
    world.assert_left_nothing();
}

#[test]
fn whoever_is_killed_what_was_recorded_stays_true() {
    for round in 0..3 {
        let world = World::new();
        let mut rng = Stream::seed_from_u64(round);
        let mut run = world.start(&format!("--out run --no-monitor --json --quiet {RUN}"));
        await_generation(&dir(&world), ISLANDS, 0);
        let mut before = records(&dir(&world));
        for _ in 0..6 {
            sleep(Duration::from_millis(rng.random_range(0..120)));
            if rng.random_bool(0.3) {
                let children = run.children();
                run.signal("KILL");
                run.wait();
                until("nobody outlives it", || children.iter().all(|&pid| !is_alive(pid)));
                run = world.start("resume run --no-monitor --json --quiet");
            } else {
                let island = rng.random_range(0..ISLANDS);
                let pid = run.find_child(&format!("--index={island}"));
                // It may just have come to its end.
                let _ = pid.is_some_and(|pid| try_signal(pid, "KILL"));
            }
            let now = records(&dir(&world));
            let went_on = before.iter().zip(&now).all(|(before, now)| now.starts_with(before));
            assert!(went_on, "round {round}: {before:?} became {now:?}");
            before = now;
        }
        let ending = run.wait();
        assert_eq!(ending.code, Some(0), "round {round}: {ending:?}");
        let digest = ending.json()["digest"].as_str().unwrap().to_owned();
        assert_eq!(verified(&world), digest, "round {round}");
        world.assert_left_nothing();
    }
}

#[test]
fn a_run_is_made_longer_and_not_shorter() {
    let world = World::new();
    world.islands(&format!("--out run --no-monitor --quiet --json {RUN}"));
    let before = records(&dir(&world));
    let refusal = world.refusal("resume run --generations 12");
    assert!(refusal.contains("cannot be made shorter"), "{refusal}");
    let changed = world.refusal("resume run --exchange sync --generations 20");
    assert!(changed.contains("exchange is \"async\", not \"sync\""), "{changed}");
    let ending = world.islands("resume run --no-monitor --json --quiet --generations 20");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert_eq!(ending.json()["digest"], verified(&world));
    let after = records(&dir(&world));
    assert!(before.iter().zip(&after).all(|(before, after)| after.starts_with(before)));
    assert_eq!(after.concat().len(), 4 * 10);
}

#[test]
fn a_record_that_lacks_what_was_evolved_with_it_is_neither_gone_on_from_nor_verified() {
    let world = World::new();
    let settings = RUN.replace("--generations 14", "--generations 100000");
    let run = world.start(&format!("--out run --no-monitor --json {settings}"));
    await_generation(&dir(&world), ISLANDS, GENERATIONS);
    signal(run.pid(), "INT");
    assert_eq!(run.wait().code, Some(130));
    let path = dir(&world).arrivals(1);
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let ending = world.islands("resume run --no-monitor --json --quiet");
    assert_eq!(ending.code, Some(1), "{ending:?}");
    assert!(ending.stderr.contains("it cannot be evolved again"), "{ending:?}");
    assert_eq!(fs::read(&path).unwrap(), whole[..whole.len() / 2], "it is left as it is");
    let table = world.islands("verify run");
    assert!(table.code == Some(1) && table.stderr.contains("arrivals/island-1.log"), "{table:?}");
    fs::write(&path, whole).unwrap();
    assert_eq!(world.islands("verify run").code, Some(0));
}

#[test]
fn a_record_that_was_changed_is_found() {
    // Every immigrant counts, and no two outboxes are the same; what arrives is another thing each time all the same,
    // and may not matter.
    let (world, forged) = (0..20)
        .find_map(|seed| {
            let world = World::new();
            let settings = format!("{RUN} --emigrants random --replacement random --seed {seed}");
            let settings = settings.replace("--seed 43 ", "");
            world.islands(&format!("--out run --no-monitor --quiet --json {settings}"));
            let has_arrivals = record(&dir(&world), 0).iter().any(|it| !it.taken.is_empty());
            let forged = forgery(&world).filter(|_| has_arrivals)?;
            Some((world, forged))
        })
        .expect("some arrival matters");
    let dir = dir(&world);
    let right = record(&dir, 0);
    let (epoch, _) = right.iter().enumerate().rfind(|(_, it)| !it.taken.is_empty()).unwrap();
    type Forge = fn(&mut Arrivals);
    let wrong: [(Forge, &str); 4] = [
        (|it| it.taken[0].1 = 900, "is not in that island's journal"),
        (|it| it.taken[0].0 = 0, "not from a neighbour"),
        (|it| it.generation += 1, "is not in its place"),
        (|it| it.taken.truncate(it.taken.len() - 1), "disagrees with the report"),
    ];
    for (change, expected) in wrong {
        forge(&dir, 0, |records| change(&mut records[epoch]));
        let table = world.islands("verify run");
        assert_eq!(table.code, Some(1), "{table:?}");
        assert!(table.stderr.contains(expected), "{expected}: {table:?}");
        forge(&dir, 0, |records| records.clone_from(&right));
    }
    (0..).zip(&forged).for_each(|(island, record)| forge(&dir, island, |it| it.clone_from(record)));
    assert_eq!(world.islands("verify run").code, Some(0), "nothing contradicts it");
    let table = world.islands("verify run --thorough");
    let found = "what the islands took in leads to ";
    assert!(table.code == Some(1) && table.stderr.contains(found), "{table:?}");
}

/// The records of the run, but for one outbox, instead of which an older one of the same sender is on record, so that
/// they lead to another digest; none if no arrival matters.
fn forgery(world: &World) -> Option<Vec<Vec<Arrivals>>> {
    let config = Config::read(&dir(world).config()).unwrap();
    let right = records(&dir(world));
    let mut forgeries = Vec::new();
    let places = (0..ISLANDS).flat_map(|i| (0..right[0].len()).map(move |e| (i, e)));
    for (island, epoch) in places {
        for place in 0..right[island as usize][epoch].taken.len() {
            let mut forged = right.clone();
            let (_, taken) = &mut forged[island as usize][epoch].taken[place];
            *taken = taken.saturating_sub(1);
            let own = &forged[island as usize];
            let is_possible = check_record(own, &config.archipelago(), island).is_ok();
            forgeries.extend((is_possible && forged != right).then_some(forged));
        }
    }
    let right = replayed(world, &right);
    let is_other = |forged: &Vec<Vec<Arrivals>>| replayed(world, forged) != right;
    // What comes late is less likely to be outlived.
    forgeries.into_iter().rev().find(is_other)
}
