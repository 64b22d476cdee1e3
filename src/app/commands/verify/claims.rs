//! What the files of the whole run claim, compared with what its islands left.

use super::check::{Check, counted};
use super::records::Records;
use super::rules::Terms;
use crate::archipelago::{Digest, Island};
use crate::evolution::{Gene, Individual};
use crate::formats::metrics;
use crate::runs::subject::Subject;
use crate::runs::summary;
use crate::store::{RunDir, StoreError, file};
use serde_json::{Map, Value};
use std::io::ErrorKind;
use std::path::Path;

/// What a summary says that depends on where the run's folder is, or on who looks at it.
const FREE: [&str; 4] = ["best_genome", "run_dir", "recording", "version"];

/// What stands in the place of `summary.json`.
pub enum SummaryFile {
    /// There is none.
    Missing,
    /// Something else, and why it is none.
    Damaged(String),
    /// One, whatever it says.
    Whole(Map<String, Value>),
}

impl SummaryFile {
    /// Reads it.
    pub fn read(dir: &RunDir) -> Self {
        let path = dir.summary();
        let bytes = match file::read(&path, summary::SUMMARY_BYTES_MAX) {
            Ok(bytes) => bytes,
            Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                return Self::Missing;
            }
            Err(error) => return Self::Damaged(error.to_string()),
        };
        let damaged = |reason| Self::Damaged(format!("{} is damaged: {reason}", path.display()));
        serde_json::from_slice(&bytes).map_or_else(|error| damaged(error.to_string()), Self::Whole)
    }

    /// Whether it is that of a run of so many generations, or may have been before it was damaged. One of fewer
    /// is left from before the run was prolonged.
    pub fn is_of_the_end(&self, generations: u32) -> bool {
        match self {
            Self::Missing => false,
            Self::Damaged(_) => true,
            Self::Whole(said) => {
                let claimed = said.get("generations").and_then(Value::as_u64);
                claimed.is_none_or(|claimed| claimed >= u64::from(generations))
            }
        }
    }

    fn says(&self, key: &str) -> Option<&Value> {
        match self {
            Self::Whole(said) => said.get(key),
            _ => None,
        }
    }
}

/// The row of a run that has not finished.
pub fn none_yet<G: Gene>(terms: &Terms, records: &Records<G>) -> Check {
    let mut check = Check::of("digest");
    let generations = terms.config.generations;
    // An island without a state begins from the seed.
    let all = records.states.len() == terms.config.islands as usize;
    let slowest = records.states.iter().map(|state| state.generation).min();
    check.note(format!(
        "none yet: the run has not finished, and may be resumed from generation {} of {generations}",
        slowest.filter(|_| all).unwrap_or(0)
    ));
    check
}

/// Checks the claims of a run that has finished; `sound` says that nothing is wrong with its records. The digest
/// that its final populations have, if they are there, comes first.
pub fn check<P: Subject>(
    dir: &RunDir,
    problem: &P,
    terms: &Terms,
    records: &Records<P::Gene>,
    summary: &SummaryFile,
    sound: bool,
) -> (Option<String>, Vec<Check>) {
    let finals = records.finals(terms);
    let digest = finals.map(|finals| Digest::of(finals).to_string());
    let best = finals.and_then(|_| records.candidates().kept(problem));
    let best = best.as_ref();
    let ending = finals.filter(|_| sound).zip(best);
    let ending = ending.map(|(islands, (island, best))| Ending { islands, best: (*island, best) });
    let checks = vec![
        check_digest(dir, digest.as_deref(), summary, records.states.len()),
        check_summary(dir, problem, terms, ending, records, summary),
        check_champion(dir, problem, terms, best.map(|(_, champion)| champion)),
        check_metrics(dir, terms, records, sound),
    ];
    (digest, checks)
}

/// What a run has come to.
struct Ending<'a, G> {
    islands: &'a [Island<G>],
    /// The champion that it keeps, and its island.
    best: (u32, &'a Individual<G>),
}

fn check_digest(dir: &RunDir, found: Option<&str>, summary: &SummaryFile, states: usize) -> Check {
    let mut check = Check::of("digest").checked(counted(states, "population"));
    let claimed = summary.says("digest").and_then(Value::as_str);
    match (found, claimed) {
        (None, _) => check.note("none: a final population is missing or damaged"),
        (Some(found), Some(claimed)) if found != claimed => check.damaged(format_args!(
            "{} claims {}, and the final populations have {found}",
            dir.summary().display(),
            claimed.chars().take(64).collect::<String>()
        )),
        (Some(found), _) => check.result(found),
    }
    check
}

