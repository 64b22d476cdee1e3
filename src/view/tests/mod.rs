//! What a recording holds, checked by reading it back.

pub mod kit;
mod together;

use super::*;
use crate::creature::Shape;
use crate::evolution::Fitness;
use kit::*;
use nalgebra::{UnitQuaternion, Vector3};
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use std::f64::consts::TAU;
use std::path::Path;

#[test]
fn a_clip_is_one_batch_of_poses_an_entity() {
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walker(30, 4, 0.3)))?;
        recorder.champion(&clip(1, 0, walker(30, 2, 0.4)))?;
        recorder.report(&report(0, 0))?;
        recorder.report(&report(1, 0))
    });
    for island in 0..2 {
        for (kind, links) in [("boxes", 1), ("cylinders", if island == 0 { 8 } else { 4 })] {
            let path = format!("/islands/{island}/champion/{kind}");
            let poses = only(&chunks, &path, |chunk| chunk.num_rows() == 30);
            let timelines: Vec<_> = poses.timelines().keys().map(|name| name.as_str()).collect();
            assert_eq!(timelines.len(), 2, "{timelines:?}");
            let quaternions = quaternions(poses);
            assert_eq!(quaternions.len(), 30 * links, "{path}");
            for [x, y, z, w] in quaternions {
                assert!(((x * x + y * y + z * z + w * w) - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn a_champion_runs_along_its_lane_from_the_start_line_whichever_way_it_was_simulated() {
    let way = |turn: f64| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
        let mut walk = walker(30, 2, 3.0);
        for pose in walk.poses.iter_mut().flatten() {
            let [x, y, z] = pose.position_m.map(f64::from);
            let at = turn * Vector3::new(x + 3.0, y - 1.0, z);
            pose.position_m = [at.x as f32, at.y as f32, at.z as f32];
        }
        walk.scoring_from_s = 0.1;
        let chunks = record(|recorder| {
            recorder.champion(&clip(0, 0, walk))?;
            recorder.report(&report(0, 40))
        });
        points(&chunks, "/islands/0/follow", "Transform3D:translation")
    };
    for turn in [0.0, 0.7, 2.0, TAU / 2.0, -1.5] {
        let follow = way(turn);
        let ([first, ..], [.., last]) = (&follow[..], &follow[..]) else { panic!("{follow:?}") };
        assert!(first[0].abs() < 0.7 && first[1].abs() < 0.05, "{turn}: {first:?}");
        assert!(last[0] > first[0] + 0.1 && last[1].abs() < 0.05, "{turn}: {last:?}");
    }
}

#[test]
fn the_links_are_turned_into_the_lane_by_their_common_frame_alone() {
    let walk = walker(60, 2, 0.5);
    let heading = heading::Heading::of(&body(&walk.shapes).morphology, &walk);
    let [x, y] = heading.turn([0.0, 0.0]);
    let frame = heading.transform();
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walk))?;
        recorder.report(&report(0, 0))
    });
    let shift = points(&chunks, "/islands/0/champion", "Transform3D:translation");
    assert_eq!(shift, [[x, y, 0.0]]);
    assert!(frame.quaternion.is_some());
}

#[test]
fn driven_joints_have_pins_that_turn_light_and_dark_with_their_motors() {
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walker(30, 4, 0.3)))?;
        recorder.report(&report(0, 0))
    });
    let path = "/islands/0/champion/motors";
    let pins = only(&chunks, path, |chunk| chunk.num_rows() == 30);
    assert_eq!(quaternions(pins).len(), 30 * 8);
    let colors = instances(&chunks, path, "Cylinders3D:colors");
    assert!(colors.len() > 5 && colors.iter().all(|&(_, pins)| pins == 8), "{colors:?}");
    assert_ne!(palette::drive(1.0), palette::drive(-1.0));
}

#[test]
fn whoever_flies_off_has_a_ruler_that_ends() {
    let mut walk = walker(30, 1, 0.5);
    for (frame, poses) in walk.poses.iter_mut().enumerate() {
        poses.iter_mut().for_each(|pose| pose.position_m[0] = 1e9 * frame as f32);
    }
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walk))?;
        recorder.report(&report(0, 0))
    });
    let rows = instances(&chunks, "/islands/0/ruler", "LineStrips3D:strips");
    assert!(matches!(rows[..], [(0, 101..1_000)]), "{rows:?}");
}

