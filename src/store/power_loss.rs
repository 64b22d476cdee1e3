//! Power may be lost at any moment: what the disk holds then leads to the same end.

use super::entry::Entry;
use super::watched_disk::{Disk, Remains};
use super::{Journal, JournalReader, Logbook, RecordLog, Restored, RunDir};
use crate::archipelago::{
    Action, Archipelago, Arrivals, Digest, ExchangeMode, Island, Migration, Outbox, Protocol,
    Report, Step, Topology, lockstep,
};
use crate::evolution::{Founders, Strategy};
use crate::problems::bits::{Bit, Bits, Pattern};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

const ISLANDS: u32 = 2;
const GENERATIONS: u32 = 8;
const CHECKPOINT_INTERVAL: u32 = 2;
const PROBLEM: Bits = Bits { pattern: Pattern::OneMax, bits: 12, block: 1 };
/// All is over in a tenth of it.
const ROUNDS_MAX: u32 = 1_000;

#[test]
fn power_that_is_lost_at_any_moment_costs_no_bit() {
    let archipelago = archipelago(ExchangeMode::Sync);
    let Watched { digest, remains, .. } = watched(&archipelago);
    assert!(remains.len() > 200, "{} moments", remains.len());
    for remains in remains {
        let folder = laid_out(&remains);
        let again = evolve(folder.path(), &archipelago, &remains.promised);
        assert_eq!(Digest::of(&again), digest, "{:?}", remains.files.keys());
    }
}

/// What is left is the beginning of what was recorded, and reaches as far as was promised; the run goes on from it, and
/// what it has recorded in the end is what it evolved.
#[test]
fn where_nobody_waits_power_that_is_lost_costs_nothing_that_was_taken_in() {
    let archipelago = archipelago(ExchangeMode::Async);
    let Watched { digest, records: whole, remains } = watched(&archipelago);
    assert!(remains.len() > 200, "{} moments", remains.len());
    assert!(whole.iter().all(|record| record.arrivals.iter().any(|it| !it.taken.is_empty())));
    assert_eq!(evolved_again(&whole, &archipelago), (digest, whole.clone()));
    for remains in remains {
        let folder = laid_out(&remains);
        let left = Record::all(folder.path());
        for (index, (left, whole)) in (0..).zip(left.iter().zip(&whole)) {
            assert!(left.begins(whole), "island {index} recorded {whole:?}, and left {left:?}");
            let promised =
                remains.promised.get(&index).map_or(0, |&it| archipelago.migration.begun(it));
            assert!(left.arrivals.len() >= promised as usize, "island {index}: {left:?}");
        }
        let again = evolve(folder.path(), &archipelago, &remains.promised);
        let records = Record::all(folder.path());
        for (left, record) in left.iter().zip(&records) {
            assert!(left.begins(record), "{left:?} was changed to {record:?}");
        }
        assert_eq!(evolved_again(&records, &archipelago), (Digest::of(&again), records.clone()));
    }
}

/// A run to its end that nobody disturbed.
struct Watched {
    digest: Digest,
    records: Vec<Record>,
    /// What a loss of power may leave at any moment.
    remains: BTreeSet<Remains>,
}

fn watched(archipelago: &Archipelago) -> Watched {
    let folder = in_memory();
    Disk::watch(folder.path());
    let islands = evolve(folder.path(), archipelago, &BTreeMap::new());
    let remains = Disk::take();
    Watched { digest: Digest::of(&islands), records: Record::all(folder.path()), remains }
}

/// What an island has on record.
#[derive(Debug, Clone, PartialEq)]
struct Record {
    arrivals: Vec<Arrivals>,
    sent: Vec<Outbox<Bit>>,
    reports: Vec<Report>,
}

impl Record {
    /// Of each island, as far as a folder holds it.
    fn all(folder: &Path) -> Vec<Self> {
        let dir = RunDir::at(folder);
        (0..ISLANDS).map(|index| Self::of(&dir, index)).collect()
    }

    fn of(dir: &RunDir, index: u32) -> Self {
        let arrivals = RecordLog::<Arrivals>::read(&dir.arrivals(index));
        let reports = RecordLog::<Entry>::read(&dir.reports(index)).expect("it is readable");
        Self {
            arrivals: arrivals.expect("it is readable").records,
            sent: RecordLog::read(&dir.migrations(index)).expect("it is readable").records,
            reports: reports.records.into_iter().map(|entry| entry.report).collect(),
        }
    }

    fn begins(&self, whole: &Self) -> bool {
        whole.arrivals.starts_with(&self.arrivals)
            && whole.sent.starts_with(&self.sent)
            && whole.reports.starts_with(&self.reports)
    }
}

