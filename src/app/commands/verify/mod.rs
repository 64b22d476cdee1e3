//! `islands verify`: whether a run's folder holds what it claims.
//!
//! `records` reads what each island left, and `rules` says what must hold of it; `ancestry`
//! breeds the champions again; `arrivals` evolves again where islands did not wait for each other; `claims` compares it
//! with the files of the whole run; `retrial` simulates again. Each finds its `check`s, the rows of the table.
//!
//! Nothing is written, and a folder may hold anything: what is wrong is a sentence, not an end.

mod ancestry;
mod arrivals;
mod check;
mod claims;
mod records;
mod retrial;
mod rules;

use crate::app::args::cli::VerifyArgs;
use crate::app::console::print;
use crate::app::table;
use crate::runs::catalogue::Visitor;
use crate::runs::config::{Config, FILE_BYTES_MAX, SeedGenomes};
use crate::runs::seeds;
use crate::runs::subject::Subject;
use crate::runs::{Failure, terrains};
use crate::store::{RunDir, StoreError, file};
use check::{Check, counted};
use records::Records;
use retrial::{Mismatch, Retrial};
use rules::Terms;
use serde::Serialize;
use std::io::ErrorKind;

/// Verifies the run in a folder.
///
/// # Errors
/// With exit code 1 if something is not as it is claimed, with 2 if there is no run or it is under way.
pub fn run(args: &VerifyArgs) -> Result<(), Failure> {
    if args.threads == Some(0) {
        return Err(Failure::usage("--threads must be at least 1"));
    }
    let dir = RunDir::at(&args.dir);
    let verdict = match configuration(&dir)? {
        Ok(config) => {
            let (dir, config, thorough) = (&dir, &config, args.thorough);
            pool(args)?.install(|| config.visit(Examination { dir, config, thorough }))
        }
        Err(obstacle) => Verdict::without_configuration(obstacle),
    };
    let wrong = verdict.wrong();
    if !wrong.is_empty() {
        // A run that was resumed meanwhile is not the one that was looked at.
        at_rest(&dir)?;
    }
    match args.json {
        true => print(&verdict.json(&dir)),
        false => print(&verdict.table()),
    }
    let Some(first) = wrong.first() else { return Ok(()) };
    Err(Failure::failed(format!(
        "the run in {} does not hold what it claims, in {}: {}",
        dir.path().display(),
        check::counted(wrong.len(), "place"),
        table::harmless(first),
    )))
}

fn pool(args: &VerifyArgs) -> Result<rayon::ThreadPool, Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))
}

/// A file without which nothing can be said of a run.
struct Obstacle {
    /// The file's name.
    file: &'static str,
    /// What is wrong with it, a sentence.
    reason: String,
}

impl Obstacle {
    fn configuration(reason: impl Into<String>) -> Self {
        Self { file: "run.toml", reason: reason.into() }
    }
}

/// The configuration of the run in a folder, or what is wrong with what it is read from.
fn configuration(dir: &RunDir) -> Result<Result<Config, Obstacle>, Failure> {
    // Opening a pipe would wait for its other end.
    if !dir.path().is_dir() {
        return Err(Failure::no_run(dir));
    }
    at_rest(dir)?;
    match file::read_text(&dir.config(), FILE_BYTES_MAX) {
        Err(StoreError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
            Err(Failure::no_run(dir))
        }
        Err(error) => Ok(Err(Obstacle::configuration(error.to_string()))),
        Ok(text) => Ok(launched(&text, dir)),
    }
}

/// Makes sure that nobody is at work in a run's folder.
fn at_rest(dir: &RunDir) -> Result<(), Failure> {
    match dir.is_under_way() {
        Ok(false) => Ok(()),
        Ok(true) => Err(Failure::usage(format!(
            "the run in {} is under way: stop it first, or wait until it has finished",
            dir.path().display()
        ))),
        Err(error) => Err(Failure::usage(error.to_string())),
    }
}

/// The configuration of a run that was launched.
fn launched(text: &str, dir: &RunDir) -> Result<Config, Obstacle> {
    let damaged = |reason: &str| {
        Obstacle::configuration(format!("{} is damaged: {reason}", dir.config().display()))
    };
    let mut config = Config::parse(text).map_err(|reason| damaged(&reason))?;
    terrains::read(&mut config.terrain, dir)
        .map_err(|failure| Obstacle { file: "terrain.csv", reason: failure.message })?;
    config.check_values().map_err(|failure| damaged(&failure.message))?;
    if !config.is_launched() {
        return Err(damaged("it names no seed or no launch, as that of every run does"));
    }
    Ok(config)
}

/// A run that is to be looked through.
struct Examination<'a> {
    dir: &'a RunDir,
    config: &'a Config,
    thorough: bool,
}

