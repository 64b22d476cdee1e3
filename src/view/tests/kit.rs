//! What recordings are made of, and how they are read back.

use crate::archipelago::Report;
use crate::creature::{
    Controller, Creature, Joint, JointKind, Link, Morphology, Motor, Shape, Wave, Waveform,
};
use crate::evolution::generation::Effort;
use crate::evolution::{Fitness, Spread, Statistics};
use crate::simulation::Ground;
use crate::simulation::trajectory::{Pose, Trajectory};
use crate::view::*;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use re_log_encoding::DecoderApp;
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use std::f64::consts::TAU;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

pub fn card(islands: u32) -> RunCard {
    RunCard {
        program: Program::Run,
        lanes: Lane::of_islands(islands),
        unit: "m".into(),
        description_markdown: "# A run\n\nseed 1".into(),
        topology_edges: (0..islands).map(|i| (i, (i + 1) % islands)).collect(),
        has_stage: true,
        has_family: true,
        pace: Pace { slot_s: 0.5, generations_per_slot: 10 },
        ground: Ground::Plane,
    }
}

pub fn clip(lane: u32, generation: u32, trajectory: Trajectory) -> Clip {
    let label = format!("gen {generation} · 1.50 m");
    let creature = body(&trajectory.shapes);
    let short_label = label.clone();
    let others = Vec::new();
    Clip { lane, hue: lane, generation, label, short_label, creature, others, trajectory }
}

/// A trunk with links that hang from it on driven hinges.
pub fn body(shapes: &[Shape]) -> Creature {
    let joint = Joint {
        parent: 0,
        parent_from_joint: Isometry3::identity(),
        joint_from_link: Translation3::new(0.0, 0.0, -0.18).into(),
        kind: JointKind::Revolute(Vector3::y()),
    };
    let link = |(index, &shape): (usize, &Shape)| Link {
        shape,
        mass_kg: 1.0,
        inertia: None,
        joint: (index > 0).then(|| joint.clone()),
    };
    let wave = Wave {
        waveform: Waveform::Pulse,
        amplitude_rad_s: 1.0,
        phase_start_rad: 0.0,
        phase_step_rad: TAU / 20.0,
    };
    let motor = Motor { torque_nm_max: 1.0 };
    let links: Vec<Link> = shapes.iter().enumerate().map(link).collect();
    let driven = links.iter().map(|link| link.joint.as_ref().map(|_| (motor, wave)));
    let controller = Controller::of_waves(0.05, driven);
    let morphology = Morphology { links, root_rotation: UnitQuaternion::identity() };
    Creature { morphology, controller }
}

pub fn report(island: u32, generation: u32) -> Report {
    let g = f64::from(generation);
    let best = Fitness::new((0.5 + 0.1 * f64::from(island)) * (g / 3.0).floor());
    let mean = Fitness::new(0.6 * best.get());
    let statistics = Statistics {
        best,
        mean,
        median: mean,
        diversity: 1.0 / (1.0 + g * (1.0 + 0.2 * f64::from(island)) / 10.0),
        phenotype_diversity: 0.5,
        spread: Spread::of(&(0..50).map(|i| f64::from(i * i) / 1000.0).collect::<Vec<_>>()),
    };
    Report { island, generation, statistics, effort: Effort::default(), immigrants: 0, species: 0 }
}

/// A box that walks along x on pairs of legs of two cylinders each, at 60 frames a second.
pub fn walker(frames: usize, pairs: usize, speed_mps: f64) -> Trajectory {
    let half = Vector3::new(0.2 * pairs as f64, 0.2, 0.13);
    let leg = Shape::Cylinder { radius_m: 0.06, length_m: 0.36 };
    let mut shapes = vec![Shape::Cuboid { half_extents_m: half }];
    shapes.extend(std::iter::repeat_n(leg, pairs * 2));
    let times_s: Vec<f64> = (0..frames).map(|frame| frame as f64 / 60.0).collect();
    let poses = times_s.iter().map(|&time| stride(time, pairs, half, speed_mps)).collect();
    let bodies = vec![shapes.len()];
    Trajectory { shapes, bodies, times_s, poses, scoring_from_s: 0.0, ground: Ground::Plane }
}

