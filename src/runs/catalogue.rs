//! The one place that knows every problem: their names, what a run of each has by default, and which settings mean
//! nothing to it.

use super::config::{Config, GENES_MAX, SEED_MAX};
use super::failure::Failure;
use super::subject::Subject;
use crate::archipelago::Algorithm;
use crate::choice;
use crate::creature::gene::PARAMETER_COUNT;
use crate::evolution::{Crossover, Mutation, Selection, Survival, cma};
use crate::problems::{Benchmark, Bits, Function, Pattern};
use serde::{Deserialize, Serialize};
use toml::Table;

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

/// What is done with a problem, whichever it is.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Does it.
    fn visit<P: Subject>(self, problem: P) -> Self::Output;
}

/// What of a configuration decides its defaults.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wish {
    /// The problem; creatures if none is said.
    pub problem: Option<Kind>,
    /// Variables or bits; as many as are usual if none are said.
    pub dimensions: Option<usize>,
    /// Who lives on; all but elites die if nothing is said.
    pub survival: Option<Survival>,
}

/// Settings that mean something to creatures alone.
const OF_CREATURES: [&str; 14] = [
    "task",
    "profile",
    "engine",
    "robustness",
    "robust-by",
    "judged",
    "max-links",
    "scales",
    "terrain",
    "genes",
    "max-genes",
    "shrink-rate",
    "grow-rate",
    "duplicate-rate",
];
/// Settings that mean something to functions alone.
const OF_FUNCTIONS: [&str; 2] = ["instance", "rotated"];
/// What only some patterns have.
const OF_BLOCKS: &str = "block";
/// Settings that mean nothing to an algorithm without exchange and without a choice of who lives on.
const IDLE: [&str; 6] =
    ["survival", "heterogeneous", "topology", "emigrants", "replacement", "exchange"];
/// What a genome has that is of one length.
const OF_FIXED: &str = "dimensions";
/// What bits have no use for: they change wholly or not at all.
const OF_NUMBERS: [&str; 3] = ["mutation", "point-amount", "adaptation"];

impl Kind {
    /// Every problem.
    pub fn all() -> Vec<Self> {
        let functions = Function::ALL.map(Kind::Function);
        let bits = Pattern::ALL.map(Kind::Bits);
        [Kind::Creatures].into_iter().chain(functions).chain(bits).collect()
    }

    /// The names of the settings that mean nothing to it.
    pub fn useless(self) -> Vec<&'static str> {
        match self {
            Kind::Creatures => [&OF_FUNCTIONS[..], &[OF_BLOCKS, OF_FIXED]].concat(),
            Kind::Function(_) => [&OF_CREATURES[..], &[OF_BLOCKS]].concat(),
            Kind::Bits(Pattern::OneMax) => {
                [&OF_CREATURES[..], &OF_FUNCTIONS, &OF_NUMBERS, &[OF_BLOCKS]].concat()
            }
            Kind::Bits(_) => [&OF_CREATURES[..], &OF_FUNCTIONS, &OF_NUMBERS].concat(),
        }
    }

    fn usual_dimensions(self) -> usize {
        match self {
            Kind::Bits(pattern) => pattern.usual_bits(),
            Kind::Creatures | Kind::Function(_) => 30,
        }
    }
}

impl Config {
    /// What a run has where nothing else is said. A genome of one length neither shrinks nor grows, one of its values
    /// changes at a time, and evaluating it takes microseconds: there are more generations, and a state is saved less
    /// often than evolved.
    pub fn default_for(wish: Wish) -> Self {
        let usual = Self::default_of(wish);
        match wish.survival {
            // With tournaments the niches of fitness sharing come and go (Oei, Goldberg & Chang 1991).
            Some(Survival::Sharing { .. }) => Self { selection: Selection::Sus, ..usual },
            _ => usual,
        }
    }

    fn default_of(wish: Wish) -> Self {
        let problem = wish.problem.unwrap_or_default();
        let dimensions = wish.dimensions.unwrap_or(problem.usual_dimensions());
        let fixed = Self {
            problem,
            dimensions,
            genes: dimensions,
            max_genes: dimensions,
            population: 50,
            crossover_rate: 0.9,
            point_rate: 1.0 / dimensions.max(1) as f64,
            shrink_rate: 0.0,
            grow_rate: 0.0,
            checkpoint_interval: 50,
            ..Self::default()
        };
        match problem {
            Kind::Creatures => Self::default(),
            Kind::Function(_) => Self {
                generations: 1_000,
                // Of what was tried, the least evaluations to the bottom of Rastrigin and Ackley: benches/RESULTS.md.
                selection: Selection::Tournament { size: 5 },
                crossover: Crossover::Sbx { eta: 15.0 },
                mutation: Mutation::Polynomial { eta: 20.0 },
                point_amount: 1.0,
                ..fixed
            },
            Kind::Bits(pattern) => Self { generations: 200, block: pattern.usual_block(), ..fixed },
        }
    }

