//! Whether a run can go on, and how: what `islands resume` checks before it starts anything.

use crate::app::args::settings::SettingArgs;
use crate::app::console::{Stopwatch, quoted};
use crate::archipelago::ExchangeMode;
use crate::evolution::Gene;
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::store::{Checkpoint, Checkpoints, Claim, RunDir, StoreError};
use std::io::ErrorKind;
use std::thread::sleep;
use std::time::Duration;

/// A launcher that was killed may hold its claim for so long.
const AFTERLIFE: Duration = Duration::from_millis(200);

/// Claims the run in a folder.
///
/// # Errors
/// If there is none, or it is under way.
pub fn claim(dir: &RunDir) -> Result<Claim, Failure> {
    if !dir.holds_run()? {
        return Err(Failure::no_run(dir));
    }
    let watch = Stopwatch::start();
    loop {
        match dir.claim() {
            // Of a launcher that was killed over starting somebody a copy lives on for a moment.
            Err(StoreError::UnderWay { .. }) if watch.elapsed() < AFTERLIFE => {
                sleep(AFTERLIFE / 10)
            }
            Err(error @ StoreError::UnderWay { .. }) => {
                let advice = "wait for its end, or stop it first";
                return Err(Failure::usage(format!("{error}; {advice}")));
            }
            claim => return Ok(claim?),
        }
    }
}

/// The configuration that a claimed run goes on with: its own, and what the user wants otherwise.
///
/// # Errors
/// If that would change what it evolves.
pub fn config(dir: &RunDir, wish: &SettingArgs) -> Result<Config, Failure> {
    let own = Config::of_run(dir)?;
    require_version(own.version())?;
    wish.require_same_problem(&own)?;
    let config = wish.over(own.clone());
    config.check_values()?;
    let changes = differences(&own.settings(), &config.settings());
    if !changes.is_empty() {
        return Err(Failure::usage(format!(
            "a run cannot go on with other settings: {}; leave that out, or start a new run",
            changes.join(", ")
        )));
    }
    if config.exchange == ExchangeMode::Async && config.generations < own.generations {
        return Err(Failure::usage(format!(
            "a run in which islands do not wait for each other cannot be made shorter: an island may have taken in what \
             another sent after generation {}; leave out --generations",
            config.generations
        )));
    }
    Ok(config)
}

/// Makes sure that the newest states that were saved are of the configuration that the run goes on with.
///
/// # Errors
/// If one is not, or of another version.
pub fn require_checkpoints<G: Gene>(dir: &RunDir, config: &Config) -> Result<(), Failure> {
    let checkpoints = newest_checkpoints::<G>(dir, config)?;
    checkpoints.iter().try_for_each(|checkpoint| require_same(checkpoint, config))
}

/// The failure of a run that was under way, and how to go on. One that was interrupted says so itself.
pub fn way_back(failure: Failure, dir: &RunDir) -> Failure {
    match require_folder(dir) {
        _ if failure.is_interruption() => failure,
        Err(gone) => gone,
        Ok(()) => Failure::failed(format!(
            "{}; the run stops, and nothing is lost; go on with: {}",
            failure.message,
            command(dir)
        )),
    }
}

/// The command that goes on with a run, as a shell takes it.
pub fn command(dir: &RunDir) -> String {
    format!("islands resume {}", quoted(dir.path()))
}

/// Requires that the folder of a run under way is where it was. Its processes hold their files open and would
/// write on into what nobody will ever read.
///
/// # Errors
/// If it was moved or removed, or cannot be reached: then it says why.
pub fn require_folder(dir: &RunDir) -> Result<(), Failure> {
    let folder = dir.path().display();
    match dir.config().metadata() {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(Failure::failed(format!(
            "the run's folder {folder} is gone: somebody has moved or removed it while the run was under way; what was \
             moved can go on with islands resume"
        ))),
        Err(error) => Err(Failure::failed(format!(
            "the run's folder {folder} cannot be reached: {error}; when it can, the run goes on with: {}",
            command(dir)
        ))),
    }
}

