//! What a run of each problem has where nothing else is said.

use super::list::Config;
use crate::evolution::{Crossover, Mutation, Selection, Survival};
use crate::problems::neat::Test;
use crate::runs::kind::Kind;

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

impl Config {
    /// What a run has where nothing else is said. A genome of one length neither shrinks nor grows, one of its values
    /// changes at a time, and evaluating it takes microseconds: there are more generations, and a state is saved less
    /// often than evolved.
    pub fn default_for(wish: Wish) -> Self {
        let usual = Self::default_of(wish);
        let selection = wish.survival.and_then(Survival::usual_selection);
        Self { selection: selection.unwrap_or(usual.selection), ..usual }
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
            Kind::Network(test) => Self::default_of_network(test),
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

    /// The parameters of NEAT's paper (Stanley & Miikkulainen 2002, section 4.1), where it says them.
    fn default_of_network(test: Test) -> Self {
        let is_blind = test == Test::DoublePoleBlind;
        // The paper says neither: what took the fewest evaluations of what was tried, benches/RESULTS.md.
        let (fraction, point_amount) = if test == Test::Xor { (0.4, 0.3) } else { (0.2, 0.15) };
        Self {
            problem: Kind::Network(test),
            generations: 100,
            population: if is_blind { 1_000 } else { 150 },
            max_genes: 200,
            survival: Survival::Species { radius: if is_blind { 4.0 } else { 3.0 } },
            selection: Selection::Truncation { fraction },
            crossover_rate: 0.75,
            point_rate: 0.8,
            point_amount,
            shrink_rate: 0.0,
            grow_rate: if is_blind { 0.3 } else { 0.05 },
            duplicate_rate: 0.03,
            checkpoint_interval: 10,
            ..Self::default()
        }
    }
}
