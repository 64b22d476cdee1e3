//! What an experiment is: its file, and the settings and seeds that the file comes to.

use crate::app::table::harmless;
use crate::runs::Failure;
use crate::runs::config::{self, Config, FILE_BYTES_MAX, SEED_MAX, SETTINGS, Wish};
use crate::store::file;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;
use toml::{Table, Value};

/// Who wants more runs than this wants something else.
const RUNS_MAX: usize = 100_000;
/// Seeds of an experiment that names none.
const SEEDS: i64 = 10;
/// The longest name of a setting, in characters.
const NAME_MAX: usize = 200;
/// Generations of a run that only its evaluations end.
const GENERATIONS_MAX: u32 = 1_000_000_000;

/// What a configuration says besides its settings, and why an experiment has no use for it.
const REFUSED: [(&str, &str); 3] = [
    ("seed-genomes", "runs of an experiment begin with random genomes"),
    ("terrain", "a configuration does not say which; task = \"climb\" has one of its own"),
    ("launch", "nothing is launched"),
];

/// The file of an experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// How many, a list, or a range such as `11-20`.
    #[serde(default = "seeds")]
    seeds: Value,
    /// The budget of a run, of all islands together.
    evaluations: Option<u64>,
    /// The fitness of a success.
    target: Option<f64>,
    /// The version that ran it: written by the program, ignored when it is read.
    version: Option<String>,
    /// What all settings have in common.
    #[serde(default)]
    base: Table,
    /// Lists of values, of which every combination is a setting.
    #[serde(default)]
    grid: Table,
    /// Settings that have a name.
    #[serde(default)]
    setting: Vec<Table>,
}

fn seeds() -> Value {
    Value::Integer(SEEDS)
}

/// An experiment that can be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What is compared.
    pub settings: Vec<Setting>,
    /// The names of what not all settings have in common, in order.
    pub varied: Vec<String>,
    /// The seeds that each setting is run with.
    pub seeds: Vec<u64>,
    /// The budget of a run, of all islands together.
    pub evaluations: Option<u64>,
    /// The fitness of a success.
    pub target: Option<f64>,
}

/// One of the things that are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Its name, as no other one's.
    pub name: String,
    /// All of it but the seed.
    config: Config,
}

impl Setting {
    /// The configuration of its run with a seed.
    pub fn config(&self, seed: u64) -> Config {
        Config { seed: Some(seed), ..self.config.clone() }
    }

    /// What its fitness means: that of settings with another aim is another thing.
    pub fn aim(&self) -> String {
        let Config { problem, dimensions, instance, rotated, block, .. } = self.config;
        let Config { task, ref terrain, .. } = self.config;
        let terrain = terrain.as_ref().map_or("", |terrain| &terrain.digest);
        format!("{problem} {dimensions} {instance} {rotated} {block} {task} {terrain}")
    }

    /// What it has where settings differ, as text, empty where it has nothing.
    pub fn values(&self, varied: &[String]) -> Vec<String> {
        let table = Table::try_from(&self.config).expect("a checked configuration is plain data");
        varied.iter().map(|key| table.get(key).map(shown).unwrap_or_default()).collect()
    }
}

