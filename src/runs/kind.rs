//! What can be evolved, by name.

use crate::choice;
use crate::problems::{Function, Pattern};
use serde::{Deserialize, Serialize};

/// What can be evolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Kind {
    /// Creatures that move.
    #[default]
    Creatures,
    /// Points that lie low on a function.
    Function(Function),
    /// Strings of ones and zeros.
    Bits(Pattern),
}

impl Kind {
    /// Every problem.
    pub fn all() -> Vec<Self> {
        let functions = Function::ALL.map(Kind::Function);
        let bits = Pattern::ALL.map(Kind::Bits);
        [Kind::Creatures].into_iter().chain(functions).chain(bits).collect()
    }

    /// Every problem, as `--help` lists them.
    pub fn list() -> String {
        let all = Self::all();
        let families = all.chunk_by(|one, other| one.family() == other.family());
        let family = |kinds: &[Self]| {
            let names: Vec<String> = kinds.iter().map(Self::to_string).collect();
            match &names[..] {
                [only] => only.clone(),
                _ => format!("{} ({})", kinds[0].family(), names.join(", ")),
            }
        };
        families.map(family).collect::<Vec<_>>().join(", ")
    }

    /// What problems of its sort are called.
    pub fn family(self) -> &'static str {
        match self {
            Kind::Creatures => "creatures",
            Kind::Function(_) => "functions",
            Kind::Bits(_) => "bits",
        }
    }

    /// Whether genomes describe bodies.
    pub fn has_bodies(self) -> bool {
        matches!(self, Kind::Creatures)
    }

    /// Whether all genomes have the same length.
    pub fn is_of_one_length(self) -> bool {
        !self.has_bodies()
    }

    /// Whether genomes may have any length.
    pub fn is_of_any_length(self) -> bool {
        !self.is_of_one_length()
    }

    /// Whether it is a function to be minimised.
    pub fn is_function(self) -> bool {
        matches!(self, Kind::Function(_))
    }

    /// Whether genes are numbers, which can change by an amount; bits change wholly or not at all.
    pub fn has_numbers(self) -> bool {
        !matches!(self, Kind::Bits(_))
    }

    /// Whether a genome is made of blocks.
    pub fn has_blocks(self) -> bool {
        matches!(self, Kind::Bits(Pattern::Trap | Pattern::RoyalRoad))
    }

    /// How many variables or bits a genome has if nothing is said.
    pub fn usual_dimensions(self) -> usize {
        match self {
            Kind::Bits(pattern) => pattern.usual_bits(),
            Kind::Creatures | Kind::Function(_) => 30,
        }
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Kind::Creatures => f.write_str("creatures"),
            Kind::Function(function) => function.fmt(f),
            Kind::Bits(pattern) => pattern.fmt(f),
        }
    }
}

impl std::str::FromStr for Kind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("problem", &Self::all(), text)
    }
}

choice::as_text!(Kind);
