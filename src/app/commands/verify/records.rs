//! What the islands of a run left, read and checked.

use super::check::{Check, counted};
use super::retrial::{Claim, Measure};
use super::rules::Terms;
use crate::archipelago::{Arrivals, Births, Champion, Island, Outbox};
use crate::evolution::{Fitness, Gene, Individual};
use crate::formats::metrics;
use crate::runs::kept::Candidates;
use crate::store::{Checkpoints, Entry, RecordLog, RunDir};
use serde::{Serialize, de::DeserializeOwned};
use std::ops::RangeInclusive;
use std::path::Path;

/// The whole records of every island, in the order of their index.
pub struct Records<G> {
    /// The newest state of each island that is as it must be; those without one are left out.
    pub states: Vec<Island<G>>,
    /// Each island's champions.
    pub champions: Vec<Vec<Champion<G>>>,
    /// Each island's generations.
    pub reports: Vec<Vec<Entry>>,
    /// Who was born on each island.
    pub lineages: Vec<Vec<Births>>,
    /// What each island sent.
    pub outboxes: Vec<Vec<Outbox<G>>>,
    /// What each island took in, where that is recorded.
    pub arrivals: Vec<Vec<Arrivals>>,
}

impl<G: Gene> Records<G> {
    /// Reads what there is of every island, and says what is wrong with it.
    pub fn read(dir: &RunDir, terms: &Terms) -> (Self, Vec<Check>) {
        let mut records = Self {
            states: Vec::new(),
            champions: Vec::new(),
            reports: Vec::new(),
            lineages: Vec::new(),
            outboxes: Vec::new(),
            arrivals: Vec::new(),
        };
        let mut reader = Reader::new(dir, terms);
        (0..terms.config.islands).for_each(|island| reader.island(island, &mut records));
        let checks = reader.checks(&records);
        (records, checks)
    }

    /// The rows of the metrics: of all islands, ordered by generation, then island.
    pub fn rows(&self) -> Vec<metrics::Row> {
        let entries = self.reports.iter().flatten();
        let mut rows: Vec<_> =
            entries.map(|entry| metrics::Row::new(&entry.report, entry.seconds)).collect();
        rows.sort_by_key(|row| (row.generation, row.island));
        rows
    }

    /// How long the slowest island evolved, in seconds.
    pub fn seconds(&self) -> f64 {
        let seconds = |entries: &Vec<Entry>| entries.iter().map(|entry| entry.seconds).sum();
        self.reports.iter().map(seconds).fold(0.0, f64::max)
    }

    /// The final states, if all are there.
    pub fn finals(&self, terms: &Terms) -> Option<&[Island<G>]> {
        let is_final = |state: &Island<G>| state.generation == terms.config.generations;
        let all = self.states.len() == terms.config.islands as usize;
        (all && self.states.iter().all(is_final)).then_some(&self.states)
    }

    /// Who of all champions may be kept.
    pub fn candidates(&self) -> Candidates<G> {
        let mut candidates = Candidates::none();
        for (island, champions) in (0..).zip(&self.champions) {
            champions.iter().for_each(|champion| candidates.see(island, &champion.individual));
        }
        candidates
    }