pub fn stride(time_s: f64, pairs: usize, half: Vector3<f64>, speed_mps: f64) -> Vec<Pose> {
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

pub fn pose(position: Vector3<f64>, rotation: UnitQuaternion<f64>) -> Pose {
    let position_m = [position.x as f32, position.y as f32, position.z as f32];
    let [i, j, k, w] = [rotation.i, rotation.j, rotation.k, rotation.w].map(|v| v as f32);
    Pose { position_m, rotation_xyzw: [i, j, k, w] }
}

/// What a recording of two islands holds in the end.
pub fn record(write: impl FnOnce(&mut Recorder) -> Result<(), ViewError>) -> Vec<Chunk> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.rrd");
    let mut recorder = recorder(&path, None, card(2)).unwrap();
    write(&mut recorder).unwrap();
    recorder.finish().unwrap();
    chunks(&path)
}

pub fn recorder(path: &Path, live: Option<Live>, card: RunCard) -> Result<Recorder, ViewError> {
    let folder = path.parent().unwrap();
    Recorder::create(Draft::within(folder, path)?, live, card)
}

pub fn chunks(path: &Path) -> Vec<Chunk> {
    messages(path).iter().flat_map(|message| chunk_of(message, StoreKind::Recording)).collect()
}

pub fn messages(path: &Path) -> Vec<LogMsg> {
    let file = BufReader::new(File::open(path).unwrap());
    DecoderApp::decode_eager(file).unwrap().map(Result::unwrap).collect()
}

pub fn chunk_of(message: &LogMsg, kind: StoreKind) -> Option<Chunk> {
    match message {
        LogMsg::ArrowMsg(store, arrow) if store.kind() == kind => {
            Some(Chunk::from_arrow_msg(arrow).unwrap())
        }
        _ => None,
    }
}

pub fn only<'a>(chunks: &'a [Chunk], path: &str, wanted: impl Fn(&Chunk) -> bool) -> &'a Chunk {
    let found: Vec<_> = chunks
        .iter()
        .filter(|chunk| chunk.entity_path().to_string() == path && wanted(chunk))
        .collect();
    assert_eq!(found.len(), 1, "{path}");
    found[0]
}

/// The film time in nanoseconds and the number of instances of each row of a component.
pub fn instances(chunks: &[Chunk], path: &str, component: &'static str) -> Vec<(i64, usize)> {
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

/// Every row of a component of single points, in the order of the film.
pub fn points(chunks: &[Chunk], path: &str, component: &'static str) -> Vec<[f32; 3]> {
    let mut rows = Vec::new();
    for chunk in chunks.iter().filter(|chunk| chunk.entity_path().to_string() == path) {
        if chunk.is_static() || chunk.components().get(component.into()).is_none() {
            continue;
        }
        let times = chunk.timelines().values().find(|t| t.name() == PLAYBACK).unwrap().times_raw();
        let values = chunk.iter_slices::<[f32; 3]>(component.into()).map(<[_]>::to_vec);
        rows.extend(times.iter().copied().zip(values).filter_map(|(t, v)| Some((t, *v.first()?))));
    }
    rows.sort_by_key(|&(time, _)| time);
    rows.into_iter().map(|(_, point)| point).collect()
}

pub fn quaternions(chunk: &Chunk) -> Vec<[f32; 4]> {
    let component = chunk
        .components_identifiers()
        .find(|component| component.as_str().ends_with(":quaternions"))
        .unwrap();
    chunk.iter_slices::<[f32; 4]>(component).flatten().copied().collect()
}

pub fn texts(chunk: &Chunk, component: &'static str) -> Vec<String> {
    chunk.iter_slices::<String>(component.into()).flatten().map(|text| text.to_string()).collect()
}