    /// Makes the problem that is solved, and hands it to a visitor.
    pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
        let Self { dimensions, instance, rotated, block, .. } = *self;
        match self.problem {
            Kind::Creatures => visitor.visit(self.locomotion()),
            Kind::Function(function) => {
                visitor.visit(Benchmark::new(function, dimensions, instance, rotated))
            }
            Kind::Bits(pattern) => visitor.visit(Bits { pattern, bits: dimensions, block }),
        }
    }

    /// Makes sure that the problem can have so many variables or bits.
    pub(super) fn check_dimensions(&self) -> Result<(), Failure> {
        let Self { problem, dimensions, instance, block, .. } = *self;
        let least = if problem == Kind::Function(Function::Rosenbrock) { 2 } else { 1 };
        if !(least..=GENES_MAX).contains(&dimensions) {
            return Err(Failure::usage(format!(
                "dimensions must be from {least} to {GENES_MAX}, not {dimensions}"
            )));
        }
        if instance > SEED_MAX {
            return Err(Failure::usage(format!("instance must be at most {SEED_MAX}")));
        }
        self.check_algorithm()?;
        let is_whole = (1..=dimensions).contains(&block) && dimensions.is_multiple_of(block);
        match problem {
            Kind::Bits(Pattern::Trap | Pattern::RoyalRoad) if !is_whole => {
                Err(Failure::usage(format!(
                    "{dimensions} bits cannot be cut into blocks of {block}: change --dimensions or --block"
                )))
            }
            _ => Ok(()),
        }
    }

    /// Makes sure that the algorithm can search there.
    fn check_algorithm(&self) -> Result<(), Failure> {
        let values = match self.problem {
            Kind::Creatures => self.genes.saturating_mul(PARAMETER_COUNT),
            Kind::Function(_) => self.dimensions,
            Kind::Bits(_) => 0,
        };
        match self.algorithm {
            Algorithm::CmaEs if values == 0 => Err(Failure::usage(format!(
                "cma-es learns from numbers, and {} has bits",
                self.problem
            ))),
            Algorithm::CmaEs if values > cma::DIMENSIONS_MAX => Err(Failure::usage(format!(
                "cma-es can learn {} numbers at most, and a genome has {values}",
                cma::DIMENSIONS_MAX
            ))),
            _ => Ok(()),
        }
    }

    /// Makes sure that nothing is said that means nothing to the problem, the algorithm or who survives; the ranges must
    /// have been checked.
    pub(super) fn check_use(&self) -> Result<(), Failure> {
        let Self { problem, dimensions, .. } = *self;
        // What is of no use to creatures needs no problem that it is of use to.
        let survival = Some(self.survival);
        let wish = Wish { problem: Some(problem), dimensions: Some(dimensions), survival };
        let table = |config: &Self| Table::try_from(config).map_err(|error| error.to_string());
        let tables = table(self).and_then(|said| Ok((said, table(&Self::default_for(wish))?)));
        let (said, usual) = tables.map_err(Failure::usage)?;
        let differs = |name: &&str| said.get(*name) != usual.get(*name);
        let chosen = [
            (self.idle().to_vec(), self.algorithm.to_string(), "algorithm"),
            (self.unselective().to_vec(), self.survival.to_string(), "survival"),
            (problem.useless(), problem.to_string(), "problem"),
        ];
        for (useless, choice, flag) in chosen {
            if let Some(name) = useless.into_iter().find(differs) {
                return Err(Failure::usage(format!(
                    "{name} means nothing to {choice}: leave it out, or choose another --{flag}"
                )));
            }
        }
        Ok(())
    }

    /// The names of the settings that mean nothing to the algorithm.
    fn idle(&self) -> &'static [&'static str] {
        match self.algorithm {
            Algorithm::Ga => &[],
            Algorithm::Panmictic => &["heterogeneous"],
            Algorithm::Random | Algorithm::HillClimb | Algorithm::CmaEs => &IDLE,
        }
    }

    /// The names of the settings that mean nothing to a scheme of survival in which it is survival that selects.
    fn unselective(&self) -> &'static [&'static str] {
        match self.survival {
            Survival::Crowding | Survival::Afpo | Survival::MapElites { .. } => {
                &["selection", "elites"]
            }
            Survival::Generational | Survival::Drifting | Survival::Sharing { .. } => &[],
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::Variation;
    use crate::rng::{Purpose, Source};

    fn usual(problem: Kind) -> Config {
        Config::default_for(Wish { problem: Some(problem), ..Wish::default() })
    }

    #[test]
    fn the_defaults_of_every_problem_are_sound_and_survive_their_file() {
        for problem in Kind::all() {
            let config = Config { seed: Some(7), ..usual(problem) };
            config.check().unwrap_or_else(|failure| panic!("{problem}: {failure}"));
            let text = config.to_toml();
            assert_eq!(Config::parse(&text).as_ref(), Ok(&config), "{problem}");
            let is_said = |name: &&str| text.lines().any(|line| line.starts_with(*name));
            assert_eq!(problem.useless().into_iter().find(is_said), None, "{problem}: {text}");
            assert_eq!(Config::parse(&format!("problem = \"{problem}\"")), Ok(usual(problem)));
            assert_eq!(problem.to_string().parse(), Ok(problem));
        }
    }

    #[test]
    fn every_name_of_a_setting_that_means_nothing_to_a_problem_is_that_of_a_setting() {
        let names = Table::try_from(Config::default()).expect("it is plain data");
        for name in Kind::all().into_iter().flat_map(Kind::useless) {
            // These are only said where there are some.
            assert!(names.contains_key(name) || ["scales", "terrain"].contains(&name), "{name}");
        }
    }

    #[test]
    fn defaults_follow_the_dimensions_and_what_is_said_wins_over_them() {
        let config = Config::parse("problem = \"sphere\"\ndimensions = 8\npopulation = 9");
        let config = config.expect("it is sound");
        assert_eq!((config.genes, config.max_genes, config.point_rate), (8, 8, 0.125));
        assert_eq!((config.population, config.generations), (9, 1_000));
    }

    #[test]
    fn with_sharing_parents_are_not_picked_by_tournaments_unless_it_is_said() {
        let selection = |text: &str| Config::parse(text).expect("it is sound").selection;
        assert_eq!(selection("survival = \"sharing:0.2\""), Selection::Sus);
        assert_eq!(selection("problem = \"trap\"\nsurvival = \"sharing\""), Selection::Sus);
        let said = "survival = \"sharing\"\nselection = \"tournament:3\"";
        assert_eq!(selection(said), Selection::Tournament { size: 3 });
    }

    #[test]
    fn what_means_nothing_to_a_scheme_of_survival_is_refused_by_name() {
        for survival in ["crowding", "afpo", "map-elites"] {
            for (name, setting) in [("selection", "selection = \"sus\""), ("elites", "elites = 1")]
            {
                let text = format!("survival = \"{survival}\"\n{setting}");
                let config = Config::parse(&text).expect("it can be read");
                let refusal = config.check().expect_err("it means nothing").message;
                let said = format!("{name} means nothing to {survival}");
                assert!(refusal.starts_with(&said), "{refusal}");
            }
            let panmictic = format!("survival = \"{survival}\"\nalgorithm = \"panmictic\"");
            let config = Config::parse(&panmictic).expect("it can be read").settled();
            assert!(config.check().is_ok(), "{survival}");
        }
    }

    #[test]
    fn a_file_that_cannot_be_is_complained_of_by_its_line() {
        let complaint = |text| Config::parse(text).unwrap_err();
        assert!(complaint("seed = 1\nproblem = \"cube\"").starts_with("line 2: unknown problem"));
        assert!(complaint("problem = \"sphere\"\nsize = 3").starts_with("line 2: "));
        assert!(complaint("dimensions = -1").starts_with("line 1: "));
    }

    #[test]
    fn genomes_of_every_problem_are_read_as_they_were_written_and_none_has_another_length() {
        struct Writer;
        impl Visitor for Writer {
            type Output = ();

            fn visit<P: Subject>(self, problem: P) {
                let source = Source { seed: 1, island: 0 };
                let mut rng = source.stream(0, 0, Purpose::Genesis);
                let genome = problem.random_genome(&mut rng);
                let mut file = Vec::new();
                problem.write_genome(&genome, &mut file).expect("memory takes everything");
                assert_eq!(problem.read_genome(&file, &[]), Ok(genome));
                assert_eq!(problem.body(&[]), None);
            }
        }
        Kind::all().into_iter().for_each(|problem| usual(problem).visit(Writer));
    }

    #[test]
    fn offspring_are_as_long_as_their_parents_where_genomes_are_of_one_length() {
        struct Breeder<'a>(&'a Config);
        impl Visitor for Breeder<'_> {
            type Output = ();

            fn visit<P: Subject>(self, problem: P) {
                let variation = Variation {
                    grow_rate: 1.0,
                    shrink_rate: 1.0,
                    ..self.0.archipelago().strategy.variation
                };
                let source = Source { seed: 1, island: 0 };
                let mut rng = source.stream(0, 0, Purpose::Crossover);
                let [a, b] = [0; 2].map(|_| problem.random_genome(&mut rng));
                for _ in 0..50 {
                    let mut child = problem.crossover(&a, &b, &variation, &mut rng);
                    problem.mutate(&mut child, &variation, &mut rng);
                    assert_eq!(child.len(), self.0.dimensions);
                }
            }
        }
        for problem in Kind::all().into_iter().filter(|kind| *kind != Kind::Creatures) {
            usual(problem).visit(Breeder(&usual(problem)));
        }
    }
}
