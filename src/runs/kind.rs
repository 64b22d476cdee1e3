//! What can be evolved, by name.

use crate::choice;
use crate::problems::neat::Test;
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
    /// Networks that grow.
    Network(Test),
}

impl Kind {
    /// Every problem.
    pub fn all() -> Vec<Self> {
        let functions = Function::ALL.map(Kind::Function);
        let bits = Pattern::ALL.map(Kind::Bits);
        let networks = Test::ALL.map(Kind::Network);
        [Kind::Creatures].into_iter().chain(functions).chain(bits).chain(networks).collect()
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
            Kind::Network(_) => "networks",
        }
    }

    /// Whether genomes describe bodies.
    pub fn has_bodies(self) -> bool {
        matches!(self, Kind::Creatures)
    }

    /// Whether all genomes have the same length.
    pub fn is_of_one_length(self) -> bool {
        matches!(self, Kind::Function(_) | Kind::Bits(_))
    }

    /// Whether genomes may have any length.
    pub fn is_of_any_length(self) -> bool {
        !self.is_of_one_length()
    }

    /// Whether it is a function to be minimised.
    pub fn is_function(self) -> bool {
        matches!(self, Kind::Function(_))
    }

    /// Whether genes hold numbers, which can change by an amount; bits change wholly or not at all.
    pub fn has_numbers(self) -> bool {
        !matches!(self, Kind::Bits(_))
    }

    /// Whether networks grow, by operators of their own.
    pub fn is_network(self) -> bool {
        matches!(self, Kind::Network(_))
    }

    /// Whether operators on sequences of genes vary genomes.
    pub fn has_sequences(self) -> bool {
        !self.is_network()
    }

    /// Whether operators on numbers vary genes.
    pub fn has_vectors(self) -> bool {
        self.has_numbers() && self.has_sequences()
    }

    /// Whether a random genome has a number of genes that can be chosen.
    pub fn has_genes(self) -> bool {
        self.has_bodies()
    }

    /// Whether a genome is made of blocks.
    pub fn has_blocks(self) -> bool {
        matches!(self, Kind::Bits(Pattern::Trap | Pattern::RoyalRoad))
    }

    /// How many variables or bits a genome has if nothing is said.
    pub fn usual_dimensions(self) -> usize {
        match self {
            Kind::Bits(pattern) => pattern.usual_bits(),
            Kind::Creatures | Kind::Function(_) | Kind::Network(_) => 30,
        }
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Kind::Creatures => f.write_str("creatures"),
            Kind::Function(function) => function.fmt(f),
            Kind::Bits(pattern) => pattern.fmt(f),
            Kind::Network(test) => test.fmt(f),
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
