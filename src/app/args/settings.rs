//! The flags of settings: what [`SETTINGS`] says of each becomes its flag and its help.

use crate::runs::Failure;
use crate::runs::config::{Config, SETTINGS, Wish};
use crate::runs::kind::Kind;
use crate::runs::setting::Setting;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use std::collections::BTreeMap;
use std::marker::PhantomData;
use toml::{Table, Value};

/// Which settings a command has.
pub trait Group {
    /// Whether the command has a setting.
    fn has(setting: &Setting<Config>) -> bool;
    /// Whether the flags stand under the headings of their sections.
    const HAS_HEADINGS: bool = false;
    /// What follows the default in `--help`.
    const DEFAULT_SUFFIX: &str = "";

    /// What the command does with a setting besides, for `--help`.
    fn use_of(_: &Setting<Config>) -> Option<&'static str> {
        None
    }
}

/// All settings of a run.
#[derive(Debug, Clone)]
pub enum OfRun {}

impl Group for OfRun {
    const HAS_HEADINGS: bool = true;

    fn has(_: &Setting<Config>) -> bool {
        true
    }
}

/// Those that decide what a genome of any problem is worth.
#[derive(Debug, Clone)]
pub enum OfWorth {}

impl Group for OfWorth {
    fn has(setting: &Setting<Config>) -> bool {
        OfTrial::has(setting)
            || ["problem", "dimensions", "instance", "rotated", "block"]
                .contains(&setting.name.as_str())
    }
}

/// Those that decide what a body is worth.
#[derive(Debug, Clone)]
pub enum OfTrial {}

impl Group for OfTrial {
    fn has(setting: &Setting<Config>) -> bool {
        setting.about.tries_bodies
    }
}

/// The same, where the creatures may be those of a run.
#[derive(Debug, Clone)]
pub enum OfReplay {}

impl Group for OfReplay {
    const DEFAULT_SUFFIX: &str = ", or as in the run";

    fn has(setting: &Setting<Config>) -> bool {
        OfTrial::has(setting)
    }

    fn use_of(setting: &Setting<Config>) -> Option<&'static str> {
        (setting.name == "robustness").then_some(ROBUSTNESS_FILMED)
    }
}

/// What `replay` does with several trials.
const ROBUSTNESS_FILMED: &str =
    "The film shows the trial whose score is nearest to what they come to";

/// Those that decide what body a genome describes.
#[derive(Debug, Clone)]
pub enum OfBody {}

impl Group for OfBody {
    fn has(setting: &Setting<Config>) -> bool {
        ["profile", "max-links"].contains(&setting.name.as_str())
    }
}

/// What a command line says of a group of settings.
#[derive(Debug, Clone)]
pub struct SettingArgs<G = OfRun> {
    said: Vec<(&'static Setting<Config>, String)>,
    group: PhantomData<G>,
}

impl<G> SettingArgs<G> {
    /// Lays the flags over a configuration, which is that of no launch then.
    pub fn over(&self, config: Config) -> Config {
        let mut config = Config { launch: None, ..config };
        for (setting, text) in &self.said {
            (setting.set)(&mut config, text).expect("it was read as an argument");
        }
        config
    }

    /// What of them decides the defaults of all other settings.
    pub fn wish(&self) -> Wish {
        let Config { problem, dimensions, survival, .. } = self.over(Config::default());
        let says = |name| self.said.iter().any(|(setting, _)| setting.name == name);
        Wish {
            problem: says("problem").then_some(problem),
            dimensions: says("dimensions").then_some(dimensions),
            survival: says("survival").then_some(survival),
        }
    }