/// What evolves from the seed and what islands recorded that they took in, and what they would have on record then.
fn evolved_again(records: &[Record], archipelago: &Archipelago) -> (Digest, Vec<Record>) {
    let arrivals: Vec<_> = records.iter().map(|record| record.arrivals.clone()).collect();
    let mut again: Vec<_> = arrivals
        .iter()
        .map(|arrivals| Record { arrivals: arrivals.clone(), sent: vec![], reports: vec![] })
        .collect();
    let observe = |step: &Step<Bit>| {
        let record = &mut again[step.island.index as usize];
        record.sent.extend(step.outbox.clone());
        record.reports.push(step.report);
    };
    let none = &Founders::NONE;
    let islands = lockstep::replay(&PROBLEM, none, archipelago, GENERATIONS, &arrivals, observe)
        .expect("all that was taken in was sent");
    (Digest::of(&islands), again)
}

fn archipelago(exchange: ExchangeMode) -> Archipelago {
    let strategy = Strategy { population: 6, elites: 1, ..Strategy::default() };
    let migration = Migration { interval: 2, exchange, ..Migration::default() };
    Archipelago { islands: ISLANDS, seed: 5, topology: Topology::Ring, migration, strategy }
}

fn in_memory() -> TempDir {
    tempfile::tempdir_in("/dev/shm").expect("there is memory")
}

fn laid_out(remains: &Remains) -> TempDir {
    let folder = in_memory();
    for (path, content) in &remains.files {
        let path = folder.path().join(path);
        match content {
            Some(content) => std::fs::write(path, content),
            None => std::fs::create_dir(path),
        }
        .expect("folders come before what is in them");
    }
    folder
}

/// An island as its process has it.
struct Process<'a> {
    protocol: Protocol<'a, Bits>,
    logbook: Logbook<Bit>,
}

/// Evolves all islands in turn to the end, from what a folder holds, as their processes do. It holds at least what was
/// promised: a generation of each island.
fn evolve(
    folder: &Path,
    archipelago: &Archipelago,
    promised: &BTreeMap<u32, u32>,
) -> Vec<Island<Bit>> {
    let dir = RunDir::at(folder);
    let claim = dir.claim().expect("nobody else has it");
    claim.make_folders(archipelago.islands).expect("there is room");
    claim.make_arrivals().expect("there is room");
    let born = |index| Process::begin(&dir, archipelago, index);
    let mut processes: Vec<Process> = (0..archipelago.islands).map(born).collect();
    for (&island, promised) in promised {
        let kept = processes[island as usize].protocol.island().map(|island| island.generation);
        assert!(kept.as_ref() >= Some(promised), "island {island} lost generation {promised}");
    }
    for round in 0..ROUNDS_MAX {
        if processes.iter().all(Process::has_arrived) {
            return processes.iter().filter_map(|it| it.protocol.island().cloned()).collect();
        }
        for index in 0..archipelago.islands {
            let now = Duration::from_secs(round.into());
            let action = processes[index as usize].protocol.advance(now);
            act(&dir, archipelago, &mut processes, index, action);
        }
    }
    panic!("it does not end");
}

impl<'a> Process<'a> {
    fn begin(dir: &RunDir, archipelago: &'a Archipelago, index: u32) -> Self {
        let Restored { logbook, island, arrivals, .. } =
            Logbook::open(dir, archipelago, index, "").expect("what is durable is readable");
        let protocol = Protocol::begin(&PROBLEM, archipelago, index, GENERATIONS, island);
        Self { protocol: protocol.with_record(arrivals), logbook }
    }

    fn has_arrived(&self) -> bool {
        self.protocol.island().is_some_and(|island| island.generation == GENERATIONS)
    }

    fn record(&mut self, step: &Step<Bit>) {
        self.logbook.record(step, 0.0).expect("it comes out the same");
        if step.island.generation.is_multiple_of(CHECKPOINT_INTERVAL) {
            self.logbook.save(&step.island).expect("there is room");
            Disk::promise(step.island.index, step.island.generation);
        }
    }
}

/// Does what island `index` does next.
fn act(
    dir: &RunDir,
    archipelago: &Archipelago,
    processes: &mut [Process],
    index: u32,
    action: Action<Bit>,
) {
    let this = index as usize;
    match action {
        Action::Evolved(step) => {
            processes[this].record(&step);
            if let Some(outbox) = step.outbox {
                for neighbour in archipelago.out_neighbours(index) {
                    processes[neighbour as usize].protocol.receive(outbox.clone());
                }
            }
        }
        Action::Ask { sources, epoch } => {
            for source in sources {
                let asked = Journal::read(&dir.migrations(source), epoch..epoch + 1);
                for outbox in asked.expect("what is durable is readable") {
                    processes[this].protocol.receive(outbox);
                }
            }
        }
        Action::Record(arrivals) => {
            processes[this].logbook.record_arrivals(&arrivals).expect("there is room");
        }
        Action::Recall(outboxes) => {
            for (source, epoch) in outboxes {
                let mut journal = JournalReader::of(dir.migrations(source));
                let outbox = journal.outbox(epoch).expect("what is durable is readable");
                outbox.into_iter().for_each(|outbox| processes[this].protocol.recall(outbox));
            }
        }
        Action::Wait | Action::Arrived => {}
    }
}