fn check_summary<P: Subject>(
    dir: &RunDir,
    problem: &P,
    terms: &Terms,
    ending: Option<Ending<P::Gene>>,
    records: &Records<P::Gene>,
    summary: &SummaryFile,
) -> Check {
    let mut check = Check::of("summary").checked("summary.json");
    match (summary, ending) {
        (SummaryFile::Missing, _) => check.damaged("it is missing"),
        (SummaryFile::Damaged(reason), _) => check.damaged(reason),
        (SummaryFile::Whole(_), None) => check.note("not checked: what it sums up is damaged"),
        (SummaryFile::Whole(said), Some(Ending { islands, best })) => {
            let seconds = records.seconds();
            let right = summary::summarise(dir, terms.config, problem, islands, best, seconds);
            let right = serde_json::to_value(right).expect("a summary is plain data");
            let claims = right.as_object().into_iter().flatten();
            for (key, value) in claims.filter(|(key, _)| !FREE.contains(&key.as_str())) {
                let found = said.get(key);
                // A digest that is another one has a row of its own, and another version may say less.
                let is_elsewhere = key == "digest" && found.is_some_and(Value::is_string);
                let is_unknown = found.is_none() && !terms.is_of_this_version();
                if found != Some(value) && !is_elsewhere && !is_unknown {
                    check.judge(&dir.summary(), Err(format!("{key} must be {value}")));
                }
            }
        }
    }
    check
}

/// The files of the best individual must be those that a run writes for it.
fn check_champion<P: Subject>(
    dir: &RunDir,
    problem: &P,
    terms: &Terms,
    best: Option<&Individual<P::Gene>>,
) -> Check {
    let files = if P::HAS_BODIES { "champion.csv, .urdf" } else { "champion.csv" };
    let mut check = Check::of("champion").checked(files);
    let Some(champion) = best else {
        check.note("not checked: a final population is missing or damaged");
        return check;
    };
    let genome = &champion.genome;
    let mut right = Vec::new();
    problem.write_genome(genome, &mut right).expect("memory takes everything");
    compare(&mut check, &dir.champion_genome(), &right, "the best champion's genome");
    if let Some(right) = problem.body(genome).filter(|_| terms.is_of_this_version()) {
        compare(&mut check, &dir.champion_body(), &right, "the best champion's body");
    }
    check
}

fn check_metrics<G: Gene>(dir: &RunDir, terms: &Terms, records: &Records<G>, sound: bool) -> Check {
    let mut check = Check::of("metrics").checked("metrics.csv");
    if !sound {
        check.note("not checked: the islands' records are damaged");
    } else if !terms.is_of_this_version() {
        check.note("not checked: another version may write other columns");
    } else {
        let mut right = Vec::new();
        metrics::write(records.rows().into_iter().map(Ok), true, &mut right)
            .expect("memory takes everything");
        // Runs of old have no such column.
        let older = metrics::without_species(&right).expect("it is a table");
        let found = file::read(&dir.metrics(), right.len());
        let is_older = found.as_ref().is_ok_and(|found| first_line(found) == first_line(&older));
        let right = if is_older { &older } else { &right };
        compare_read(&mut check, &dir.metrics(), found, right, "the reports of all islands");
    }
    check
}

fn first_line(text: &[u8]) -> Option<&[u8]> {
    text.split(|&byte| byte == b'\n').next()
}

/// A file that is written from something must be what would be written again.
fn compare(check: &mut Check, path: &Path, right: &[u8], source: &str) {
    compare_read(check, path, file::read(path, right.len()), right, source);
}

fn compare_read(
    check: &mut Check,
    path: &Path,
    found: Result<Vec<u8>, StoreError>,
    right: &[u8],
    source: &str,
) {
    let found = match found {
        Ok(found) => found,
        Err(error) => return check.damaged(error),
    };
    if found != right {
        let same = found.iter().zip(right).take_while(|(found, right)| found == right).count();
        let line = right[..same].iter().filter(|&&byte| byte == b'\n').count() + 1;
        check.judge(path, Err(format!("line {line} is not what {source} says")));
    }
}
