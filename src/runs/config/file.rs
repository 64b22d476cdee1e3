//! Configurations as files say them.

use super::defaults::Wish;
use super::list::{Config, SETTINGS};
use crate::runs::failure::Failure;
use crate::runs::kind::Kind;
use crate::runs::setting::{Section, Setting};
use crate::runs::terrains;
use crate::store::{RunDir, file};
use std::path::Path;
use strum::VariantArray;
use toml::{Table, Value};

/// The largest configuration file, in bytes; ours have a thousand.
pub const FILE_BYTES_MAX: usize = 1 << 20;
/// The tables of a configuration that are no sections.
const TABLES: [&str; 4] = ["scales", "seed-genomes", "terrain", "launch"];
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
        let said = toml::from_str(text).map_err(|error| one_line(&error, text))?;
        let said = flat(said)?;
        for (key, value) in &said {
            let alone = Table::from_iter([(key.clone(), value.clone())]);
            alone.try_into::<Self>().map_err(|error| {
                let reason = complaint(key, &error);
                line_of(text, key).map_or(reason.clone(), |line| format!("line {line}: {reason}"))
            })?;
        }
        Self::of_table(said, wish).map_err(|error| one_line(&error, text))
    }

    /// What a table without sections says over the defaults of its problem.
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
        if !dir.holds_run()? {
            return Err(Failure::no_run(dir));
        }
        let mut config = Self::read(&dir.config())?;
        terrains::read(&mut config.terrain, dir)?;
        config.check_values()?;
        match config.is_launched() {
            true => Ok(config),
            false => Err(Failure::usage(format!(
                "{} was not written by a run: start one with islands --config {0}",
                dir.config().display()
            ))),
        }
    }

    /// The file that says the same, in sections, without the settings that are of no use to the problem, and those that
    /// mean nothing to the algorithm or who survives: those have their defaults.
    pub fn to_toml(&self) -> String {
        let table = self.table();
        let mut left = table.expect("a checked configuration is plain data within TOML's ranges");
        let unused = self.unused().unwrap_or_default();
        let unsaid = unused.iter().filter(|unused| !unused.is_said).map(|unused| unused.name);
        for useless in Self::useless_to(self.problem).into_iter().chain(unsaid) {
            left.remove(useless);
        }
        let mut text = String::new();
        for &section in Section::VARIANTS {
            let own = SETTINGS.iter().filter(|setting| setting.about.section == section);
            let line = |name: &str| Some(format!("{name} = {}\n", left.remove(name)?));
            let lines: String = own.map(|setting| setting.name.as_str()).filter_map(line).collect();
            if let Some(table) = section.table().filter(|_| !lines.is_empty()) {
                text += &format!("\n[{table}]\n");
            }
            text += &lines;
        }
        let tables = toml::to_string(&left).expect("it is plain data");
        if tables.is_empty() { text } else { format!("{text}\n{tables}") }
    }

    /// All of it as a table without sections.
    ///
    /// # Errors
    /// If a number is too large for TOML.
    pub(super) fn table(&self) -> Result<Table, Failure> {
        Table::try_from(self).map_err(|error| Failure::usage(error.to_string()))
    }

    /// The settings that decide what evolves, as TOML: all but those that are free, what launched it, and what is of
    /// no use to the problem. States that were saved under other ones, or by another version, are of no use.
    pub fn settings(&self) -> String {
        self.settings_of(env!("CARGO_PKG_VERSION"))
    }

    /// The settings as a version of the program has them that knows the same ones.
    pub fn settings_of(&self, version: &str) -> String {
        let table = |config: &Self| config.table().expect("a checked configuration is plain data");
        let (mut settings, usual) = (table(self), table(&Self::default()));
        for Setting { name, about, .. } in SETTINGS.iter() {
            if about.is_free || about.is_new && settings.get(name) == usual.get(name) {
                settings.remove(name);
            }
        }
        for other in Self::useless_to(self.problem).into_iter().chain(["launch"]) {
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

/// What a file says, without its sections: those are for people.
///
/// # Errors
/// If it says something twice, or has a section that there is not.
pub fn flat(said: Table) -> Result<Table, String> {
    let sections: Vec<String> = Section::VARIANTS.iter().filter_map(|it| it.table()).collect();
    let mut flat = Table::new();
    for (key, value) in said {
        let entries = match value {
            Value::Table(section) if sections.contains(&key) => section,
            Value::Table(_) if !TABLES.contains(&key.as_str()) => {
                return Err(format!(
                    "there is no section [{}]: choose one of {}",
                    harmless(&key),
                    sections.join(", ")
                ));
            }
            value => Table::from_iter([(key, value)]),
        };
        for (key, value) in entries {
            if flat.insert(key.clone(), value).is_some() {
                return Err(format!("{} is said twice", harmless(&key)));
            }
        }
    }
    Ok(flat)
}

/// What is wrong with a setting, or that there is none of this name: the list of all would be too long to be read.
fn complaint(key: &str, error: &toml::de::Error) -> String {
    let (key, reason) = (harmless(key), harmless(error.message()));
    match reason.starts_with(&format!("unknown field `{key}`")) {
        true => format!("unknown setting {key}: see islands run --help"),
        false => reason,
    }
}

/// The line on which a key stands, or its table begins, from 1.
fn line_of(text: &str, key: &str) -> Option<usize> {
    let says = |line: &str| {
        let rest = line.trim_start().strip_prefix(key);
        rest.is_some_and(|rest| rest.trim_start().starts_with('='))
            || line.trim() == format!("[{key}]")
    };
    text.lines().position(says).map(|line| line + 1)
}

/// TOML's errors draw the line that they complain of; ours are one sentence.
pub fn one_line(error: &toml::de::Error, text: &str) -> String {
    let message = harmless(error.message());
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => format!("line {}: {message}", before.matches('\n').count() + 1),
        None => message,
    }
}

/// What quotes a file, neither at any length nor with what a terminal would obey.
fn harmless(text: &str) -> String {
    text.chars().take(COMPLAINT_MAX).map(|c| if c.is_control() { ' ' } else { c }).collect()
}
