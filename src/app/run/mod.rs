//! `islands run` and `islands resume`: from what was asked for to the result.
//!
//! Here a run is made, or found again by [`resume`]. Then a [`supervisor`] sees it to its end: it starts the
//! [`crew`], child processes each ([`kin`]), hears what they say, and starts again who dies, unless that has no
//! hope ([`mortality`]). What happens is told and logged by a [`chronicle`], and how far it got is shown by
//! [`progress`].

mod chronicle;
mod crew;
mod kin;
mod mortality;
mod progress;
mod resume;
mod supervisor;

use super::Failure;
use super::cli::{OutputArgs, ResumeArgs, RunArgs};
use super::config::{self, Config};
use super::console::print;
use super::kinship::Ear;
use super::result::{self, Summary};
use super::{seeds, terrains};
use crate::creature::Gene;
use crate::store::{Claim, RunDir};
use crate::transport::{Domain, Harbour};
use rand::TryRng;
use rustix::fs::Mode;
use std::path::{Path, PathBuf};
use supervisor::Supervisor;

/// Runs a run from its first process to its result.
///
/// # Errors
/// With exit code 2, before anything was made, if what was asked for is impossible; with 1 if the run
/// failed; with 130 if it was interrupted.
pub fn run(args: &RunArgs) -> Result<(), Failure> {
    keep_private();
    let (config, founders) = resolve(args)?;
    let ear = Ear::to_signals()?;
    let dir = run_dir(args.out.as_deref(), &config);
    require_text(&dir)?;
    let domain = config.domain()?;
    let harbour = Harbour::create(&domain, &config.archipelago())?;
    let claim = dir.create().map_err(|error| {
        let go_on = match dir.config().exists() {
            true => format!(", or go on with it: {}", resume::command(&dir)),
            false => String::new(),
        };
        Failure::usage(format!("{error}; choose another folder with --out{go_on}"))
    })?;
    seeds::keep(&dir, &founders)?;
    terrains::keep(&dir, &config)?;
    write_config(&dir, &config)?;
    claim.make_folders(config.islands)?;
    Launch { config, dir, claim, domain, harbour, ear }.go(&args.output)
}

/// Goes on with a run, to the result that it would have had undisturbed.
///
/// # Errors
/// Like [`run`].
pub fn resume(args: &ResumeArgs) -> Result<(), Failure> {
    keep_private();
    let dir = RunDir::at(&args.dir);
    require_text(&dir)?;
    let ear = Ear::to_signals()?;
    let claim = resume::claim(&dir)?;
    let mut config = resume::config(&dir, &args.settings)?;
    if let Some(summary) = result::finished(&dir, &config) {
        // Its launcher may have been killed over its last words.
        Domain::remove_abandoned();
        present(&summary, &args.output);
        return Ok(());
    }
    seeds::founded(&dir, &config)?;
    config.launch = Some(new_launch()?);
    let domain = config.domain()?;
    let harbour = Harbour::create(&domain, &config.archipelago())?;
    claim.make_folders(config.islands)?;
    write_config(&dir, &config)?;
    Launch { config, dir, claim, domain, harbour, ear }.go(&args.output)
}

/// Everything that a run needs before its first process.
struct Launch {
    config: Config,
    dir: RunDir,
    claim: Claim,
    domain: Domain,
    harbour: Harbour<Gene>,
    ear: Ear,
}

impl Launch {
    fn go(self, output: &OutputArgs) -> Result<(), Failure> {
        let Self { config, dir, claim, domain, harbour, ear } = self;
        let supervised = Supervisor::launch(&config, &dir, &domain, &harbour, ear, output)
            .and_then(Supervisor::see_to_the_end);
        if supervised.is_err() {
            // What there is so far can be plotted; if not, there is a worse failure to tell of.
            let _ = result::write_metrics(&dir, &config);
        }
        let summary = supervised.and_then(|()| result::gather(&dir, &config));
        let summary = summary.map_err(|failure| resume::way_back(failure, &dir));
        let closed = harbour.close();
        drop(claim);
        present(&summary?, output);
        Ok(closed?)
    }
}