    /// Makes sure that no other problem is wished for than a run has, whose defaults would be other ones.
    ///
    /// # Errors
    /// If one is.
    pub fn require_same_problem(&self, own: &Config) -> Result<(), Failure> {
        let wished = self.over(own.clone());
        let name = |config: &Config| match config.problem.is_of_one_length() {
            true => format!("{} of {}", config.problem, config.dimensions),
            false => config.problem.to_string(),
        };
        if (wished.problem, wished.dimensions) == (own.problem, own.dimensions) {
            return Ok(());
        }
        Err(Failure::usage(format!(
            "a run cannot go on with another problem: it is {}, not {}; leave that out, or start a new run",
            name(own),
            name(&wished)
        )))
    }
}

impl<G: Group> FromArgMatches for SettingArgs<G> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let of_group = SETTINGS.iter().filter(|setting| G::has(setting));
        let said = of_group.filter_map(|setting| {
            Some((setting, matches.get_one::<String>(&setting.name)?.clone()))
        });
        Ok(Self { said: said.collect(), group: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl<G: Group> Args for SettingArgs<G> {
    fn augment_args(command: Command) -> Command {
        let defaults = Defaults::new();
        let of_group = SETTINGS.iter().filter(|setting| G::has(setting));
        of_group.fold(command, |command, setting| command.arg(arg::<G>(setting, &defaults)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// The flag of a setting.
fn arg<G: Group>(setting: &'static Setting<Config>, defaults: &Defaults) -> Arg {
    let read = |text: &str| -> Result<String, String> {
        (setting.set)(&mut Config::default(), text)?;
        Ok(text.to_owned())
    };
    let use_of = G::use_of(setting).map(|said| format!(". {said}")).unwrap_or_default();
    let arg = Arg::new(setting.name.as_str())
        .long(setting.flag())
        .help(format!("{}{use_of} {}", setting.help, defaults.in_words(setting, G::DEFAULT_SUFFIX)))
        .value_parser(read)
        .action(ArgAction::Set);
    let is_switch = defaults.usual.get(&setting.name).is_some_and(Value::is_bool);
    let arg = match (is_switch, setting.about.value_name) {
        (true, _) => arg
            .value_parser(["true", "false"])
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("true")
            .value_name("BOOL"),
        (false, Some(name)) => arg.value_name(name),
        (false, None) => arg,
    };
    let arg = match setting.about.flag {
        Some(_) => arg.visible_alias(setting.name.as_str()),
        None => arg,
    };
    match setting.about.section.heading().filter(|_| G::HAS_HEADINGS) {
        Some(heading) => arg.help_heading(heading),
        None => arg,
    }
}

/// What settings are if nothing is said.
struct Defaults {
    usual: Table,
    /// Of every problem but creatures, which are the usual one.
    others: Vec<(Kind, Table)>,
}

impl Defaults {
    fn new() -> Self {
        let table = |problem| {
            let config = Config::default_for(Wish { problem: Some(problem), ..Wish::default() });
            Table::try_from(config).expect("the defaults are plain data")
        };
        let others = Kind::all().into_iter().filter(|&kind| kind != Kind::Creatures);
        Self {
            usual: table(Kind::Creatures),
            others: others.map(|kind| (kind, table(kind))).collect(),
        }
    }

    /// The default, and those of other problems where they are other ones.
    fn in_words(&self, setting: &Setting<Config>, suffix: &str) -> String {
        let shown = |table: &Table| table.get(&setting.name).map(shown);
        let usual = match setting.about.usually {
            Some(words) => words.to_owned(),
            None => shown(&self.usual).unwrap_or_default(),
        };
        let mut others: BTreeMap<String, Vec<Kind>> = BTreeMap::new();
        let meant = self.others.iter().filter(|(kind, _)| (setting.about.problem)(*kind));
        for (kind, value) in meant.filter_map(|(kind, table)| Some((kind, shown(table)?))) {
            if setting.name != "problem" && value != usual {
                others.entry(value).or_default().push(*kind);
            }
        }
        let others: String =
            others.iter().map(|(value, kinds)| format!(" [{}: {value}]", names(kinds))).collect();
        format!("[default: {usual}{suffix}]{others}")
    }
}

/// What some problems are called: by their families, where those are all there.
fn names(kinds: &[Kind]) -> String {
    let mut names: Vec<String> = Vec::new();
    for kind in kinds {
        let family = |other: &&Kind| other.family() == kind.family();
        let all = Kind::all().iter().filter(family).count();
        let is_whole = kinds.iter().filter(family).count() == all;
        let name = if is_whole { kind.family().to_owned() } else { kind.to_string() };
        if names.last() != Some(&name) {
            names.push(name);
        }
    }
    names.join(", ")
}

/// A value as `--help` has room for.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) if *number > 0.0 && *number < 1.0 => {
            format!("{}", (number * 1e4).round() / 1e4)
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::args::cli::Cli;
    use clap::Parser;

    /// Among these each setting finds a value that is not its default.
    const VALUES: [&str; 19] = [
        "9",
        "0.9",
        "true",
        "random",
        "sphere",
        "travel",
        "lecture",
        "rapier",
        "worst",
        "roulette",
        "crowding",
        "uniform",
        "gaussian",
        "one-fifth",
        "torus",
        "similar",
        "async",
        "hill-climb",
        "layer:4",
    ];

    #[test]
    fn every_setting_has_a_flag_that_wins_over_a_file() {
        let usual = Config::default();
        for setting in SETTINGS.iter() {
            let changed = VALUES.iter().find_map(|value| {
                let mut config = usual.clone();
                (setting.set)(&mut config, value).ok().filter(|()| config != usual)?;
                Some((value, config))
            });
            let (value, expected) = changed.unwrap_or_else(|| panic!("add a {}", setting.name));
            let flag = format!("--{}={value}", setting.flag());
            let parsed = Cli::try_parse_from(["islands", &flag]).expect("the flag exists");
            assert_eq!(parsed.run.settings.over(usual.clone()), expected, "{flag}");
        }
    }
}
