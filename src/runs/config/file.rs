//! Configurations as files say them.

use super::{Config, FREE};
use crate::runs::Failure;
use crate::runs::catalogue::{Kind, Wish};
use crate::runs::terrains;
use crate::store::{RunDir, file};
use std::path::Path;
use toml::Table;

/// The largest configuration file, in bytes; ours have a thousand.
pub const FILE_BYTES_MAX: usize = 1 << 20;
/// The longest complaint about a file that is passed on, in characters.
const COMPLAINT_MAX: usize = 400;

impl Config {
    /// Reads a configuration file.
    ///
    /// # Errors
    /// If it cannot be read, is too large, no TOML, or says something that a configuration does not know.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Self::read_for(path, Wish::default())
    }

    /// Reads a configuration file for a problem that may be another one than it says.
    ///
    /// # Errors
    /// As [`Config::read`].
    pub fn read_for(path: &Path, wish: Wish) -> Result<Self, Failure> {
        let wrong =
            |reason: String| Failure::usage(format!("cannot use {}: {reason}", path.display()));
        let text = file::read_text(path, FILE_BYTES_MAX).map_err(|error| {
            wrong(format!("{}; name a file such as a run's run.toml", error.reason()))
        })?;
        Self::parse_for(&text, wish).map_err(wrong)
    }

    /// Reads what a configuration file says.
    ///
    /// # Errors
    /// What is wrong with it, if it is no TOML or says something that a configuration does not know.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::parse_for(text, Wish::default())
    }

    fn parse_for(text: &str, wish: Wish) -> Result<Self, String> {
        let wrong = |error: toml::de::Error| one_line(&error, text);
        let said: Table = toml::from_str(text).map_err(wrong)?;
        toml::from_str::<Self>(text).map_err(wrong)?;
        Self::of_table(said, wish).map_err(|error| wrong(*error))
    }

    /// What a table says over the defaults of its problem.
    ///
    /// # Errors
    /// If it says something that a configuration does not know.
    pub fn of_table(said: Table, wish: Wish) -> Result<Self, Box<toml::de::Error>> {
        let alone: Self = said.clone().try_into()?;
        let dimensions = said.contains_key("dimensions").then_some(alone.dimensions);
        let problem = wish.problem.unwrap_or(alone.problem);
        let survival = said.contains_key("survival").then_some(alone.survival);
        let wish = Wish {
            problem: Some(problem),
            dimensions: wish.dimensions.or(dimensions),
            survival: wish.survival.or(survival),
        };
        let usual = Table::try_from(Self::default_for(wish));
        let mut all = usual.expect("a configuration is plain data within TOML's ranges");
        all.extend(said);
        all.insert("problem".to_owned(), problem.to_string().into());
        Ok(all.try_into()?)
    }

    /// Reads the configuration of a run that was launched.
    ///
    /// # Errors
    /// If there is none, it cannot be read, is not sound, or was not written by a launch.
    pub fn of_run(dir: &RunDir) -> Result<Self, Failure> {
        if !dir.config().exists() {
            return Err(Failure::no_run(dir));
        }
        let mut config = Self::read(&dir.config())?;
        terrains::read(&mut config, dir)?;
        config.check()?;
        match config.is_launched() {
            true => Ok(config),
            false => Err(Failure::usage(format!(
                "{} was not written by a run: start one with islands --config {0}",
                dir.config().display()
            ))),
        }
    }

    /// The file that says the same, without the settings that are of no use to the problem: those have their defaults.
    pub fn to_toml(&self) -> String {
        let text = toml::to_string(self);
        let text = text.expect("a checked configuration is plain data within TOML's ranges");
        let is_of_no_use = |line: &str| {
            let name = line.split(" = ").next().unwrap_or_default();
            self.problem.useless().contains(&name)
        };
        text.split_inclusive('\n').filter(|line| !is_of_no_use(line)).collect()
    }

    /// The settings that decide what evolves, as TOML: all but [`FREE`], what launched it, and what is of no use
    /// to the problem. States that were
    /// saved under other ones, or by another version, are of no use.
    pub fn settings(&self) -> String {
        self.settings_of(env!("CARGO_PKG_VERSION"))
    }

    /// The settings as a version of the program has them that knows the same ones.
    pub fn settings_of(&self, version: &str) -> String {
        let mut settings =
            toml::Table::try_from(self).expect("a checked configuration is plain data");
        for other in FREE.into_iter().chain(["launch"]).chain(self.problem.useless()) {
            settings.remove(other);
        }
        // The first states that were ever saved name no problem.
        if self.problem == Kind::Creatures {
            settings.remove("problem");
        }
        // They know one trial alone, and what several come to decides nothing there.
        if self.robustness == 0 {
            settings.remove("robustness");
            settings.remove("robust-by");
        }
        settings.insert("version".to_owned(), version.into());
        settings.to_string()
    }
}

/// TOML's errors draw the line that they complain of; ours are one sentence.
pub fn one_line(error: &toml::de::Error, text: &str) -> String {
    // It may quote the file: neither at any length nor what a terminal would obey.
    let shown = error.message().chars().take(COMPLAINT_MAX);
    let message: String = shown.map(|c| if c.is_control() { ' ' } else { c }).collect();
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => format!("line {}: {message}", before.matches('\n').count() + 1),
        None => message,
    }
}
