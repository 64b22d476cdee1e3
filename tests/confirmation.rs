//! What a fast engine evolves, the engine of record confirms: both numbers are recorded, shown, and checked.

use crate::support::{TINY, World};
use islands::app::config::Config;
use islands::archipelago::Champion;
use islands::creature::Gene;
use islands::evolution::{Fitness, Problem};
use islands::problems::Locomotion;
use islands::simulation::Engine;
use islands::store::{RecordLog, RunDir};

fn evolved(world: &World) -> (serde_json::Value, Vec<Champion<Gene>>) {
    let settings = format!("--n 2 --seed 3 --engine featherstone --no-monitor {TINY}");
    let result = world.json(&format!("--out run --json {settings}"));
    let dir = RunDir::at(world.path("run"));
    let log = |island| RecordLog::<Champion<Gene>>::read(&dir.champions(island)).unwrap().records;
    (result, [0, 1].into_iter().flat_map(log).collect())
}

#[test]
fn every_champion_of_another_engine_is_scored_again_by_rapier() {
    let world = World::new();
    let (result, champions) = evolved(&world);
    let problem = Config::read(&RunDir::at(world.path("run")).config()).unwrap().locomotion();
    assert_eq!(problem.engine, Engine::Featherstone);
    let judge = Locomotion { engine: Engine::Rapier, ..problem };
    for champion in &champions {
        let genome = &champion.individual.genome;
        assert_eq!(champion.individual.fitness, problem.evaluate(genome).fitness);
        assert_eq!(champion.confirmed, Some(judge.evaluate(genome).fitness));
    }
    // Nobody is kept who stands below another in the eyes of rapier, however good the fast engine finds him.
    let best = champions.iter().map(Champion::standing).max().unwrap();
    assert_eq!(result["best_confirmed"].as_f64(), Some(best.get()), "{result}");
    let kept = champions.iter().find(|champion| champion.standing() == best).unwrap();
    assert_eq!(result["best_fitness"].as_f64(), Some(kept.individual.fitness.get()), "{result}");
    let verified = world.islands("verify run --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
    world.assert_left_nothing();
}

#[test]
fn a_run_that_begins_with_genomes_is_confirmed_too() {
    let world = World::new();
    world.write("one.csv", crate::course::fixture("genome_0.csv"));
    let settings = "--n 1 --seed 3 --engine featherstone --seed-genomes one.csv --no-monitor";
    let result = world.json(&format!("--out run --json {settings} {TINY}"));
    assert!(result["best_confirmed"].is_number(), "{result}");
    let verified = world.islands("verify run --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
}

#[test]
fn a_forged_confirmation_is_found() {
    let world = World::new();
    evolved(&world);
    let path = RunDir::at(world.path("run")).champions(1);
    for forged in [Some(Fitness::new(99.0)), None] {
        let mut log = RecordLog::<Champion<Gene>>::open(&path).unwrap();
        let last = log.len() - 1;
        let champion = log.get(last).unwrap().unwrap();
        log.truncate(last).unwrap();
        log.append(&Champion { confirmed: forged, ..champion }).unwrap();
        let verified = world.islands("verify run --json");
        assert_eq!(verified.code, Some(1), "{forged:?}: {verified:?}");
    }
}

#[test]
fn a_run_of_rapier_needs_no_judge() {
    let world = World::new();
    let result = world.json(&format!("--n 1 --seed 3 --out run --no-monitor --json {TINY}"));
    assert!(result.get("best_confirmed").is_none(), "{result}");
    let path = RunDir::at(world.path("run")).champions(0);
    let champions = RecordLog::<Champion<Gene>>::read(&path).unwrap().records;
    assert!(champions.iter().all(|champion| champion.confirmed.is_none()));
}
