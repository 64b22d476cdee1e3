//! What a run claims is what its champion gets on trials that nobody selected it on: recorded, shown, and checked.

use crate::support::World;
use islands::archipelago::Champion;
use islands::creature::Gene;
use islands::evolution::{Fitness, Problem};
use islands::runs::config::Config;
use islands::store::{RecordLog, RunDir};

const TINY: &str = "--population 4 --generations 3 --genes 2 --migration-interval 1";

fn evolved(world: &World, judged: bool) -> (serde_json::Value, Vec<Champion<Gene>>) {
    let settings = format!("--n 2 --seed 3 --robustness 3 --judged={judged} --no-monitor {TINY}");
    let result = world.json(&format!("--out run --json {settings}"));
    let dir = RunDir::at(world.path("run"));
    let log = |island| RecordLog::<Champion<Gene>>::read(&dir.champions(island)).unwrap().records;
    (result, [0, 1].into_iter().flat_map(log).collect())
}

#[test]
fn every_champion_has_its_whole_score_and_what_of_it_holds() {
    check_champions(false);
}

#[test]
fn judged_champions_have_their_whole_scores_and_what_of_them_holds() {
    check_champions(true);
}

fn check_champions(judged: bool) {
    let world = World::new();
    let (result, champions) = evolved(&world, judged);
    let problem = Config::read(&RunDir::at(world.path("run")).config()).unwrap().locomotion();
    assert_eq!(problem.judged, judged);
    for champion in &champions {
        let genome = &champion.individual.genome;
        assert_eq!(champion.individual.fitness, problem.evaluate(genome).fitness);
        assert_eq!(champion.validated, problem.validate(genome));
    }
    // Kept is who is best in both engines, in trials that are not the fresh ones.
    let holds = |champion: &Champion<Gene>| {
        let body = problem.express(&champion.individual.genome).unwrap();
        champion.individual.fitness.min(problem.elsewhere(&body))
    };
    let kept = champions.iter().rev().max_by_key(|champion| holds(champion)).unwrap();
    let best = kept.individual.fitness.get();
    assert_eq!(result["best_fitness"].as_f64(), Some(best), "{result}");
    let engines = result["validation"].as_array().unwrap();
    let means = engines.iter().map(|one| one["mean"].as_f64().unwrap());
    assert_eq!(result["validated"].as_f64(), means.reduce(f64::min), "{result}");
    assert_eq!(engines.len(), 2);
    let verified = world.islands("verify run --thorough --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
    world.assert_left_nothing();
}

#[test]
fn evaluate_says_the_same_of_a_champion_as_its_run() {
    let world = World::new();
    let (result, _) = evolved(&world, false);
    let found = world.json("evaluate run/champion.csv --robustness 3 --trials 12 --json");
    assert_eq!(found["genomes"][0]["validation"], result["validation"]);
    assert_eq!(found["genomes"][0]["fitness"], result["best_fitness"]);
    let said = world.islands("evaluate run/champion.csv --trials 4");
    assert!(said.stdout.contains("in rapier, worst"), "{said:?}");
    assert!(said.stdout.contains("(4 fresh trials)"), "{said:?}");
    for wrong in
        ["run/champion.csv --trials 0", "one.csv --problem sphere --dimensions 1 --trials 3"]
    {
        world.write("one.csv", "0.5\n");
        let said = world.refusal(&format!("evaluate {wrong}"));
        assert!(said.contains("--trials"), "{said}");
    }
}

#[test]
fn a_run_that_begins_with_genomes_is_validated_too() {
    let world = World::new();
    world.write("one.csv", crate::formats::course::fixture("genome_0.csv"));
    let settings = "--n 1 --seed 3 --robustness 2 --seed-genomes one.csv --no-monitor";
    let result = world.json(&format!("--out run --json {settings} {TINY}"));
    assert!(result["validated"].is_number(), "{result}");
    let verified = world.islands("verify run --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
}

#[test]
fn a_forged_validation_is_found() {
    let world = World::new();
    evolved(&world, false);
    let path = RunDir::at(world.path("run")).champions(1);
    for forged in [Some(Fitness::new(99.0)), None] {
        let mut log = RecordLog::<Champion<Gene>>::open(&path).unwrap();
        let last = log.len() - 1;
        let champion = log.get(last).unwrap().unwrap();
        log.truncate(last).unwrap();
        log.append(&Champion { validated: forged, ..champion }).unwrap();
        let verified = world.islands("verify run --json");
        assert_eq!(verified.code, Some(1), "{forged:?}: {verified:?}");
    }
}

#[test]
fn what_has_no_engine_needs_no_validation() {
    let world = World::new();
    let settings = "--problem sphere --dimensions 3 --n 1 --seed 3 --generations 3 --no-monitor";
    let result = world.json(&format!("--out run --json {settings}"));
    assert!(result.get("validated").is_none(), "{result}");
    let verified = world.islands("verify run --json");
    assert_eq!(verified.code, Some(0), "{verified:?}");
}