#[test]
fn feet_are_shown_where_they_touch_the_ground_and_leave_prints() {
    let mut walk = walker(60, 1, 0.5);
    // One leg stands; the other one hops, twice.
    let times = walk.times_s.clone();
    for (poses, time) in walk.poses.iter_mut().zip(times) {
        poses.iter_mut().for_each(|pose| pose.rotation_xyzw = [0.0, 0.0, 0.0, 1.0]);
        poses[1].position_m[2] = 0.18;
        poses[2].position_m[2] = if (time * 8.0).floor() % 2.0 == 0.0 { 0.5 } else { 0.18 };
    }
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walk))?;
        recorder.report(&report(0, 40))
    });
    let seen = |name: &str| -> Vec<usize> {
        let path = format!("/islands/0/{name}");
        let rows = instances(&chunks, &path, "Cylinders3D:centers");
        rows.into_iter().map(|(_, count)| count).collect()
    };
    let touches = seen("contacts");
    assert!(touches.contains(&1) && touches.contains(&2) && touches.iter().all(|&n| n > 0));
    assert_eq!(seen("prints").last(), Some(&3), "one stands, and the other one lands twice");
}

#[test]
fn a_line_goes_one_after_another_with_a_camera_that_follows() {
    let lanes = (0..3).map(|hue| Lane { title: format!("gen {hue}"), hue }).collect();
    let card = RunCard { program: Program::Line, lanes, has_family: false, ..card(1) };
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("line.rrd");
    let mut recorder = recorder(&path, None, card).unwrap();
    for slot in 0..3 {
        recorder.play(&clip(slot, slot, walker(30, 2, 0.3)), slot).unwrap();
        recorder.score(slot, slot, Fitness::new(1.0)).unwrap();
    }
    recorder.finish().unwrap();
    let chunks = chunks(&path);
    for lane in 0..3 {
        let path = format!("/islands/{lane}/champion/boxes");
        let rows = instances(&chunks, &path, "Boxes3D:half_sizes");
        assert_eq!(rows, [(500_000_000 * i64::from(lane), 1)]);
    }
    assert_eq!(points(&chunks, "/line/follow", "Transform3D:translation").len(), 3 * 30);
    let curve = chunks.iter().filter(|c| c.entity_path().to_string() == "/fitness/line");
    assert_eq!(curve.filter(|c| !c.is_static()).map(Chunk::num_rows).sum::<usize>(), 6);
}

#[test]
fn a_kind_that_the_next_champion_lacks_is_cleared() {
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walker(30, 4, 0.3)))?;
        recorder.report(&report(0, 0))?;
        let mut legless = walker(30, 4, 0.3);
        legless.bodies = vec![1];
        legless.shapes.truncate(1);
        legless.poses.iter_mut().for_each(|links| links.truncate(1));
        recorder.champion(&clip(0, 10, legless))?;
        recorder.report(&report(0, 10))
    });
    let rows = instances(&chunks, "/islands/0/champion/cylinders", "Cylinders3D:lengths");
    assert_eq!(rows, [(0, 8), (500_000_000, 0)]);
}

#[test]
fn a_capsule_is_shown_about_its_middle_and_a_sphere_as_a_capsule_without_length() {
    let chunks = record(|recorder| {
        let mut round = walker(30, 1, 0.0);
        round.shapes[0] = Shape::Sphere { radius_m: 0.2 };
        round.shapes[1] = Shape::Capsule { radius_m: 0.1, length_m: 0.6 };
        for poses in &mut round.poses {
            poses[1] = pose(
                Vector3::new(1.0, 2.0, 3.0),
                UnitQuaternion::from_euler_angles(TAU / 4.0, 0.0, 0.0),
            );
        }
        recorder.champion(&clip(0, 0, round))?;
        recorder.report(&report(0, 0))
    });
    let path = "/islands/0/champion/capsules";
    assert_eq!(instances(&chunks, path, "Capsules3D:lengths"), [(0, 2)]);
    let poses = only(&chunks, path, |chunk| chunk.num_rows() == 30);
    let mut names = poses.components_identifiers();
    let starts = names.find(|name| name.as_str().ends_with(":translations")).unwrap();
    let first = poses.iter_slices::<[f32; 3]>(starts).next().unwrap();
    // A quarter turn about x brings its z axis to -y.
    for (found, expected) in first[1].iter().zip([1.0, 2.3, 3.0]) {
        assert!((found - expected).abs() < 1e-6, "{first:?}");
    }
}

