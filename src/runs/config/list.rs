//! Every setting of a run, each said once.

use super::limits::{GENES_MAX, ISLANDS_MAX, LINKS_MAX, POPULATION_MAX, THREADS_MAX};
use super::parts::Parts;
use super::written::{Launch, SeedGenomes};
use crate::archipelago::{Algorithm, Emigrants, ExchangeMode, Replacement, Topology};
use crate::creature::{Profile, Scales};
use crate::evolution::{Adaptation, Crossover, Mutation, Selection, Survival};
use crate::networks::Start;
use crate::problems::{RobustBy, Robustness, Task};
use crate::runs::kind::Kind;
use crate::runs::setting::Section::{Creatures, GeneticAlgorithm, Run, Running, Vectors};
use crate::runs::setting::{self, About, Bounds, Number, Section, Setting, of, settings};
use crate::runs::terrains::KeptTerrain;
use crate::simulation::Engine;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// What decides whose offspring there are.
const BREEDING: About = of(GeneticAlgorithm).for_algorithm(Algorithm::is_genetic);
/// What decides how offspring differ from their parents.
const MUTATION: About = of(GeneticAlgorithm).for_algorithm(Algorithm::mutates);
/// What islands exchange.
const EXCHANGE: About = of(Section::Migration).for_algorithm(Algorithm::has_islands);