fn write_config(dir: &RunDir, config: &Config) -> Result<(), Failure> {
    Ok(dir.write(&dir.config(), |out| out.write_all(config.to_toml().as_bytes()))?)
}

/// JSON and command lines say where a run is, as text.
fn require_text(dir: &RunDir) -> Result<(), Failure> {
    match dir.path().to_str() {
        Some(_) => Ok(()),
        None => Err(Failure::usage(format!(
            "the folder's name {} is not UTF-8: choose another one",
            dir.path().display()
        ))),
    }
}

/// What this process and its children make is for this user only.
fn keep_private() {
    rustix::process::umask(Mode::RWXG | Mode::RWXO);
}

/// The complete configuration: flags over a file over defaults, with a seed; and the genomes to begin with.
fn resolve(args: &RunArgs) -> Result<(Config, Vec<Vec<Gene>>), Failure> {
    let mut config = match &args.config {
        Some(path) => args.settings.over(Config::read(path)?),
        None => args.settings.over(Config::default()),
    };
    if !args.changes.scales.is_empty() {
        config.scales = args.changes.scales.iter().cloned().collect();
    }
    terrains::find(&mut config, &args.terrain, args.config.as_deref())?;
    config.check()?;
    let dropped = &args.changes.drop_columns;
    let founders = seeds::find(&mut config, &args.seed_genomes, dropped, args.config.as_deref())?;
    if config.seed.is_none() {
        // Half of it is entropy enough, and a number that people can copy.
        config.seed = Some(entropy()? >> 32);
    }
    config.launch = Some(new_launch()?);
    Ok((config, founders))
}

fn new_launch() -> Result<config::Launch, Failure> {
    let run_id = Domain::new(entropy()?).to_string();
    Ok(config::Launch { version: env!("CARGO_PKG_VERSION").to_owned(), run_id })
}

/// The folder that was asked for, or a new one under `runs` that says what is in it.
fn run_dir(out: Option<&Path>, config: &Config) -> RunDir {
    if let Some(out) = out {
        return RunDir::at(out);
    }
    let name = format!("{}-seed{}", config.task, config.seed.unwrap_or_default());
    let free = |path: &PathBuf| !path.exists();
    let first = Path::new("runs").join(&name);
    let next = (2..).map(|i| Path::new("runs").join(format!("{name}-{i}")));
    RunDir::at(
        std::iter::once(first).chain(next).find(free).expect("there is always a next number"),
    )
}

/// What of a command says on which terrain a run was, if it kept one.
fn terrain_flag(run_dir: &Path) -> String {
    let kept = RunDir::at(run_dir).terrain();
    if kept.exists() { format!(" --terrain {}", kept.display()) } else { String::new() }
}

fn entropy() -> Result<u64, Failure> {
    rand::rngs::SysRng
        .try_next_u64()
        .map_err(|error| Failure::failed(format!("the system has no randomness: {error}")))
}

fn present(summary: &Summary, output: &OutputArgs) {
    if output.json {
        let json = serde_json::to_string(summary);
        print(&json.expect("a summary is plain data, its numbers finite"));
    } else {
        show(summary);
    }
}

fn show(summary: &Summary) {
    print(&format!(
        "best     {}, island {}\nfound in {} evaluations, {:.1} a second; {} failed\n\
         reused   {} scores, of genomes known already\ndigest   {}\nfiles    {}\n\
         film     islands replay {} --task {} --profile {}{} --out champion.rrd",
        summary.best,
        summary.best_island,
        summary.evaluations,
        summary.evaluations_per_second,
        summary.failures,
        summary.reused,
        summary.digest,
        summary.run_dir.display(),
        summary.best_genome.display(),
        summary.task,
        summary.profile,
        terrain_flag(&summary.run_dir),
    ));
    if let Some(recording) = &summary.recording {
        print(&format!("view     rerun {}", recording.display()));
    }
}