#[test]
fn all_islands_move_at_the_same_film_time() {
    let chunks = record(|recorder| {
        // Island 1 is far ahead of island 0, and its champion stays.
        recorder.champion(&clip(1, 0, walker(30, 4, 0.3)))?;
        (0..=20).try_for_each(|generation| recorder.report(&report(1, generation)))?;
        recorder.champion(&clip(0, 0, walker(30, 4, 0.3)))?;
        recorder.report(&report(0, 0))?;
        recorder.champion(&clip(0, 15, walker(30, 4, 0.3)))?;
        recorder.report(&report(0, 20))
    });
    let starts = |island: u32| {
        let path = format!("/islands/{island}/champion/boxes");
        instances(&chunks, &path, "Boxes3D:half_sizes")
    };
    assert_eq!(starts(0), starts(1));
    assert_eq!(starts(0), [(0, 1), (500_000_000, 1), (1_000_000_000, 1)]);
}

#[test]
fn figures_stand_at_the_film_time_of_their_generation() {
    let chunks = record(|recorder| recorder.report(&report(1, 15)));
    let chunk = only(&chunks, "/fitness/best/1", |chunk| !chunk.is_static());
    let at = |name| chunk.timelines().values().find(|t| t.name() == name).unwrap().times_raw();
    assert_eq!((at(PLAYBACK), at(GENERATION)), (&[750_000_000][..], &[15][..]));
    // What has no score has no point in the plot.
    let mut failed = report(0, 0);
    failed.statistics.best = Fitness::WORST;
    let chunks = record(|recorder| recorder.report(&failed));
    assert!(
        !chunks.iter().any(|c| c.entity_path().to_string() == "/fitness/best/0" && !c.is_static())
    );
}

/// The names of the views of a film, in order, and whether they are to be shown.
fn views(card: RunCard) -> (Vec<String>, bool) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    recorder(&path, None, card).unwrap().finish().unwrap();
    let mut names = Vec::new();
    let mut activated = false;
    for message in messages(&path) {
        activated |= matches!(message, LogMsg::BlueprintActivationCommand(_));
        if let Some(chunk) = chunk_of(&message, StoreKind::Blueprint) {
            names.extend(texts(&chunk, "ViewBlueprint:display_name"));
        }
    }
    names.sort();
    (names, activated)
}

#[test]
fn where_there_are_no_bodies_there_is_no_stage() {
    let card = RunCard { has_stage: false, unit: String::new(), ..card(2) };
    let expected = [
        "Best fitness",
        "Diversity (mean distance of genomes, 0–1)",
        "Events",
        "Family",
        "Island state",
        "Mean fitness",
        "Run",
        "Spread 0",
        "Spread 1",
        "Topology",
    ];
    let (names, activated) = views(card);
    assert_eq!(names, expected);
    assert!(activated);
}

#[test]
fn every_island_has_a_view() {
    let (names, activated) = views(card(2));
    let expected = [
        "Best fitness (m)",
        "Diversity (mean distance of genomes, 0–1)",
        "Events",
        "Family",
        "Island 0",
        "Island 1",
        "Island state",
        "Mean fitness (m)",
        "Race",
        "Run",
        "Spread 0 (m)",
        "Spread 1 (m)",
        "Topology",
    ];
    assert_eq!(names, expected);
    assert!(activated);
}

