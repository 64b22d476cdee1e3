//! What crashed runs leave is removed, and nothing else.

use crate::support::{World, await_generation, is_alive, run_id, runs_in_shared_memory, until};
use islands::store::RunDir;
use std::fs;

const ENDLESS: &str = "--n 2 --seed 3 --population 4 --robustness 0 --generations 1000000 --genes 1 --migration-interval 1 --no-monitor";

#[test]
fn what_a_killed_launcher_left_is_removed_from_anywhere_and_a_living_run_is_not_touched() {
    let [crashed, living, elsewhere] = [World::new(), World::new(), World::new()];
    let runs = [&crashed, &living].map(|world| {
        let run = world.start(&format!("--out run --quiet {ENDLESS}"));
        await_generation(&RunDir::at(world.path("run")), 2, 0);
        run
    });
    let [dead, alive] = [&crashed, &living].map(|world| run_id(&world.read("run/run.toml")));
    let [crash, life] = runs;
    let islands = crash.children();
    crash.signal("KILL");
    crash.wait();
    until("its islands have ended, too", || islands.iter().all(|&pid| !is_alive(pid)));

    let listed = elsewhere.islands("clean --dry-run");
    assert_eq!(listed.code, Some(0), "{listed:?}");
    assert!(!listed.stdout.contains(&alive), "{listed:?}");
    let cleaned = elsewhere.islands("clean");
    assert_eq!(cleaned.code, Some(0), "{cleaned:?}");
    assert!(!cleaned.stdout.contains(&alive), "{cleaned:?}");
    // Each run that another test launches cleans up, too: who was faster is not said.
    until("nothing of it is left", || !runs_in_shared_memory().contains(&dead));
    crashed.assert_left_nothing();

    assert!(runs_in_shared_memory().contains(&alive));
    let dir = RunDir::at(living.path("run"));
    let generation = fs::read(dir.reports(1)).unwrap().len();
    until("it goes on", || fs::read(dir.reports(1)).unwrap().len() > generation);
    life.signal("INT");
    assert_eq!(life.wait().code, Some(130));
    living.assert_left_nothing();
}
