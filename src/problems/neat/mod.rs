//! Benchmarks for networks that grow: [`xor`], and [`double_pole`] with and without velocities.

pub mod cart;
pub mod double_pole;
pub mod xor;

#[cfg(test)]
mod tests;

use crate::choice;
use crate::evolution::{Evaluation, Fitness, Gene, Hurdles, Outcome, Problem, Variation};
use crate::networks::{
    self, Coefficients, Function, Genome, Growth, Misgrown, Network, Sockets, Start, WEIGHT_MAX,
    Wiring, crossover,
};
use crate::rng::Stream;
use double_pole::Poles;
use rand::RngExt;

impl Gene for networks::Gene {
    const WIRE_NAME: &'static str = "islands.network.gene.v1";

    fn is_valid(&self) -> bool {
        self.part().is_some()
    }
}

/// What networks have to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::VariantArray)]
#[strum(serialize_all = "kebab-case")]
pub enum Test {
    /// Exclusive or: needs a hidden neuron.
    Xor,
    /// Two poles on a cart, with all velocities known.
    DoublePole,
    /// The same without velocities: needs a memory.
    DoublePoleBlind,
}

impl Test {
    /// What goes in and comes out.
    pub fn sockets(self) -> Sockets {
        let inputs = match self {
            Test::Xor => 2,
            Test::DoublePole => 6,
            Test::DoublePoleBlind => 3,
        };
        Sockets { inputs, outputs: 1 }
    }

    /// What goes in, in order.
    pub fn inputs(self) -> &'static [&'static str] {
        match self {
            Test::Xor => &["a", "b"],
            Test::DoublePole => &double_pole::INPUTS,
            Test::DoublePoleBlind => &double_pole::BLIND_INPUTS,
        }
    }

    /// What comes out, in order.
    pub fn outputs(self) -> &'static [&'static str] {
        match self {
            Test::Xor => &["a xor b"],
            Test::DoublePole | Test::DoublePoleBlind => &["force"],
        }
    }

    /// The fitness from which on a network has solved it.
    pub fn solved_from(self) -> f64 {
        match self {
            Test::Xor => xor::SOLVED,
            Test::DoublePole => f64::from(double_pole::LONG_STEPS),
            Test::DoublePoleBlind => double_pole::SOLVED + double_pole::STARTS_NEEDED as f64,
        }
    }

    fn wiring(self) -> Wiring {
        match self {
            Test::Xor => Wiring::FeedForward,
            Test::DoublePole | Test::DoublePoleBlind => Wiring::Recurrent,
        }
    }

    fn coefficients(self) -> Coefficients {
        match self {
            Test::Xor | Test::DoublePole => Coefficients::USUAL,
            Test::DoublePoleBlind => Coefficients::LARGE,
        }
    }

    fn poles(self) -> Option<Poles> {
        match self {
            Test::Xor => None,
            Test::DoublePole => Some(Poles { is_blind: false }),
            Test::DoublePoleBlind => Some(Poles { is_blind: true }),
        }
    }
}

choice::one_of!("test", Test);

/// Networks that grow until they pass a test.
///
/// Of [`Variation`], `point_rate` is the probability that the weights of a genome change, `point_amount` the largest
/// change as a share of a weight's range, `duplicate_rate` the probability that a link is split by a new neuron, and
/// `grow_rate` that of a new link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Neat {
    /// What they have to do.
    pub test: Test,
    /// What the first ones look like.
    pub start: Start,
}

/// What hidden neurons do.
const FUNCTIONS: [Function; 1] = [Function::Sigmoid];

impl Neat {
    /// The network of a genome.
    ///
    /// # Errors
    /// If the genes are none of such a network.
    pub fn network(&self, genes: &[networks::Gene]) -> Result<Network, Misgrown> {
        let (sockets, wiring) = (self.test.sockets(), self.test.wiring());
        let genome = Genome::of_genes(genes, sockets)?;
        Network::new(&genome, sockets, wiring, Function::Sigmoid)
    }

    /// From how many of the 625 starts a network balances; none where there are no starts, or no network.
    pub fn starts_held(&self, genes: &[networks::Gene]) -> Option<usize> {
        let poles = self.test.poles()?;
        let mut network = self.network(genes).ok()?;
        Some(poles.starts_held(&mut network))
    }