    /// All who are said to have a fitness: champions; thoroughly, also those who live in the newest states and all
    /// who migrated.
    pub fn claims<'a>(&'a self, thorough: bool, terms: &Terms) -> Vec<Claim<'a, G>> {
        let champions = (0..).zip(&self.champions).flat_map(|(island, champions)| {
            champions.iter().map(move |champion| (island, champion))
        });
        let claim = move |who, by, island, generation, individual: &'a Individual<G>| {
            let fitness = individual.fitness;
            Claim { who, island, generation, genome: &individual.genome, fitness, by }
        };
        let champions = champions.flat_map(move |(island, champion): (u32, &'a Champion<G>)| {
            let Champion { generation, ref individual, validated } = *champion;
            let own = claim("champion", Measure::Whole, island, generation, individual);
            let fitness = validated.unwrap_or(Fitness::WORST);
            let by = Measure::Fresh;
            let other = Claim { who: "validated champion", fitness, by, ..own };
            let other = terms.is_validated.then_some(other);
            std::iter::once(own).chain(other)
        });
        let residents = self.states.iter().flat_map(|state| {
            let Island { index: island, generation, .. } = *state;
            let claim = move |individual| {
                claim("resident", Measure::Estimate, island, generation, individual)
            };
            state.population.iter().map(claim)
        });
        let interval = terms.config.migration_interval;
        let migrants = self.outboxes.iter().flatten().flat_map(|outbox| {
            let island = outbox.island;
            let generation = outbox.epoch.saturating_add(1).saturating_mul(interval);
            let claim =
                move |individual| claim("migrant", Measure::Whole, island, generation, individual);
            outbox.migrants.iter().map(claim)
        });
        match thorough {
            true => champions.chain(residents).chain(migrants).collect(),
            false => champions.collect(),
        }
    }
}

/// Reads one island after another.
struct Reader<'a> {
    dir: &'a RunDir,
    terms: &'a Terms<'a>,
    /// Checkpoints that there are, whole or not.
    files: usize,
    checkpoints: Check,
    reports: Check,
    lineages: Check,
    champions: Check,
    migrations: Check,
    arrivals: Option<Check>,
}

impl<'a> Reader<'a> {
    fn new(dir: &'a RunDir, terms: &'a Terms<'a>) -> Self {
        Self {
            dir,
            terms,
            files: 0,
            checkpoints: Check::of("checkpoints"),
            reports: Check::of("reports"),
            lineages: Check::of("lineages"),
            champions: Check::of("champions"),
            migrations: Check::of("migrations"),
            arrivals: terms.is_async().then(|| Check::of("arrivals")),
        }
    }

    fn island<G: Gene>(&mut self, island: u32, records: &mut Records<G>) {
        let Self { dir, terms, .. } = *self;
        let (newest, files) = self.newest_state(island);
        let state = newest.as_ref();

        let span = terms.span(state, |generation| generation + 1);
        let rule = |entries: &[Entry]| terms.reports(island, entries, state);
        let reports = read_log(&dir.reports(island), &mut self.reports, terms, span, rule);
        if files == 0 && reports.len() > 1 {
            self.checkpoints.damaged(format_args!(
                "there is no checkpoint of island {island}, which has evolved {}",
                counted(reports.len(), "generation")
            ));
        }

        let span = terms.span(state, |generation| generation + 1);
        let rule = |births: &[_]| terms.lineages(island, births, &reports, state);
        let lineages = read_log(&dir.lineages(island), &mut self.lineages, terms, span, rule);

        let span = usize::from(state.is_some())..=terms.config.generations as usize + 1;
        let rule = |champions: &[_]| terms.champions(champions, &reports, state);
        let champions = read_log(&dir.champions(island), &mut self.champions, terms, span, rule);

        let span = terms.span(state, |generation| terms.epochs(generation));
        let rule = |outboxes: &[_]| terms.outboxes(island, outboxes, &reports);
        let outboxes = read_log(&dir.migrations(island), &mut self.migrations, terms, span, rule);

        if let Some(check) = &mut self.arrivals {
            let span = terms.span(state, |generation| terms.begun(generation));
            let rule = |record: &[_]| terms.arrivals(island, record, &reports);
            records.arrivals.push(read_log(&dir.arrivals(island), check, terms, span, rule));
        }

        records.states.extend(newest);
        records.reports.push(reports);
        records.lineages.push(lineages);
        records.champions.push(champions);
        records.outboxes.push(outboxes);
    }

