//! An island-model genetic algorithm that evolves virtual creatures.
//!
//! Several island processes each evolve a population of creatures, simulate them in a physics engine, and
//! exchange their best through shared memory. A run is a function of its seed: the same seed gives the
//! same final populations to the last bit, whatever the number of threads, the scheduling or the build.
//!
//! The [`guide`] says how to use the program. This page is for those who read or change the code.
//!
//! # A tour, by floors
//!
//! A module imports only from floors below its own; a test reads the sources and makes sure.
//!
//! | floor | module | what it is |
//! |---|---|---|
//! | 0 | [`rng`] | an address (seed, island, generation, index, purpose) becomes a stream of random numbers |
//! |   | [`choice`] | settings that are one of a few, by their names |
//! |   | [`statistics`] | what repeated runs come to, and whether two sets of them differ |
//! |   | [`work_queue`] | work dealt out to threads, the dearest first |
//! | 1 | [`evolution`] | problems, fitness, selection, variation, survival: a genetic algorithm that knows no creature |
//! |   | [`networks`] | networks that grow (NEAT), and what their neurons do |
//! | 2 | [`creature`] | genes become a body and what moves it, knowing no physics engine |
//! |   | [`archipelago`] | islands, their step as a pure function, who sends what to whom when |
//! | 3 | [`simulation`] | bodies tried in rapier or a stepper of our own |
//! | 4 | [`problems`] | what can be evolved: creatures that move, points of functions, bits, networks |
//! | 5 | [`transport`] | exchange between processes through iceoryx2 |
//! |   | [`store`] | what a run leaves on disk |
//! |   | [`formats`] | files for people and other programs |
//! |   | `view` | the run as a film in Rerun (feature `view`) |
//! | 6 | [`runs`] | a run as a library: its configuration, the catalogue of problems, its summary |
//! | 7 | [`app`] | the program |
//! | 8 | [`guide`] | the user's guide, which is text alone |
//!
//! Start with [`archipelago::island::step`], one generation of one island as a list of phases, and
//! [`archipelago::lockstep`], a whole run in twenty lines.
//!
//! # Invariants
//!
//! - **Randomness has an address.** No generator state is stored or shared, so no order of execution matters.
//! - **A score is a pure function of the genome.** An elite and a duplicate are not simulated again, and whoever
//!   simulates a champion gets its fitness bit for bit. Offspring that do not matter may have an estimate instead,
//!   which is a pure function of the genome and of hurdles that are part of an island's state
//!   ([`evolution::hurdles`]).
//! - **What a run claims is not what it selected by**: a champion is tried again on perturbations that nobody was
//!   selected on, in both engines ([`problems::validation`]).
//! - **Floors 0 to 4 touch no clock, file or process**, and all transcendental functions on the way to a
//!   fitness are libm's.
//! - **A fitness is never NaN.** What cannot be scored has a named [`evolution::Outcome`], which physics calls a
//!   [`simulation::Failure`], and the worst fitness.
//! - **Each heavy dependency has one importer**: rapier3d `simulation`, iceoryx2 `transport`, bincode `store`,
//!   rerun `view`, plotters `formats`, clap `app`.
//!
//! # A run in one process
//!
//! ```
//! use islands::runs::config::Config;
//! use islands::archipelago::{Digest, lockstep};
//!
//! let config = Config { islands: 2, population: 3, elites: 1, genes: 2, seed: Some(7), ..Config::default() };
//! let islands = lockstep::run(&config.locomotion(), &config.archipelago(), 1, |step| {
//!     println!("island {} has walked {:?}", step.report.island, step.report.statistics.best);
//! });
//! println!("{}", Digest::of(&islands));
//! ```

pub mod choice;
pub mod rng;
pub mod statistics;
pub mod work_queue;

pub mod creature;
pub mod evolution;
pub mod networks;

pub mod archipelago;
pub mod simulation;

pub mod problems;

pub mod formats;
pub mod store;
pub mod transport;
#[cfg(feature = "view")]
pub mod view;

pub mod runs;

pub mod app;

pub mod guide;
