//! What a setting of a run is: one thing, said in one place.
//!
//! A [`Setting`] knows its name, its section, its help, its range, and what it means something to. Flags, `run.toml`,
//! `--help`, the checks of a configuration, what `resume` refuses and what an experiment can vary follow from that. The
//! settings themselves are listed in [`super::config`].

use super::kind::Kind;
use crate::archipelago::Algorithm;
use crate::evolution::Survival;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A part of a configuration, in the order of `run.toml`: a table there and a heading of `--help`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::VariantArray)]
#[strum(serialize_all = "kebab-case")]
pub enum Section {
    /// What every run has; without a heading.
    Run,
    /// Functions, bits and networks.
    Vectors,
    /// Creatures: their bodies, and how they are tried.
    Creatures,
    /// The genetic algorithm on an island.
    GeneticAlgorithm,
    /// What islands exchange.
    Migration,
    /// How a run is carried out, which does not change its result.
    Running,
}

impl Section {
    /// The heading in `--help`.
    pub fn heading(self) -> Option<&'static str> {
        match self {
            Section::Run => None,
            Section::Vectors => Some("Functions, bits and networks"),
            Section::Creatures => Some("Creatures"),
            Section::GeneticAlgorithm => Some("Genetic algorithm"),
            Section::Migration => Some("Migration"),
            Section::Running => Some("Running"),
        }
    }

    /// The table of `run.toml`; that of [`Section::Run`] are the lines above all tables.
    pub fn table(self) -> Option<String> {
        (self != Section::Run).then(|| self.to_string())
    }
}

/// A setting of a configuration `C`.
#[derive(Debug)]
pub struct Setting<C> {
    /// Its name, in kebab-case: the key in `run.toml`.
    pub name: String,
    /// One sentence for `--help`.
    pub help: String,
    /// What else is to be said of it.
    pub about: About,
    /// Reads a text and sets the value.
    pub set: fn(&mut C, &str) -> Result<(), String>,
    /// The value where it is a number, and the range that it must be in.
    pub bounds: Option<Bounds<C>>,
}

/// A number of a configuration and the range that it must be in.
#[derive(Debug)]
pub struct Bounds<C> {
    /// The number; none where nothing is said.
    pub number: fn(&C) -> Option<f64>,
    /// The least and the most, which may depend on other settings.
    pub range: fn(&C) -> RangeInclusive<f64>,
}

impl<C> Setting<C> {
    /// The flag, without its dashes.
    pub fn flag(&self) -> &str {
        self.about.flag.unwrap_or(&self.name)
    }

    /// Makes sure that the number is in its range.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn check(&self, config: &C) -> Result<(), String> {
        let Some(bounds) = &self.bounds else { return Ok(()) };
        let (Some(number), range) = ((bounds.number)(config), (bounds.range)(config)) else {
            return Ok(());
        };
        if range.contains(&number) {
            return Ok(());
        }
        let flag = self.about.flag.map(|flag| format!(" (--{flag})")).unwrap_or_default();
        let (least, most) = (range.start(), range.end());
        Err(format!("{}{flag} must be from {least} to {most}, not {number}", self.name))
    }
}

/// What is to be said of a setting besides its name, type, default and range.
#[derive(Debug, Clone, Copy)]
pub struct About {
    /// Where it stands.
    pub section: Section,
    /// The flag, where it is not the name.
    pub flag: Option<&'static str>,
    /// What stands for the value in `--help`.
    pub value_name: Option<&'static str>,
    /// What there is to choose from, where a list says so.
    pub choices: Option<fn() -> String>,
    /// The default in words, where there is no value that says it.
    pub usually: Option<&'static str>,
    /// Whether a run that goes on may have another one: it decides how long and how a run is carried out, and no result.
    pub is_free: bool,
    /// Whether it decides what a body is worth, so that whoever tries a single body has it, too.
    pub tries_bodies: bool,
    /// Why an experiment cannot have it, if so.
    pub not_in_experiments: Option<&'static str>,
    /// Whether states that were saved before there was this setting count as having its default.
    pub is_new: bool,
    /// The problems that it means something to.
    pub problem: fn(Kind) -> bool,
    /// The algorithms that it means something to.
    pub algorithm: fn(Algorithm) -> bool,
    /// The schemes of survival that it means something to.
    pub survival: fn(Survival) -> bool,
}

/// A setting of a section, which means something to everybody.
pub const fn of(section: Section) -> About {
    About {
        section,
        flag: None,
        value_name: None,
        choices: None,
        usually: None,
        is_free: false,
        tries_bodies: false,
        not_in_experiments: None,
        is_new: false,
        problem: |_| true,
        algorithm: |_| true,
        survival: |_| true,
    }
}

impl About {
    /// Has another flag than its name.
    pub const fn flag(self, flag: &'static str) -> Self {
        Self { flag: Some(flag), ..self }
    }

    /// Has a word for its value in `--help`.
    pub const fn value(self, value_name: &'static str) -> Self {
        Self { value_name: Some(value_name), ..self }
    }

    /// Is one of a list, which its help names.
    pub const fn one_of(self, list: fn() -> String) -> Self {
        Self { choices: Some(list), ..self }
    }

    /// Says its default in words.
    pub const fn usually(self, words: &'static str) -> Self {
        Self { usually: Some(words), ..self }
    }