    /// The newest state of an island that is as it must be, and how many checkpoints there are.
    fn newest_state<G: Gene>(&mut self, island: u32) -> (Option<Island<G>>, usize) {
        let last = self.dir.checkpoint(island, self.terms.config.generations);
        let (mut newest, mut files, mut lacks_last) = (None, 0, self.terms.finished);
        let folder = Checkpoints::of(self.dir, island);
        let checkpoints = match folder.load() {
            Ok(checkpoints) => checkpoints,
            Err(error) => {
                self.checkpoints.damaged(error);
                return (None, 0);
            }
        };
        for (path, checkpoint) in checkpoints {
            files += 1;
            lacks_last &= path != last;
            match checkpoint {
                Err(error) => self.checkpoints.damaged(error),
                Ok(checkpoint) => {
                    let judged = self.terms.state(&checkpoint);
                    newest = newest.or(judged.is_ok().then_some(checkpoint.island));
                    self.checkpoints.judge(&path, judged);
                }
            }
        }
        if lacks_last {
            self.checkpoints.damaged(format_args!("{} is missing", last.display()));
        }
        self.files += files;
        (newest, files)
    }

    /// The rows of the table.
    fn checks<G>(self, records: &Records<G>) -> Vec<Check> {
        fn all<T>(logs: &[Vec<T>]) -> usize {
            logs.iter().map(Vec::len).sum()
        }
        let Self { files, checkpoints, reports, lineages, champions, migrations, arrivals, .. } =
            self;
        let births = records.lineages.iter().flatten().map(|births| births.births.len()).sum();
        let mut checks = vec![
            checkpoints.checked(counted(files, "file")),
            reports.checked(counted(all(&records.reports), "generation")),
            lineages.checked(counted(births, "birth")),
            champions.checked(counted(all(&records.champions), "champion")),
            migrations.checked(counted(all(&records.outboxes), "epoch")),
        ];
        checks.extend(arrivals.map(|check| {
            match_journals(self.dir, records, check)
                .checked(counted(all(&records.arrivals), "epoch"))
        }));
        checks
    }
}

/// The whole records of a log, of which there must be so many and for which a rule must hold.
fn read_log<T: Serialize + DeserializeOwned>(
    path: &Path,
    check: &mut Check,
    terms: &Terms,
    span: RangeInclusive<usize>,
    rule: impl FnOnce(&[T]) -> Result<(), String>,
) -> Vec<T> {
    let (records, torn_bytes) = match RecordLog::<T>::read(path) {
        Ok(contents) => (contents.records, contents.torn_bytes),
        Err(error) => {
            check.damaged(error);
            return Vec::new();
        }
    };
    let judged =
        judge_length(records.len(), torn_bytes, span, terms.finished).and_then(|()| rule(&records));
    if torn_bytes > 0 && judged.is_ok() {
        check.note(format!(
            "ok, but {} ends in a torn record of {torn_bytes} bytes, which a resume writes again",
            path.display()
        ));
    }
    check.judge(path, judged);
    records
}

/// Whether a log may have so many whole records, and what follows them.
fn judge_length(
    records: usize,
    torn_bytes: u64,
    span: RangeInclusive<usize>,
    finished: bool,
) -> Result<(), String> {
    let found = counted(records, "whole record");
    let tail = match torn_bytes {
        0 => String::new(),
        bytes => format!(", followed by {bytes} bytes that are none"),
    };
    if records < *span.start() {
        Err(format!("it has {found} where there must be {}{tail}", span.start()))
    } else if records > *span.end() {
        Err(format!("it has {found} where there can be {}{tail}", span.end()))
    } else if torn_bytes > 0 && finished {
        Err(format!("it has {found}{tail}"))
    } else {
        Ok(())
    }
}

/// Says of each outbox that an island took in whether it is in its sender's journal.
fn match_journals<G>(dir: &RunDir, records: &Records<G>, mut check: Check) -> Check {
    for (island, record) in (0..).zip(&records.arrivals) {
        let taken = record.iter().flat_map(|arrivals| &arrivals.taken);
        for &(source, epoch) in taken {
            let sent = records.outboxes.get(source as usize).map_or(0, Vec::len);
            if epoch as usize >= sent {
                let reason =
                    format!("epoch {epoch} of island {source} is not in that island's journal");
                check.judge(&dir.arrivals(island), Err(reason));
            }
        }
    }
    check
}
