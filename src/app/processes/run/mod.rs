//! `islands run` and `islands resume`: from what was asked for to the result.
//!
//! Here a run is made, or found again by [`resume`]. Then a [`supervisor`] sees it to its end: it starts the
//! [`processes`], each a [`child`], hears what they say, and starts those again that die, as the [`restart_policy`]
//! allows. A [`run_log`] tells and keeps what happens, [`progress`] shows how far the run got, and at the end [`film`]
//! says how to film the champion.

mod child;
mod film;
mod processes;
mod progress;
mod restart_policy;
mod resume;
mod run_log;
mod supervisor;

use crate::app::args::cli::{OutputArgs, ResumeArgs, RunArgs};
use crate::app::args::terrain_args;
use crate::app::console::{print, quoted, say};
use crate::app::processes::parent_link::StopSignal;
use crate::archipelago::ExchangeMode;
use crate::runs::Failure;
use crate::runs::catalogue::Visitor;
use crate::runs::config::{self, Config};
use crate::runs::kind::Kind;
use crate::runs::subject::Subject;
use crate::runs::summary::{self, Summary};
use crate::runs::{seeds, terrains};
use crate::store::{Claim, RunDir};
use crate::transport::{Domain, ServiceHost};
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
    let config = resolve(args)?;
    config.visit(Begin { args, config: config.clone() })
}

/// A run that is to be made.
struct Begin<'a> {
    args: &'a RunArgs,
    config: Config,
}

impl Visitor for Begin<'_> {
    type Output = Result<(), Failure>;

    fn visit<P: Subject>(self, problem: P) -> Result<(), Failure> {
        let Self { args, mut config } = self;
        let dropped = &args.changes.drop_columns;
        let read_from = args.config.as_deref();
        let founders = seeds::find(&problem, &mut config, &args.seed_genomes, dropped, read_from)?;
        config.launch = Some(new_launch()?);
        let stop_signal = StopSignal::from_signals()?;
        let dir = run_dir(args.out.as_deref(), &config);
        require_text(&dir)?;
        let domain = config.domain()?;
        let service_host = ServiceHost::create(&domain, &config.archipelago())?;
        let claim = dir.create().map_err(|error| {
            let go_on = match dir.config().exists() {
                true => format!(", or go on with it: {}", resume::command(&dir)),
                false => String::new(),
            };
            Failure::usage(format!("{error}; choose another folder with --out{go_on}"))
        })?;
        seeds::keep(&problem, &dir, &founders)?;
        terrains::keep(&dir, config.terrain.as_ref())?;
        write_config(&dir, &config)?;
        claim.make_folders(config.islands)?;
        Launch { problem, config, dir, claim, domain, service_host, stop_signal }.go(&args.output)
    }
}

/// Goes on with a run, to the result that it would have had undisturbed.
///
/// # Errors
/// Like [`run`].
pub fn resume(args: &ResumeArgs) -> Result<(), Failure> {
    keep_private();
    let dir = RunDir::at(&args.dir);
    require_text(&dir)?;
    let stop_signal = StopSignal::from_signals()?;
    let claim = resume::claim(&dir)?;
    let config = resume::config(&dir, &args.settings)?;
    config.visit(GoOn { args, config: config.clone(), dir, claim, stop_signal })
}

/// A run that is to go on.
struct GoOn<'a> {
    args: &'a ResumeArgs,
    config: Config,
    dir: RunDir,
    claim: Claim,
    stop_signal: StopSignal,
}

impl Visitor for GoOn<'_> {
    type Output = Result<(), Failure>;

    fn visit<P: Subject>(self, problem: P) -> Result<(), Failure> {
        let Self { args, mut config, dir, claim, stop_signal } = self;
        resume::require_checkpoints::<P::Gene>(&dir, &config)?;
        let finished = summary::finished(&dir, &config, &problem);
        if let Some(summary) = finished.filter(|it| !(it.awaits_film && args.output.films())) {
            // Its launcher may have been killed over its last words.
            Domain::remove_abandoned();
            present(&summary, &config, &args.output);
            return Ok(());
        }
        seeds::of_run(&dir, &config, &problem)?;
        config.launch = Some(new_launch()?);
        let domain = config.domain()?;
        let service_host = ServiceHost::create(&domain, &config.archipelago())?;
        claim.make_folders(config.islands)?;
        write_config(&dir, &config)?;
        Launch { problem, config, dir, claim, domain, service_host, stop_signal }.go(&args.output)
    }
}

/// Everything that a run needs before its first process.
struct Launch<P: Subject> {
    problem: P,
    config: Config,
    dir: RunDir,
    claim: Claim,
    domain: Domain,
    service_host: ServiceHost<P::Gene>,
    stop_signal: StopSignal,
}

