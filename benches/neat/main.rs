//! What NEAT needs to pass its tests, beside the figures of its paper.
//!
//! `cargo bench --bench neat -- xor --seeds 100` runs so many seeds of a test, in one process and one after the other on
//! each thread, until it is passed or its budget is spent; `--first 101` begins with that seed. Runs of the gate try none:
//! they are long.

#![allow(clippy::print_stdout, reason = "it prints its table")]

use islands::archipelago::lockstep;
use islands::evolution::{Fitness, Founders, Individual};
use islands::networks::{Gene, Genome};
use islands::problems::Neat;
use islands::problems::neat::Test;
use islands::runs::config::{Config, Wish};
use rayon::prelude::*;
use std::cell::RefCell;

/// What is told apart: settings laid over those of a test, as they stand in a run.toml.
const VARIANTS: [(&str, &str); 7] = [
    ("neat", ""),
    ("no growth", "start = \"layer:10\"\ngrow-rate = 0.0\nduplicate-rate = 0.0"),
    ("no species", "survival = \"generational\"\nelites = 1\nselection = \"truncation:0.2\""),
    ("random start", "start = \"random:10\""),
    ("no mating", "crossover-rate = 0.0"),
    ("four islands", "islands = 4"),
    ("four islands of a quarter", "islands = 4\npopulation = 38"),
];

/// What a run came to.
struct End {
    evaluations: u64,
    births: u64,
    solver: Option<Individual<Gene>>,
    species: f64,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let Some(test) = words.first().and_then(|word| word.parse::<Test>().ok()) else {
        println!("say which: xor, double-pole or double-pole-blind; see the top of this file");
        return;
    };
    let said = |flag: &str| words.iter().position(|word| word == flag).map(|at| &words[at + 1..]);
    let number = |flag: &str, usual: u64| {
        said(flag).and_then(|rest| rest.first()?.parse().ok()).unwrap_or(usual)
    };
    let (first, seeds) = (number("--first", 1), number("--seeds", 50));
    let budget = number("--budget", 100_000);
    let only: Vec<String> = said("--variant").map(|rest| vec![rest[0].clone()]).unwrap_or_default();
    let more = said("--set").map(|rest| rest[0].replace(';', "\n")).unwrap_or_default();
    println!(
        "| {test} | runs | failed | evaluations: mean | sd | worst | births: mean | hidden | links in use | species | starts held |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, settings) in VARIANTS.iter().filter(|it| only.is_empty() || only[0] == it.0) {
        let text = format!("problem = \"{test}\"\nislands = 1\n");
        let mut table: toml::Table = toml::from_str(&text).expect("it is TOML");
        for over in [settings, &more.as_str()] {
            table.extend(toml::from_str::<toml::Table>(over).expect("it is TOML"));
        }
        let config = Config::of_table(table, Wish::default()).expect("these are settings");
        let runs: Vec<End> = (first..first + seeds)
            .into_par_iter()
            .map(|seed| run(test, &config, seed, budget))
            .collect();
        println!("{}", row(name, test, &config, &runs));
    }
}

fn run(test: Test, config: &Config, seed: u64, budget: u64) -> End {
    let config = Config { seed: Some(seed), ..config.clone() };
    let problem = Neat { test, start: config.start };
    let target = Fitness::new(test.solved_from());
    let end = RefCell::new(End { evaluations: 0, births: 0, solver: None, species: 0.0 });
    let (mut generations, mut species) = (0.0, 0.0);
    lockstep::run_until(
        &problem,
        &Founders::NONE,
        &config.archipelago(),
        u32::MAX,
        |step| {
            let mut end = end.borrow_mut();
            end.evaluations += step.report.effort.evaluations;
            end.births += step.births.births.len() as u64;
            generations += 1.0;
            species += f64::from(step.report.species);
            end.species = species / generations;
            let champion = &step.island.champion;
            if champion.fitness >= target && end.solver.is_none() {
                end.solver = Some(champion.clone());
            }
        },
        |_| {
            let end = end.borrow();
            end.solver.is_some() || end.evaluations >= budget
        },
    );
    end.into_inner()
}

fn row(name: &str, test: Test, config: &Config, runs: &[End]) -> String {
    let solved: Vec<&End> = runs.iter().filter(|end| end.solver.is_some()).collect();
    let mean = |of: &dyn Fn(&End) -> f64| {
        solved.iter().map(|end| of(end)).sum::<f64>() / solved.len().max(1) as f64
    };
    let evaluations = mean(&|end| end.evaluations as f64);
    let variance = mean(&|end| {
        let off = end.evaluations as f64 - evaluations;
        off * off
    });
    let worst = solved.iter().map(|end| end.evaluations).max().unwrap_or(0);
    let genome = |end: &End| {
        let genes = end.solver.as_ref().map(|one| one.genome.clone()).unwrap_or_default();
        Genome::of_genes(&genes, test.sockets()).unwrap_or_default()
    };
    let hidden = mean(&|end| genome(end).neurons.len() as f64);
    let links = mean(&|end| genome(end).links.iter().filter(|link| link.enabled).count() as f64);
    let problem = Neat { test, start: config.start };
    let held = |end: &End| {
        let genes = &end.solver.as_ref().expect("it is one that solved it").genome;
        problem.starts_held(genes).unwrap_or(0) as f64
    };
    format!(
        "| {name} | {} | {} | {evaluations:.0} | {:.0} | {worst} | {:.0} | {hidden:.2} | {links:.2} | {:.1} | {:.0} |",
        runs.len(),
        runs.len() - solved.len(),
        variance.sqrt(),
        mean(&|end| end.births as f64),
        mean(&|end| end.species),
        mean(&held),
    )
}