fn require_version(version: &str) -> Result<(), Failure> {
    let own = env!("CARGO_PKG_VERSION");
    if version == own {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "this run was made by version {version} of islands, and this is version {own}, which may evolve otherwise: \
         use version {version}, or start a new run"
    )))
}

/// What a checkpoint knows of the run, against what the run's configuration says.
fn require_same<G>(checkpoint: &Checkpoint<G>, config: &Config) -> Result<(), Failure> {
    let changes = differences(&checkpoint.settings, &config.settings());
    if !changes.is_empty() {
        return Err(Failure::usage(format!(
            "the run's run.toml was changed since the run began: {}; change it back, or start a new run",
            changes.join(", ")
        )));
    }
    let reached = checkpoint.island.generation;
    if config.generations < reached {
        return Err(Failure::usage(format!(
            "island {} has evolved {reached} generations already: --generations cannot be {}",
            checkpoint.island.index, config.generations
        )));
    }
    Ok(())
}

/// The newest whole checkpoint of each island that has one. What is damaged the island itself deals with.
fn newest_checkpoints<G: Gene>(
    dir: &RunDir,
    config: &Config,
) -> Result<Vec<Checkpoint<G>>, Failure> {
    let mut newest = Vec::new();
    for island in 0..config.islands {
        // An island that never got so far has no folder.
        let checkpoints = Checkpoints::of(dir, island);
        let Ok(checkpoints) = checkpoints.load::<G>() else { continue };
        for (_, checkpoint) in checkpoints {
            match checkpoint {
                Ok(checkpoint) => {
                    newest.push(checkpoint);
                    break;
                }
                Err(error @ StoreError::Version { .. }) => {
                    return Err(Failure::usage(error.to_string()));
                }
                Err(_) => {}
            }
        }
    }
    Ok(newest)
}

/// What differs between two settings, a phrase each.
fn differences(was: &str, is: &str) -> Vec<String> {
    let (Ok(was), Ok(is)) = (was.parse::<toml::Table>(), is.parse::<toml::Table>()) else {
        return vec!["they cannot be read".to_owned()];
    };
    let of = |table: &toml::Table, name: &str| {
        table.get(name).map_or_else(|| "nothing".to_owned(), ToString::to_string)
    };
    let names: std::collections::BTreeSet<&String> = was.keys().chain(is.keys()).collect();
    names
        .into_iter()
        .filter(|name| was.get(*name) != is.get(*name))
        .map(|name| format!("{name} is {}, not {}", of(&was, name), of(&is, name)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_goes_on_can_be_pasted_into_a_shell() {
        let command = |path| command(&RunDir::at(path));
        assert_eq!(command("runs/walk-seed7"), "islands resume runs/walk-seed7");
        assert_eq!(command("my runs/it's"), r"islands resume 'my runs/it'\''s'");
    }

    #[test]
    fn what_differs_is_named() {
        let was = Config { seed: Some(7), ..Config::default() };
        let is = Config {
            seed: Some(8),
            population: 30,
            threads: Some(2),
            generations: 9,
            ..was.clone()
        };
        let found = differences(&was.settings(), &is.settings());
        assert_eq!(found, ["population is 24, not 30", "seed is 7, not 8"]);
        assert!(differences(&was.settings(), &was.settings()).is_empty());
        assert_eq!(differences("=", ""), ["they cannot be read"]);
    }

    #[test]
    fn a_folder_that_cannot_be_reached_is_not_called_gone() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let said =
            |path| require_folder(&RunDir::at(folder.path().join(path))).unwrap_err().message;
        assert!(said("nowhere").contains(" is gone: somebody has moved or removed it"));
        std::fs::write(folder.path().join("file"), "").expect("it can be written");
        let unreachable = said("file/run");
        assert!(unreachable.contains(" cannot be reached: Not a directory"), "{unreachable}");
    }
}