impl Visitor for Examination<'_> {
    type Output = Verdict;

    fn visit<P: Subject>(self, problem: P) -> Verdict {
        examine(self.dir, self.config, &problem, self.thorough)
    }
}

fn examine<P: Subject>(dir: &RunDir, config: &Config, problem: &P, thorough: bool) -> Verdict {
    let summary = claims::SummaryFile::read(dir);
    let terms = Terms::new(config, summary.is_of_the_end(config.generations), problem);
    let (records, mut checks) = Records::<P::Gene>::read(dir, &terms);
    let sound = checks.iter().all(Check::is_fine);
    checks.push(ancestry::check(dir, problem, &terms, &records, sound));
    checks.insert(0, check_version(&terms));
    if let Some(said) = &config.seed_genomes {
        checks.insert(1, check_seeds(dir, problem, said));
    }
    let mut digest = None;
    if terms.finished {
        let (found, claims) = claims::check(dir, problem, &terms, &records, &summary, sound);
        digest = found;
        checks.extend(claims);
        checks.extend(arrivals::replay(dir, problem, &terms, &records, thorough, sound));
    } else {
        checks.push(claims::none_yet(&terms, &records));
    }
    Verdict {
        finished: terms.finished,
        digest,
        champions: records.champions.iter().map(Vec::len).sum(),
        checks,
        retrial: Some(retrial::retry(&records.claims(thorough, &terms), config, problem)),
    }
}

/// Another version may compute otherwise; whether it does, simulating again shows.
fn check_version(terms: &Terms) -> Check {
    let shown: String = terms.config.version().chars().take(24).collect();
    let mut check = Check::of("run.toml").checked(format!("version {shown}"));
    if !terms.is_of_this_version() {
        check.note(concat!("ok, but this is version ", env!("CARGO_PKG_VERSION")));
    }
    check
}

/// Whether the genomes that the run began with are still what its configuration says.
fn check_seeds<P: Subject>(dir: &RunDir, problem: &P, said: &SeedGenomes) -> Check {
    let mut check = Check::of("seed-genomes.csv").checked(counted(said.count, "genome"));
    if let Err(failure) = seeds::load(problem, dir, said) {
        check.damaged(failure.message);
    }
    check
}

/// What came of it all.
struct Verdict {
    finished: bool,
    digest: Option<String>,
    champions: usize,
    checks: Vec<Check>,
    retrial: Option<Retrial>,
}

/// The same for programs.
#[derive(Serialize)]
struct Report<'a> {
    ok: bool,
    run_dir: String,
    finished: bool,
    /// The digest of the final populations as they are found.
    digest: Option<&'a str>,
    /// Champions that are recorded.
    champions: usize,
    /// Genomes that were simulated again.
    simulated: usize,
    /// What got another fitness than is recorded.
    mismatches: &'a [Mismatch],
    /// What else is wrong, a sentence each.
    damaged: Vec<&'a String>,
    /// What is worth a word and not wrong, a sentence each.
    notes: Vec<&'a String>,
    version: &'static str,
}

impl Verdict {
    /// Without its configuration, and what creatures stand on, nothing can be said of a run.
    fn without_configuration(Obstacle { file, reason }: Obstacle) -> Self {
        let mut check = Check::of(file);
        check.damaged(reason);
        let mut others = Check::of("all else");
        others.note(format!("not checked: {file} is damaged"));
        let checks = vec![check, others];
        Self { finished: false, digest: None, champions: 0, checks, retrial: None }
    }

    /// What is wrong, a sentence each.
    fn wrong(&self) -> Vec<String> {
        let damage = self.checks.iter().flat_map(Check::damage).cloned();
        let mismatches = self.retrial.iter().flat_map(|retrial| &retrial.mismatches);
        damage.chain(mismatches.map(ToString::to_string)).collect()
    }

    fn table(&self) -> String {
        let mut rows = vec![["what", "how much", "result"].map(str::to_owned)];
        rows.extend(self.checks.iter().flat_map(Check::rows));
        rows.extend(self.retrial.iter().flat_map(|retrial| retrial.check().rows()));
        table::lay_out(&rows)
    }

    fn json(&self, dir: &RunDir) -> String {
        let retrial = self.retrial.as_ref();
        let report = Report {
            ok: self.wrong().is_empty(),
            run_dir: dir.path().display().to_string(),
            finished: self.finished,
            digest: self.digest.as_deref(),
            champions: self.champions,
            simulated: retrial.map_or(0, |retrial| retrial.simulated),
            mismatches: retrial.map_or(&[], |retrial| &retrial.mismatches),
            damaged: self.checks.iter().flat_map(Check::damage).collect(),
            notes: self.checks.iter().flat_map(Check::notes).collect(),
            version: env!("CARGO_PKG_VERSION"),
        };
        serde_json::to_string(&report).expect("it is plain data, its numbers finite")
    }
}