impl Definition {
    /// Reads the file of an experiment.
    ///
    /// # Errors
    /// If it cannot be read, is no TOML or says something that is unknown.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = file::read_text(path, FILE_BYTES_MAX).map_err(|error| {
            let hint = "name the file of an experiment, see islands experiment --help";
            Failure::usage(format!("cannot use {}: {}; {hint}", path.display(), error.reason()))
        })?;
        Self::parse(&text)
            .map_err(|reason| Failure::usage(format!("cannot use {}: {reason}", path.display())))
    }

    /// Reads what such a file says.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let read: Self = toml::from_str(text).map_err(|error| config::one_line(&error, text))?;
        let flat = |place: &str, table: Table| {
            config::flat(table).map_err(|reason| format!("{place}: {reason}"))
        };
        let (base, grid) = (flat("[base]", read.base)?, flat("[grid]", read.grid)?);
        let setting: Result<_, _> =
            read.setting.into_iter().map(|own| flat("[[setting]]", own)).collect();
        Ok(Self { base, grid, setting: setting?, ..read })
    }

    /// The file that says the same, of this version.
    pub fn to_toml(&self) -> String {
        let version = Some(env!("CARGO_PKG_VERSION").to_owned());
        toml::to_string(&Self { version, ..self.clone() }).expect("it was TOML")
    }

    /// What it comes to, every configuration checked.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn plan(&self) -> Result<Plan, String> {
        if self.evaluations == Some(0) {
            return Err("evaluations must be at least 1".to_owned());
        }
        if self.target.is_some_and(|target| !target.is_finite()) {
            return Err("target must be a finite number".to_owned());
        }
        let seeds = read_seeds(&self.seeds)?;
        let named = self.named()?;
        let points = self.points(named.len() * seeds.len())?;
        let own = every_pair(&named, &points);
        let bases = self.bases(&own)?;
        let mut settings = Vec::new();
        for ((name, own), base) in own.into_iter().zip(&bases) {
            settings.push(self.setting(&name, merged(base, &own), seeds[0])?);
        }
        let varied: BTreeSet<_> = named.iter().flat_map(|(_, own)| own.keys()).collect();
        let varied = varied.into_iter().chain(self.grid.keys()).cloned().collect();
        let Self { evaluations, target, .. } = *self;
        let plan = Plan { settings, varied, seeds, evaluations, target };
        plan.check_that_all_differ()?;
        Ok(plan)
    }

    /// The settings before the grid is laid over them, one without a name if there are none.
    fn named(&self) -> Result<Vec<(String, Table)>, String> {
        check_table("[base]", &self.base)?;
        let mut named = Vec::new();
        for table in &self.setting {
            let mut own = table.clone();
            let name = match own.remove("name") {
                Some(Value::String(name)) => name,
                _ => return Err("each [[setting]] needs a name, which is text".to_owned()),
            };
            check_name(&name)?;
            check_table(&format!("setting {name}"), &own)?;
            if let Some(both) = own.keys().find(|key| self.grid.contains_key(*key)) {
                return Err(format!("both [grid] and setting {name} say {both}"));
            }
            named.push((name, own));
        }
        if named.is_empty() {
            named.push((String::new(), Table::new()));
        }
        Ok(named)
    }

    /// Every combination of the grid, the last of its settings changing fastest. `others` is what it is multiplied by.
    fn points(&self, others: usize) -> Result<Vec<(String, Table)>, String> {
        let mut points = vec![(String::new(), Table::new())];
        for (key, values) in &self.grid {
            let Some(values) = values.as_array().filter(|values| !values.is_empty()) else {
                return Err(format!("[grid] {} must be a list of values", harmless(key)));
            };
            for value in values {
                check_setting("[grid]", key, value)?;
                check_name(&shown(value))?;
            }
            if points.len().saturating_mul(values.len()).saturating_mul(others) > RUNS_MAX {
                return Err(format!("these are more than {RUNS_MAX} runs"));
            }
            let alone = |value: &Value| {
                let name = format!("{key}={}", shown(value));
                (name, Table::from_iter([(key.clone(), value.clone())]))
            };
            points = every_pair(&points, &values.iter().map(alone).collect::<Vec<_>>());
        }
        match others > RUNS_MAX {
            true => Err(format!("these are more than {RUNS_MAX} runs")),
            false => Ok(points),
        }
    }

    /// What each setting has of what is said for all of them: not what means nothing to it, such as elites to random
    /// search, as long as it means something to another.
    fn bases(&self, settings: &[(String, Table)]) -> Result<Vec<Table>, String> {
        let unused = |(name, own): &(String, Table)| {
            let config = read(shown_name(name), merged(&self.base, own))?;
            let unused = config.unused().map_err(|failure| failure.message)?;
            Ok(unused.into_iter().map(|unused| unused.name).collect())
        };
        let unused: Vec<BTreeSet<&str>> =
            settings.iter().map(unused).collect::<Result<_, String>>()?;
        let is_in_vain = |key: &str| unused.iter().all(|unused| unused.contains(key));
        let base = |unused: &BTreeSet<&str>| {
            let is_kept = |key: &str| !unused.contains(key) || is_in_vain(key);
            let kept = self.base.iter().filter(|(key, _)| is_kept(key));
            kept.map(|(key, value)| (key.clone(), value.clone())).collect()
        };
        Ok(unused.iter().map(base).collect())
    }

    fn setting(&self, name: &str, all: Table, seed: u64) -> Result<Setting, String> {
        let name = shown_name(name).to_owned();
        let is_bounded = self.evaluations.is_none() || all.contains_key("generations");
        let config = read(&name, all)?;
        let refused = |failure: Failure| format!("setting {name}: {}", failure.message);
        config.check().map_err(refused)?;
        let generations = if is_bounded { config.generations } else { GENERATIONS_MAX };
        let setting =
            Setting { name: name.clone(), config: Config { generations, ..config }.settled() };
        setting.config(seed).check().map_err(refused)?;
        Ok(setting)
    }
}