settings! {
    /// Number of islands, each a process
    islands: u32 => archipelago.islands,
        of(Run).flag("n").value("N"), in |_| 1.0..=f64::from(ISLANDS_MAX);
    /// Seed that fixes the result
    seed: u64,
        of(Run).value("SEED").usually("picked and printed").not_in_experiments("say seeds, above all tables");
    /// Problem
    problem: Kind = Kind::Creatures, of(Run).value("PROBLEM").one_of(Kind::list);
    /// Search algorithm: ga (a genetic algorithm on islands), panmictic (the same in one large population), hill-climb,
    /// cma-es or random
    algorithm: Algorithm = Algorithm::Ga, of(Run).value("ALGORITHM");
    /// Generations after the random first one
    generations: u32 = 140, of(Run).value("G").free(), in |_| 0.0..=1e9;
    /// Individuals on each island
    population: usize => archipelago.strategy.population,
        of(Run).value("P"), in |_| 2.0..=POPULATION_MAX as f64;

    /// Variables of a function, or bits of a genome
    dimensions: usize = 30, of(Vectors).value("N").for_problem(Kind::is_of_one_length);
    /// Instance of a function: a number that fixes its shift and its rotation
    instance: u64 = 1, of(Vectors).value("I").for_problem(Kind::is_function);
    /// Rotate the function, so that its variables depend on each other
    rotated: bool = false, of(Vectors).for_problem(Kind::is_function);
    /// Bits of a block of trap or royal-road
    block: usize = 5, of(Vectors).value("K").for_problem(Kind::has_blocks);
    /// First networks: minimal (nothing hidden), layer:NEURONS or random:NEURONS
    start: Start = Start::Minimal, of(Vectors).value("HOW").for_problem(Kind::is_network);

    /// Task of creatures
    task: Task => locomotion.task, of(Creatures).value("TASK").tries_bodies().one_of(Task::list);
    /// How genes are read: native, lecture or coursework
    profile: Profile => locomotion.encoding.profile, of(Creatures).value("PROFILE").tries_bodies();
    /// Physics engine: featherstone (our own, ten times as fast) or rapier
    engine: Engine => locomotion.engine, of(Creatures).value("ENGINE").tries_bodies();
    /// Number of perturbed trials that score a genome; a would-be best has four times as many. Friction, motor strength,
    /// first direction, a push and the step differ, so that luck counts little. 0 means one trial without perturbation
    robustness: u32 => locomotion.robustness.trials,
        of(Creatures).value("K").tries_bodies(), in |_| 0.0..=f64::from(Robustness::TRIALS_MAX);
    /// How the scores of these trials are combined: mean, median, quartile (the lower one) or worst
    robust_by: RobustBy => locomotion.robustness.by, of(Creatures).value("HOW").tries_bodies();
    /// Let the other engine judge would-be champions and emigrants: where it finds less than 0.85 of a score, its own
    /// finding counts
    judged: bool => locomotion.judged, of(Creatures).tries_bodies();
    /// Largest number of links of a body; profile coursework has its own
    max_links: usize => locomotion.encoding.links_max,
        of(Creatures).value("L").tries_bodies(), in |_| 1.0..=LINKS_MAX as f64;

    /// Genes of a random genome
    genes: usize => locomotion.encoding.genes,
        of(GeneticAlgorithm).value("G").for_problem(Kind::has_genes), in |it| 1.0..=genes_max(it);
    /// Largest number of genes of a genome
    max_genes: usize => archipelago.strategy.variation.genes_max,
        of(GeneticAlgorithm).value("G").for_problem(Kind::is_of_any_length), in |_| 1.0..=GENES_MAX as f64;
    /// How parents are picked: roulette, sus, tournament:SIZE, rank:PRESSURE or truncation:FRACTION; with --survival
    /// sharing the default is sus
    selection: Selection => archipelago.strategy.selection,
        BREEDING.value("SCHEME").for_survival(Survival::has_selection);
    /// Number of the best that live on unchanged
    elites: usize => archipelago.strategy.elites,
        BREEDING.value("E").for_survival(Survival::has_elites), in |it| 0.0..=it.population as f64 - 1.0;
    /// How the next population is made: generational, drifting, sharing:RADIUS, species:RADIUS (as NEAT
    /// has them), crowding, afpo or map-elites:BINS
    survival: Survival => archipelago.strategy.survival,
        BREEDING.value("SCHEME");
    /// How two parents are recombined: one-point, two-point, uniform, blend:ALPHA or sbx:ETA
    crossover: Crossover => archipelago.strategy.variation.crossover,
        BREEDING.value("OPERATOR").for_problem(Kind::has_sequences);
    /// Probability that an offspring has two parents
    crossover_rate: f64 => archipelago.strategy.variation.crossover_rate,
        BREEDING.value("0..1"), in |_| 0.0..=1.0;
    /// How a value is changed: uniform, gaussian or polynomial:ETA
    mutation: Mutation => archipelago.strategy.variation.mutation,
        MUTATION.value("OPERATOR").for_problem(Kind::has_vectors);
    /// Probability that a value of a gene changes; for networks, that the weights of an offspring change
    point_rate: f64 => archipelago.strategy.variation.point_rate,
        MUTATION.value("0..1"), in |_| 0.0..=1.0;
    /// Scale of such a change, as a share of the value's range
    point_amount: f64 => archipelago.strategy.variation.point_amount,
        MUTATION.value("0..1").for_problem(Kind::has_numbers), in |_| 0.0..=1.0;
    /// Probability that an offspring loses a gene
    shrink_rate: f64 => archipelago.strategy.variation.shrink_rate,
        MUTATION.value("0..1").for_problem(Kind::has_genes), in |_| 0.0..=1.0;
    /// Probability that an offspring gains a gene; for networks, a link
    grow_rate: f64 => archipelago.strategy.variation.grow_rate,
        MUTATION.value("0..1").for_problem(Kind::is_of_any_length), in |_| 0.0..=1.0;
    /// Probability that an offspring repeats one of its limbs; for networks, that a new neuron splits a link
    duplicate_rate: f64 => archipelago.strategy.variation.duplicate_rate,
        MUTATION.value("0..1").for_problem(Kind::is_of_any_length), in |_| 0.0..=1.0;
    /// Rule that adapts the scale of mutation during a run: none, or one-fifth (the 1/5 success rule)
    adaptation: Adaptation => archipelago.strategy.adaptation,
        MUTATION.value("RULE").for_problem(Kind::has_vectors);
    /// Give each island crossover and mutation rates of its own
    heterogeneous: bool => archipelago.strategy.heterogeneous,
        of(GeneticAlgorithm).for_algorithm(Algorithm::has_islands);

    /// Who sends migrants to whom: ring, bidirectional-ring, full, torus, star, hypercube, random-regular:DEGREE or none
    topology: Topology => archipelago.topology,
        EXCHANGE.value("GRAPH");
    /// Generations between two exchanges of migrants
    migration_interval: u32 => archipelago.migration.interval,
        EXCHANGE.value("G"), in |_| 1.0..=1e9;
    /// Individuals that an island sends at each exchange
    migrants: usize => archipelago.migration.migrants, EXCHANGE.value("M");
    /// Number of exchanges by which migrants arrive later, so that no island waits
    migration_lag: u32 => archipelago.migration.lag,
        EXCHANGE.value("L"), in |_| 0.0..=1e3;
    /// Who is sent: best, random or tournament:SIZE
    emigrants: Emigrants => archipelago.migration.emigrants,
        EXCHANGE.value("WHO");
    /// Whom an immigrant replaces: worst (if it is better), random (any but the best) or similar (the most similar, if
    /// it is better)
    replacement: Replacement => archipelago.migration.replacement,
        EXCHANGE.value("WHOM").for_survival(|survival| !survival.has_cells());
    /// Whether islands wait for each other's migrants: sync (they wait) or async (each takes in what has arrived; the seed
    /// alone does not fix the result then, but the seed and a record of what arrived do)
    exchange: ExchangeMode => archipelago.migration.exchange,
        EXCHANGE.value("HOW").not_in_experiments(
            "runs of an experiment are in lockstep, where nobody is faster than another",
        );

    /// Generations between two checkpoints of an island: what a crash costs at most
    checkpoint_interval: u32 = 1,
        of(Running).value("G").free().not_in_experiments("runs of an experiment are kept once they have finished"),
        in |_| 1.0..=1e9;
    /// Generations between two clips of an island's champion; a smaller number makes the film longer and larger
    clip_every: u32,
        of(Running).value("G").free().usually("a twelfth of all").not_in_experiments("nothing is filmed"),
        in |_| 1.0..=1e9;
    /// Threads of all islands together, at least one each; the result does not depend on it
    threads: usize,
        of(Running).value("T").free().usually("all cores").not_in_experiments("say --threads"),
        in |_| 1.0..=THREADS_MAX as f64;
}

/// The most genes of a random genome. Where `max-genes` is out of its own range, that is said of it, and not of `genes`.
fn genes_max(config: &Config) -> f64 {
    let is_sound = (1..=GENES_MAX).contains(&config.max_genes);
    if is_sound { config.max_genes as f64 } else { GENES_MAX as f64 }
}
