//! Whoever watches a run, and however badly, it is the same run.

use crate::support::onlooker::{Onlooker, port_of};
use crate::support::reel::Recording;
use crate::support::{Running, World, until};
use islands::store::RunDir;
use std::thread::sleep;
use std::time::Duration;

/// A run whose film is many megabytes: more than the system keeps for a viewer that does not read.
const RUN: &str =
    "--n 2 --seed 53 --population 4 --robustness 2 --generations 24 --genes 2 --clip-every 1";
/// What comes before the first thing that is shown.
const OVERTURE: usize = 4_000;

#[test]
fn a_viewer_that_hangs_is_waited_for_by_nobody() {
    watched(|run, port| {
        let mut viewer = Onlooker::attach(port).unwrap();
        let mut seen = 0;
        while seen < OVERTURE {
            let bytes = viewer.read(OVERTURE).unwrap().len();
            assert!(bytes > 0, "the film ended after {seen} bytes");
            seen += bytes;
        }
        until("the run is over", || !run.is_alive());
        drop(viewer);
    });
}

#[test]
fn viewers_that_come_and_go_without_a_word_leave_no_trace() {
    watched(|run, port| {
        let mut visits = 0;
        for visit in 0..300 {
            let Ok(mut viewer) = Onlooker::attach(port) else { break };
            visits += 1;
            // Some leave at once, some amid the film. What was not read makes the end an abrupt one.
            for _ in 0..visit % 4 {
                // A run that is over resets what it does not end.
                if viewer.read(700).is_err() {
                    break;
                }
            }
            if !run.is_alive() {
                break;
            }
        }
        assert!(visits >= 10, "{visits}");
    });
}

#[test]
fn a_viewer_that_reads_a_little_now_and_then_holds_up_nobody() {
    watched(|run, port| {
        let mut viewer = Onlooker::attach(port).unwrap();
        let mut seen = 0;
        while run.is_alive() {
            seen += viewer.read(1_000).map_or(0, |bytes| bytes.len());
            sleep(Duration::from_millis(20));
        }
        assert!(seen >= OVERTURE, "{seen}");
    });
}

/// Runs a run that is watched in some way, and asserts that it ends as if it was not, with the same film, made by
/// one and the same monitor.
fn watched(watch: impl FnOnce(&Running, u16)) {
    let world = World::new();
    let expected = world.digest("alone", RUN);
    assert_eq!(world.islands("monitor alone").code, Some(0));
    let run = world.start(&format!("--out run --quiet --json {RUN}"));
    let log = RunDir::at(world.path("run")).log();
    let mut port = None;
    until("it is served", || {
        port = std::fs::read_to_string(&log).ok().and_then(|log| port_of(&log));
        port.is_some()
    });
    let monitor = run.child("monitor");
    watch(&run, port.unwrap());
    assert!(run.find_child("monitor").is_none_or(|found| found == monitor));
    let ending = run.wait();
    // A death of the monitor would be said.
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    assert_eq!(ending.json()["digest"], expected);
    let films =
        ["alone", "run"].map(|name| Recording::read(&world.path(&format!("{name}/recording.rrd"))));
    assert_eq!(films[1].generations(2), Vec::from_iter(0..=24));
    let [alone, watched] = films.map(|film| film.rows());
    assert!(alone == watched);
    world.assert_left_nothing();
}