impl<P: Subject> Launch<P> {
    fn go(self, output: &OutputArgs) -> Result<(), Failure> {
        let Self { problem, config, dir, claim, domain, service_host, stop_signal } = self;
        if config.exchange == ExchangeMode::Async {
            claim.make_arrivals()?;
            say(
                "note: islands do not wait for each other: the seed alone does not fix the result; what each takes in \
                 is recorded, so that it can be evolved again to the same digest",
            );
        }
        let supervised = Supervisor::launch(
            &problem,
            &config,
            &dir,
            &domain,
            &service_host,
            stop_signal,
            output,
        )
        .map(|mut supervisor| {
            let evolved = supervisor.see_to_the_end();
            let summary =
                evolved.and_then(|()| summary::gather(&dir, &config, &problem, output.films()));
            if let (Ok(summary), false) = (&summary, output.json) {
                show(summary);
            }
            supervisor.let_film_end(summary.is_ok());
            summary.and_then(|summary| summary::with_film(&dir, summary))
        });
        let summary = supervised.and_then(|summary| summary);
        if summary.is_err() {
            // What there is so far can be plotted; if not, there is a worse failure to tell of.
            let _ = summary::write_metrics(&dir, &config);
        }
        let summary = summary.map_err(|failure| resume::way_back(failure, &dir));
        let closed = service_host.close();
        drop(claim);
        present_film(&summary?, &config, output);
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

/// What was asked for: flags over a file over the defaults of the problem, with a seed.
fn resolve(args: &RunArgs) -> Result<Config, Failure> {
    let wish = args.settings.wish();
    let mut config = match &args.config {
        Some(path) => args.settings.over(Config::read_for(path, wish)?),
        None => args.settings.over(Config::default_for(wish)),
    };
    if !args.changes.scales.is_empty() {
        config.scales = args.changes.scales.iter().cloned().collect();
    }
    terrain_args::find(&mut config, &args.terrain, args.config.as_deref())?;
    config.check()?;
    config = config.settled();
    config.check()?;
    if config.seed.is_none() {
        // Half of it is entropy enough, and a number that people can copy.
        config.seed = Some(entropy()? >> 32);
    }
    Ok(config)
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
    let what = match config.problem {
        Kind::Creatures => config.task.to_string(),
        other => other.to_string(),
    };
    let name = format!("{what}-seed{}", config.seed.unwrap_or_default());
    let free = |path: &PathBuf| !path.exists();
    let first = Path::new("runs").join(&name);
    let next = (2..).map(|i| Path::new("runs").join(format!("{name}-{i}")));
    RunDir::at(
        std::iter::once(first).chain(next).find(free).expect("there is always a next number"),
    )
}

fn entropy() -> Result<u64, Failure> {
    rand::rngs::SysRng
        .try_next_u64()
        .map_err(|error| Failure::failed(format!("the system has no randomness: {error}")))
}

fn present(summary: &Summary, config: &Config, output: &OutputArgs) {
    if !output.json {
        show(summary);
    }
    present_film(summary, config, output);
}

/// What there is to say when the film is there, too.
fn present_film(summary: &Summary, config: &Config, output: &OutputArgs) {
    if output.json {
        let json = serde_json::to_string(summary);
        print(&json.expect("a summary is plain data, its numbers finite"));
    } else {
        show_film(summary, config);
    }
}

/// What is to be said of a champion that gets less than this share of its fitness on fresh trials.
const LUCK: f64 = 0.75;

fn luck(summary: &Summary) -> Option<String> {
    let validated = summary.validated.filter(|&worth| worth < LUCK * summary.best_fitness)?;
    Some(format!(
        "warning: the best was lucky: of the {} that it was selected by, {validated:.2} {} hold on fresh trials; more \
         --robustness helps",
        summary.best, summary.unit
    ))
}

fn show(summary: &Summary) {
    print(&format!("best     {}, island {}", summary.best, summary.best_island));
    summary
        .validation
        .iter()
        .for_each(|one| print(&format!("holds    {}", one.in_words(&summary.unit))));
    if let Some(warning) = luck(summary) {
        say(&warning);
    }
    print(&format!(
        "found in {} evaluations, {:.1} a second; {} failed\n\
         reused   {} scores, of genomes known already\ndigest   {}\nfiles    {}",
        summary.evaluations,
        summary.evaluations_per_second,
        summary.failures,
        summary.reused,
        summary.digest,
        summary.run_dir.display(),
    ));
}

fn show_film(summary: &Summary, config: &Config) {
    match config.problem {
        Kind::Creatures => {
            let command = film::command(&RunDir::at(&summary.run_dir), config);
            print(&format!("film     {command}"));
        }
        _ => print(&format!("genome   {}", summary.best_genome.display())),
    }
    if let Some(recording) = &summary.recording {
        print(&format!("view     rerun {}", quoted(recording)));
    }
}