    /// May change when a run goes on.
    pub const fn free(self) -> Self {
        Self { is_free: true, ..self }
    }

    /// Decides what a body is worth.
    pub const fn tries_bodies(self) -> Self {
        Self { tries_bodies: true, problem: Kind::has_bodies, ..self }
    }

    /// Cannot be said by an experiment, for this reason.
    pub const fn not_in_experiments(self, reason: &'static str) -> Self {
        Self { not_in_experiments: Some(reason), ..self }
    }

    /// Came after states had been saved without it: they have its default.
    pub const fn newer(self) -> Self {
        Self { is_new: true, ..self }
    }

    /// Means something to these problems alone.
    pub const fn for_problem(self, problem: fn(Kind) -> bool) -> Self {
        Self { problem, ..self }
    }

    /// Means something to these algorithms alone.
    pub const fn for_algorithm(self, algorithm: fn(Algorithm) -> bool) -> Self {
        Self { algorithm, ..self }
    }

    /// Means something to these schemes of survival alone.
    pub const fn for_survival(self, survival: fn(Survival) -> bool) -> Self {
        Self { survival, ..self }
    }
}

/// The help of a setting: what is said of it, and what there is to choose from.
pub fn help(said: &str, about: &About) -> String {
    let choices = about.choices.map(|list| format!(": {}", list())).unwrap_or_default();
    format!("{}{choices}", said.trim())
}

/// Reads a value.
///
/// # Errors
/// What is wrong with the text.
pub fn read<T: FromStr<Err: Display>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|error: T::Err| error.to_string())
}

/// What may have a range.
pub trait Number {
    /// The number; none where nothing is said.
    fn number(self) -> Option<f64>;
}

impl<T: Number> Number for Option<T> {
    fn number(self) -> Option<f64> {
        self.and_then(T::number)
    }
}

macro_rules! numbers {
    ($($of:ty),+) => {$(
        impl Number for $of {
            fn number(self) -> Option<f64> {
                Some(self as f64)
            }
        }
    )+};
}
numbers!(u32, u64, usize, f64);

/// Makes a configuration of a list of settings: the struct `Config` with a field for each, its defaults, [`Parts`], and
/// the list `SETTINGS` itself. An entry is
///
/// ```text
/// /// help
/// name: type = default, about, in |config| least..=most;
/// ```
///
/// Instead of `= default`, `=> part.field` says where the value is used, and its default is the one there; with neither,
/// the setting need not be said. The range is left out where there is none.
macro_rules! settings {
    (
        $(
            $(#[doc = $help:literal])+
            $name:ident: $type:ty $(= $default:expr)? $(=> $part:ident $(.$field:ident)+)?,
            $about:expr $(, in $range:expr)?;
        )+
    ) => {
        /// Everything that decides a run. Command-line flags of the same names win over a file, and what neither
        /// says has the default.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
        pub struct Config {
            $(
                $(#[doc = $help])+
                pub $name: settings!(@type $type; $($default)?; $($part)?),
            )+
            /// Scales of profile `coursework` that were changed.
            #[serde(skip_serializing_if = "Scales::is_empty")]
            pub scales: Scales,
            /// The genomes that the islands begin with, if not all are random: the run's folder keeps them.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub seed_genomes: Option<SeedGenomes>,
            /// What creatures stand on, if not on the task's ground: the run's folder keeps it.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub terrain: Option<KeptTerrain>,
            /// What launched the run: written by the program, ignored when it is read for a new run.
            pub launch: Option<Launch>,
        }

        impl Default for Config {
            fn default() -> Self {
                let usual = Parts::usual();
                Self {
                    $($name: settings!(@usual usual; $($default)?; $($part $(.$field)+)?),)+
                    scales: Scales::NONE,
                    seed_genomes: None,
                    terrain: None,
                    launch: None,
                }
            }
        }

        impl Config {
            /// What is made of it, before the algorithm has its say.
            pub(super) fn parts(&self) -> Parts {
                let mut parts = Parts::usual();
                $($(parts.$part $(.$field)+ = self.$name;)?)+
                parts
            }
        }

        /// Every setting that has a flag, in the order of `--help`.
        pub static SETTINGS: LazyLock<Vec<Setting<Config>>> = LazyLock::new(|| {
            vec![$(Setting {
                name: stringify!($name).replace('_', "-"),
                help: setting::help(concat!($($help),+), &$about),
                about: $about,
                set: |config, text| {
                    config.$name = settings!(@read text; $($default)?; $($part)?);
                    Ok(())
                },
                bounds: settings!(@bounds $name; $($range)?),
            }),+]
        });
    };
    (@type $type:ty; ; ) => { Option<$type> };
    (@type $type:ty; $default:expr; ) => { $type };
    (@type $type:ty; ; $part:ident) => { $type };
    (@usual $usual:ident; ; ) => { None };
    (@usual $usual:ident; $default:expr; ) => { $default };
    (@usual $usual:ident; ; $part:ident $(.$field:ident)+) => { $usual.$part $(.$field)+ };
    (@read $text:ident; ; ) => { Some(setting::read($text)?) };
    (@read $text:ident; $($default:expr)?; $($part:ident)?) => { setting::read($text)? };
    (@bounds $name:ident; ) => { None };
    (@bounds $name:ident; $range:expr) => {
        Some(Bounds { number: |config: &Config| config.$name.number(), range: $range })
    };
}
pub(super) use settings;