#[test]
fn a_taken_port_is_passed_over() {
    let directory = tempfile::tempdir().unwrap();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let live = Live { port, ..Live::default() };
    let recorder = recorder(&directory.path().join("a.rrd"), Some(live), card(1)).unwrap();
    let address = recorder.address().unwrap();
    assert!(address.starts_with("rerun+http://127.0.0.1:"), "{address}");
    assert!(!address.contains(&format!(":{port}/")), "{address}");
    recorder.finish().unwrap();
}

#[test]
fn recorders_that_start_at_once_serve_on_different_ports() {
    let directory = tempfile::tempdir().unwrap();
    let recorders: Vec<Recorder> = std::thread::scope(|scope| {
        let create = |i| {
            let path = directory.path().join(format!("{i}.rrd"));
            recorder(&path, Some(Live::default()), card(1)).unwrap()
        };
        let threads: Vec<_> = (0..4).map(|i| scope.spawn(move || create(i))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    let mut addresses: Vec<_> = recorders.iter().map(Recorder::address).collect();
    addresses.sort();
    addresses.dedup();
    assert_eq!(addresses.len(), recorders.len(), "{addresses:?}");
    recorders.into_iter().for_each(|recorder| recorder.finish().unwrap());
}

#[test]
fn a_recording_of_before_stays_whole_until_the_new_one_takes_its_place() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    let curve = |path: &Path| {
        let chunks = chunks(path);
        let points = chunks.iter().filter(|c| c.entity_path().to_string() == "/fitness/best/0");
        points.filter(|chunk| !chunk.is_static()).map(Chunk::num_rows).sum::<usize>()
    };
    let reports = |recorder: &mut Recorder, generations: std::ops::Range<u32>| {
        generations.for_each(|generation| recorder.report(&report(0, generation)).unwrap());
    };
    let mut old = recorder(&path, None, card(1)).unwrap();
    reports(&mut old, 0..3);
    old.finish().unwrap();
    let before = std::fs::read(&path).unwrap();

    let mut new = recorder(&path, None, card(1)).unwrap();
    reports(&mut new, 0..5);
    new.flush().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), before);
    new.publish().unwrap();
    assert_eq!(curve(&path), 5);
    reports(&mut new, 5..9);
    new.publish().unwrap();
    assert_eq!(curve(&path), 9);
    reports(&mut new, 9..10);
    new.finish().unwrap();
    assert_eq!(curve(&path), 10);
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn a_recorder_that_is_dropped_before_its_recording_was_published_leaves_all_as_it_was() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    std::fs::write(&path, "old").unwrap();
    recorder(&path, None, card(1)).unwrap().report(&report(0, 0)).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn a_slot_of_the_film_opens_every_few_generations() {
    let directory = tempfile::tempdir().unwrap();
    let recorder = recorder(&directory.path().join("run.rrd"), None, card(1)).unwrap();
    let opens = (0..=30).filter(|&generation| recorder.opens_slot(generation));
    assert_eq!(opens.collect::<Vec<_>>(), [0, 10, 20, 30]);
}

/// Writes a film to look at: `VIEW_DEMO=film.rrd cargo test --release --lib view -- --ignored`.
#[test]
#[ignore = "writes a file to look at"]
fn demo() {
    let path = std::env::var("VIEW_DEMO").expect("VIEW_DEMO names the file to write");
    let islands = std::env::var("VIEW_ISLANDS").map_or(4, |n| n.parse().unwrap());
    let pace = Pace { slot_s: 8.0, generations_per_slot: 10 };
    let mut recorder = recorder(Path::new(&path), None, RunCard { pace, ..card(islands) }).unwrap();
    for generation in 0..=30 {
        for island in 0..islands {
            let speed = 0.15 + 0.01 * f64::from(generation) * (1.0 + 0.3 * f64::from(island % 5));
            if generation % 10 == 0 && generation < 30 {
                let legs = 2 + (island + generation / 10) as usize % 3;
                recorder.champion(&clip(island, generation, walker(480, legs, speed))).unwrap();
                let text = format!("island {island}: new champion, {:.2} m", speed * 8.0);
                recorder.event(Some(island), generation, &text).unwrap();
            }
            recorder.report(&report(island, generation)).unwrap();
        }
    }
    recorder.event(None, 30, "run finished").unwrap();
    recorder.finish().unwrap();
}
