//! What a recording holds, checked by reading it back.

use super::*;
use crate::archipelago::island::Report;
use crate::creature::morphology::Shape;
use crate::evolution::generation::Effort;
use crate::evolution::{Fitness, Spread, Statistics};
use crate::simulation::trajectory::{Pose, Trajectory};
use nalgebra::{UnitQuaternion, Vector3};
use re_log_encoding::DecoderApp;
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use std::f64::consts::TAU;
use std::fs::File;
use std::io::BufReader;
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
fn a_kind_that_the_next_champion_lacks_is_cleared() {
    let chunks = record(|recorder| {
        recorder.champion(&clip(0, 0, walker(30, 4, 0.3)))?;
        recorder.report(&report(0, 0))?;
        let mut legless = walker(30, 4, 0.3);
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

#[test]
fn every_island_has_a_view() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    recorder(&path, None, card(2)).unwrap().finish().unwrap();
    let mut names = Vec::new();
    let mut activated = false;
    for message in messages(&path) {
        activated |= matches!(message, LogMsg::BlueprintActivationCommand(_));
        if let Some(chunk) = chunk_of(&message, StoreKind::Blueprint) {
            names.extend(texts(&chunk, "ViewBlueprint:display_name"));
        }
    }
    names.sort();
    let expected = [
        "Best fitness (m)",
        "Diversity",
        "Events",
        "Island 0",
        "Island 1",
        "Mean fitness (m)",
        "Race",
        "Run",
        "Spread 0",
        "Spread 1",
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

fn card(islands: u32) -> RunCard {
    RunCard {
        islands,
        unit: "m".into(),
        description_markdown: "# A run\n\nseed 1".into(),
        topology_edges: (0..islands).map(|i| (i, (i + 1) % islands)).collect(),
        pace: Pace { slot_s: 0.5, generations_per_slot: 10 },
    }
}

fn clip(island: u32, generation: u32, trajectory: Trajectory) -> Clip {
    let label = format!("gen {generation} · 1.50 m");
    Clip { island, generation, label, trajectory }
}

fn report(island: u32, generation: u32) -> Report {
    let g = f64::from(generation);
    let best = Fitness::new((0.5 + 0.1 * f64::from(island)) * (g / 3.0).floor());
    let mean = Fitness::new(0.6 * best.get());
    let statistics = Statistics {
        best,
        mean,
        median: mean,
        diversity: 1.0 / (1.0 + g * (1.0 + 0.2 * f64::from(island)) / 10.0),
        spread: Spread::of(&(0..50).map(|i| f64::from(i * i) / 1000.0).collect::<Vec<_>>()),
    };
    Report { island, generation, statistics, effort: Effort::default(), immigrants: 0 }
}

/// A box that walks along x on pairs of legs of two cylinders each, at 60 frames a second.
fn walker(frames: usize, pairs: usize, speed_mps: f64) -> Trajectory {
    let half = Vector3::new(0.2 * pairs as f64, 0.2, 0.13);
    let leg = Shape::Cylinder { radius_m: 0.06, length_m: 0.36 };
    let mut shapes = vec![Shape::Cuboid { half_extents_m: half }];
    shapes.extend(std::iter::repeat_n(leg, pairs * 2));
    let times_s: Vec<f64> = (0..frames).map(|frame| frame as f64 / 60.0).collect();
    let poses = times_s.iter().map(|&time| stride(time, pairs, half, speed_mps)).collect();
    Trajectory { shapes, times_s, poses, scoring_from_s: 0.0 }
}

fn stride(time_s: f64, pairs: usize, half: Vector3<f64>, speed_mps: f64) -> Vec<Pose> {
    let trunk = Vector3::new(speed_mps * time_s, 0.1 * time_s.sin(), 0.42);
    let roll = UnitQuaternion::from_euler_angles(0.05 * (TAU * time_s).sin(), 0.0, 0.0);
    let mut poses = vec![pose(trunk, roll)];
    for pair in 0..pairs {
        for side in [-1.0, 1.0] {
            let along = half.x * (2.0 * (pair as f64 + 0.5) / pairs as f64 - 1.0);
            let phase =
                TAU * time_s * 1.2 + if (side > 0.0) ^ (pair % 2 == 0) { 0.0 } else { TAU / 2.0 };
            let swing = UnitQuaternion::from_euler_angles(-0.3 * side, 0.6 * phase.sin(), 0.0);
            let hip = trunk + Vector3::new(along, side * half.y, -0.05);
            poses.push(pose(hip + swing * Vector3::new(0.0, 0.0, -0.18), swing));
        }
    }
    poses
}

fn pose(position: Vector3<f64>, rotation: UnitQuaternion<f64>) -> Pose {
    let position_m = [position.x as f32, position.y as f32, position.z as f32];
    let [i, j, k, w] = [rotation.i, rotation.j, rotation.k, rotation.w].map(|v| v as f32);
    Pose { position_m, rotation_xyzw: [i, j, k, w] }
}

/// What a recording of two islands holds in the end.
fn record(write: impl FnOnce(&mut Recorder) -> Result<(), ViewError>) -> Vec<Chunk> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    let mut recorder = recorder(&path, None, card(2)).unwrap();
    write(&mut recorder).unwrap();
    recorder.finish().unwrap();
    chunks(&path)
}

fn recorder(path: &Path, live: Option<Live>, card: RunCard) -> Result<Recorder, ViewError> {
    let folder = path.parent().unwrap();
    Recorder::create(Draft::within(folder, path)?, live, card)
}

fn chunks(path: &Path) -> Vec<Chunk> {
    messages(path).iter().flat_map(|message| chunk_of(message, StoreKind::Recording)).collect()
}

fn messages(path: &Path) -> Vec<LogMsg> {
    let file = BufReader::new(File::open(path).unwrap());
    DecoderApp::decode_eager(file).unwrap().map(Result::unwrap).collect()
}

fn chunk_of(message: &LogMsg, kind: StoreKind) -> Option<Chunk> {
    match message {
        LogMsg::ArrowMsg(store, arrow) if store.kind() == kind => {
            Some(Chunk::from_arrow_msg(arrow).unwrap())
        }
        _ => None,
    }
}

fn only<'a>(chunks: &'a [Chunk], path: &str, wanted: impl Fn(&Chunk) -> bool) -> &'a Chunk {
    let found: Vec<_> = chunks
        .iter()
        .filter(|chunk| chunk.entity_path().to_string() == path && wanted(chunk))
        .collect();
    assert_eq!(found.len(), 1, "{path}");
    found[0]
}

/// The film time in nanoseconds and the number of instances of each row of a component.
fn instances(chunks: &[Chunk], path: &str, component: &'static str) -> Vec<(i64, usize)> {
    let mut rows = Vec::new();
    for chunk in chunks.iter().filter(|chunk| chunk.entity_path().to_string() == path) {
        let Some(column) = chunk.components().get(component.into()) else { continue };
        let times = chunk.timelines().values().find(|t| t.name() == PLAYBACK).unwrap().times_raw();
        rows.extend(
            times.iter().enumerate().map(|(row, &time)| (time, column.list_array.value(row).len())),
        );
    }
    rows.sort_unstable();
    rows
}

fn quaternions(chunk: &Chunk) -> Vec<[f32; 4]> {
    let component = chunk
        .components_identifiers()
        .find(|component| component.as_str().ends_with(":quaternions"))
        .unwrap();
    chunk.iter_slices::<[f32; 4]>(component).flatten().copied().collect()
}

fn texts(chunk: &Chunk, component: &'static str) -> Vec<String> {
    chunk.iter_slices::<String>(component.into()).flatten().map(|text| text.to_string()).collect()
}