impl Plan {
    /// A hash of all that decides a run: with another one it is another run.
    pub fn key(&self, setting: &Setting, seed: u64) -> String {
        let config = setting.config(seed);
        let (all, generations) = (config.settings(), config.generations);
        let all =
            format!("{all}\ngenerations = {generations}\nevaluations = {:?}", self.evaluations);
        blake3::hash(all.as_bytes()).to_hex()[..16].to_owned()
    }

    fn check_that_all_differ(&self) -> Result<(), String> {
        for (index, one) in self.settings.iter().enumerate() {
            for other in &self.settings[..index] {
                if one.name == other.name {
                    return Err(format!("two settings are called {}", one.name));
                }
                if one.config == other.config {
                    return Err(format!("settings {} and {} are the same", other.name, one.name));
                }
            }
        }
        Ok(())
    }
}

/// The only setting needs no name.
fn shown_name(name: &str) -> &str {
    if name.is_empty() { "base" } else { name }
}

fn read(name: &str, all: Table) -> Result<Config, String> {
    Config::of_table(all, Wish::default())
        .map_err(|error| format!("setting {name}: {}", error.message()))
}

/// Each of `under` with each of `over`, under both their names.
fn every_pair(under: &[(String, Table)], over: &[(String, Table)]) -> Vec<(String, Table)> {
    let pairs = under.iter().flat_map(|one| over.iter().map(move |other| (one, other)));
    let join = |(one, other): (&(String, Table), &(String, Table))| {
        let separator = if one.0.is_empty() || other.0.is_empty() { "" } else { "," };
        (format!("{}{separator}{}", one.0, other.0), merged(&one.1, &other.1))
    };
    pairs.map(join).collect()
}

fn merged(under: &Table, over: &Table) -> Table {
    let mut all = under.clone();
    all.extend(over.clone());
    all
}

fn check_table(place: &str, table: &Table) -> Result<(), String> {
    table.iter().try_for_each(|(key, value)| check_setting(place, key, value))
}

/// Whether a run knows such a setting, with such a value; whether they go together is checked when all are there.
fn check_setting(place: &str, key: &str, value: &Value) -> Result<(), String> {
    let refused = SETTINGS
        .iter()
        .filter_map(|setting| Some((setting.name.as_str(), setting.about.not_in_experiments?)));
    if let Some((_, instead)) = refused.chain(REFUSED).find(|(refused, _)| *refused == key) {
        return Err(format!("{place} must not say {key}: {instead}"));
    }
    let alone = Table::from_iter([(key.to_owned(), value.clone())]);
    let Err(error) = alone.try_into::<Config>() else { return Ok(()) };
    let (key, reason) = (harmless(key), harmless(error.message()));
    Err(match reason.starts_with(&format!("unknown field `{key}`")) {
        true => format!("{place} has an unknown setting {key}: see islands run --help"),
        false => format!("{place} {key}: {reason}"),
    })
}

/// Names stand in tables for people and in pictures.
fn check_name(name: &str) -> Result<(), String> {
    let is_plain = !name.contains(|c: char| c.is_control() || c == '|');
    match is_plain && (1..=NAME_MAX).contains(&name.chars().count()) {
        true => Ok(()),
        false => Err(format!(
            "“{}” is no name for a setting: take up to {NAME_MAX} characters, and no |",
            harmless(name).chars().take(40).collect::<String>()
        )),
    }
}

/// A value as it stands in names and cells.
fn shown(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn read_seeds(said: &Value) -> Result<Vec<u64>, String> {
    let wrong = || {
        let most = format!("each from 0 to {SEED_MAX} and once, {RUNS_MAX} at most");
        format!(
            "seeds must be how many, a list such as [3, 5], or a range such as \"11-20\": {most}"
        )
    };
    let number = |value: &Value| value.as_integer().and_then(|seed| u64::try_from(seed).ok());
    let seeds: Option<Vec<u64>> = match said {
        Value::Integer(_) => number(said).map(|count| range(1, count)),
        Value::Array(list) => list.iter().map(number).collect(),
        Value::String(text) => text.split_once('-').and_then(|(first, last)| {
            Some(range(first.trim().parse().ok()?, last.trim().parse().ok()?))
        }),
        _ => None,
    };
    let seeds = seeds.ok_or_else(wrong)?;
    let different = BTreeSet::from_iter(&seeds).len() == seeds.len();
    let within = seeds.iter().all(|&seed| seed <= SEED_MAX);
    match different && within && (1..=RUNS_MAX).contains(&seeds.len()) {
        true => Ok(seeds),
        false => Err(wrong()),
    }
}

/// Both ends included; too many are one too many.
fn range(first: u64, last: u64) -> Vec<u64> {
    (first..=last).take(RUNS_MAX + 1).collect()
}