    fn genome(&self, genes: &[networks::Gene]) -> Genome {
        // What is no network has nothing in common with others, and never has a score.
        Genome::of_genes(genes, self.test.sockets()).unwrap_or_default()
    }

    fn score(&self, network: &mut Network, best: Fitness) -> f64 {
        match self.test.poles() {
            None => xor::score(network),
            Some(poles) if poles.is_blind => poles.score_blind(network, best),
            Some(poles) => f64::from(poles.steps_balanced(network, double_pole::LONG_STEPS)),
        }
    }

    /// All scores that a genome can have on an island, its estimates and, last, its whole score.
    pub fn possible_scores(&self, genome: &[networks::Gene]) -> Vec<Fitness> {
        let least = self.scored(genome, Fitness::HIGHEST).fitness;
        vec![least, self.evaluate(genome).fitness]
    }

    fn scored(&self, genes: &[networks::Gene], best: Fitness) -> Evaluation {
        match self.network(genes) {
            Ok(mut network) => Evaluation::scored(self.score(&mut network, best)),
            Err(_) => Evaluation::failed(Outcome::TooLarge),
        }
    }
}

impl Problem for Neat {
    type Gene = networks::Gene;

    /// A link from an input to an output.
    fn random_gene(&self, rng: &mut Stream) -> networks::Gene {
        let genome = Start::Minimal.genome(self.test.sockets(), &FUNCTIONS, rng);
        let genes = genome.genes();
        genes[rng.random_range(0..genes.len())]
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<networks::Gene> {
        self.start.genome(self.test.sockets(), &FUNCTIONS, rng).genes()
    }

    /// NEAT's mutation: see [`Growth`].
    fn mutate(&self, genes: &mut Vec<networks::Gene>, variation: &Variation, rng: &mut Stream) {
        let growth = Growth {
            weights_rate: variation.point_rate,
            weight_step: variation.point_amount * 2.0 * WEIGHT_MAX,
            neuron_rate: variation.duplicate_rate,
            link_rate: variation.grow_rate,
            functions: &FUNCTIONS,
            is_acyclic: self.test.wiring() == Wiring::FeedForward,
            genes_max: variation.genes_max,
        };
        // What is no network stays what it is, and scores nothing.
        if let Ok(mut genome) = Genome::of_genes(genes, self.test.sockets()) {
            growth.mutate(&mut genome, self.test.sockets(), rng);
            *genes = genome.genes();
        }
    }

    /// NEAT's crossover, of which `a` counts as the fitter parent: see [`crossover::cross`].
    fn crossover(
        &self,
        a: &[networks::Gene],
        b: &[networks::Gene],
        _variation: &Variation,
        rng: &mut Stream,
    ) -> Vec<networks::Gene> {
        match Genome::of_genes(a, self.test.sockets()) {
            Ok(mother) => crossover::cross(&mother, &self.genome(b), rng).genes(),
            Err(_) => a.to_vec(),
        }
    }

    /// δ / (1 + δ).
    fn distance(&self, a: &[networks::Gene], b: &[networks::Gene]) -> f64 {
        let delta = self.compatibility(a, b);
        delta / (1.0 + delta)
    }

    /// NEAT's δ: see [`Coefficients::distance`].
    fn compatibility(&self, a: &[networks::Gene], b: &[networks::Gene]) -> f64 {
        self.test.coefficients().distance(&self.genome(a), &self.genome(b))
    }

    fn evaluate(&self, genome: &[networks::Gene]) -> Evaluation {
        self.scored(genome, Fitness::WORST)
    }

    /// Who is no better than the best resident is not tried any longer: in the paper only the champion of a generation is.
    fn estimate(&self, genome: &[networks::Gene], hurdles: &Hurdles) -> Evaluation {
        self.scored(genome, hurdles.best)
    }

    fn has_estimates(&self) -> bool {
        self.test == Test::DoublePoleBlind
    }

    /// Hidden neurons and links in use, up to 20 and 100.
    fn features(&self, genes: &[networks::Gene]) -> [f64; 2] {
        let genome = self.genome(genes);
        let in_use = genome.links.iter().filter(|link| link.enabled).count();
        [genome.neurons.len() as f64 / 20.0, in_use as f64 / 100.0].map(|share| share.min(1.0))
    }
}
