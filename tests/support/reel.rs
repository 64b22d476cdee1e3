//! Recordings, read back.

use islands::creature::Shape;
use islands::problems::Task;
use islands::simulation::{Pose, Trajectory};
use re_log_encoding::DecoderApp;
use rerun::StoreKind;
use rerun::external::arrow::util::display::array_value_to_string;
use rerun::log::{Chunk, LogMsg};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The entity that shows a champion's links of this shape.
pub fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::Cuboid { .. } => "boxes",
        Shape::Cylinder { .. } => "cylinders",
        Shape::Sphere { .. } | Shape::Capsule { .. } => "capsules",
    }
}

/// The positions and rotations of the links of one kind in a frame.
pub type Frame = (Vec<[f32; 3]>, Vec<[f32; 4]>);

/// An entity, its film time, its generation, and a component.
type Key = (String, Option<i64>, Option<i64>, String);

pub struct Recording(Vec<Chunk>);

impl Recording {
    pub fn read(path: &Path) -> Self {
        let file = BufReader::new(File::open(path).unwrap());
        let messages = DecoderApp::decode_eager(file).unwrap().map(Result::unwrap);
        let chunk = |message| match message {
            LogMsg::ArrowMsg(store, arrow) if store.kind() == StoreKind::Recording => {
                Some(Chunk::from_arrow_msg(&arrow).unwrap())
            }
            _ => None,
        };
        Self(messages.filter_map(chunk).collect())
    }

    /// Asserts that the last that is seen of an island's champion is this film of a trial, but for the
    /// trial's very last moment: there the next clip would begin.
    pub fn assert_ends_with(&self, island: u32, film: &Trajectory, task: Task) {
        let trial = task.trial();
        let end_s = trial.time_s(trial.steps());
        let shown = film.times_s.iter().filter(|&&time_s| time_s < end_s).count();
        for name in ["boxes", "cylinders"] {
            let links: Vec<usize> =
                (0..film.shapes.len()).filter(|&i| kind(&film.shapes[i]) == name).collect();
            if links.is_empty() {
                continue;
            }
            let expected = film.poses[..shown].iter().map(|poses| frame(poses, &links));
            let frames = self.frames(&format!("/islands/{island}/champion/{name}"));
            assert!(frames.len() >= shown, "{} frames of {name}", frames.len());
            let last = &frames[frames.len() - shown..];
            assert!(expected.eq(last.iter().cloned()), "island {island}, {name}");
        }
    }

    /// Every frame of an entity, in the order of the film.
    pub fn frames(&self, path: &str) -> Vec<Frame> {
        let mut frames = Vec::new();
        for chunk in self.chunks(path) {
            let Some(centres) = component(chunk, ":centers") else { continue };
            let rotations = component(chunk, ":quaternions").unwrap();
            let centres = chunk.iter_slices::<[f32; 3]>(centres).map(<[_]>::to_vec);
            let rotations = chunk.iter_slices::<[f32; 4]>(rotations).map(<[_]>::to_vec);
            let rows = centres.zip(rotations);
            frames.extend(times(chunk, "playback").iter().copied().zip(rows));
        }
        frames.sort_by_key(|&(time, _)| time);
        frames.into_iter().map(|(_, frame)| frame).collect()
    }

    /// The generations and values of a curve.
    pub fn scalars(&self, path: &str) -> Vec<(i64, f64)> {
        let mut points = Vec::new();
        for chunk in self.chunks(path) {
            let Some(scalars) = component(chunk, ":scalars") else { continue };
            let values = chunk.iter_slices::<f64>(scalars).map(|row| row[0]);
            points.extend(times(chunk, "generation").iter().copied().zip(values));
        }
        points.sort_by_key(|&(generation, _)| generation);
        points
    }

    /// The generations that every curve of each of so many islands has a point for, in order: the same ones.
    pub fn generations(&self, islands: u32) -> Vec<i64> {
        let curves = ["fitness/best", "fitness/mean", "diversity"];
        let paths =
            (0..islands).flat_map(|island| curves.map(|curve| format!("/{curve}/{island}")));
        let all: BTreeSet<Vec<i64>> = paths
            .map(|path| self.scalars(&path).into_iter().map(|(generation, _)| generation).collect())
            .collect();
        assert_eq!(all.len(), 1, "{all:?}");
        all.into_iter().next().unwrap()
    }

    /// Every component of every row, by its entity, its times and its name: all that there is but for the order
    /// of writing and the identities that Rerun gives to rows.
    pub fn rows(&self) -> BTreeMap<Key, Vec<String>> {
        let mut rows: BTreeMap<_, Vec<String>> = BTreeMap::new();
        for chunk in &self.0 {
            let path = chunk.entity_path().to_string();
            // When it was made.
            if path == "/__properties" {
                continue;
            }
            for row in 0..chunk.num_rows() {
                let time = |name| {
                    let found = chunk.timelines().values().find(|found| found.name() == name);
                    found.map(|column| column.times_raw()[row])
                };
                for column in chunk.components().values() {
                    if column.list_array.value(row).is_empty() {
                        continue;
                    }
                    let name = column.descriptor.to_string();
                    let key = (path.clone(), time("playback"), time("generation"), name);
                    // The debug output of a union holds the rows beside it, and chunks are cut by chance.
                    let value = array_value_to_string(&column.list_array, row).unwrap();
                    rows.entry(key).or_default().push(value);
                }
            }
        }
        rows.values_mut().for_each(|values| values.sort());
        rows
    }

    /// The pieces that it is written in: entity, components and rows of each, in some order.
    pub fn pieces(&self) -> Vec<(String, Vec<String>, usize)> {
        let piece = |chunk: &Chunk| {
            let names = chunk.components_identifiers().map(|name| name.to_string());
            let names = BTreeSet::from_iter(names).into_iter().collect();
            (chunk.entity_path().to_string(), names, chunk.num_rows())
        };
        let mut pieces: Vec<_> = self.0.iter().map(piece).collect();
        pieces.sort();
        pieces
    }

    /// What happened on so many islands.
    pub fn events(&self, islands: u32) -> Vec<String> {
        (0..islands).flat_map(|island| self.texts(&format!("/events/{island}"))).collect()
    }

    fn texts(&self, path: &str) -> Vec<String> {
        let texts = self.chunks(path).filter_map(|chunk| Some((chunk, component(chunk, ":text")?)));
        texts
            .flat_map(|(chunk, text)| chunk.iter_slices::<String>(text).flatten())
            .map(|text| text.to_string())
            .collect()
    }

    pub fn chunks<'a>(&'a self, path: &'a str) -> impl Iterator<Item = &'a Chunk> {
        let here =
            move |chunk: &&Chunk| chunk.entity_path().to_string() == path && !chunk.is_static();
        self.0.iter().filter(here)
    }
}

pub fn frame(poses: &[Pose], links: &[usize]) -> Frame {
    links.iter().map(|&link| (poses[link].position_m, poses[link].rotation_xyzw)).unzip()
}

pub fn component(chunk: &Chunk, ending: &str) -> Option<rerun::ComponentIdentifier> {
    chunk.components_identifiers().find(|component| component.as_str().ends_with(ending))
}

pub fn times<'a>(chunk: &'a Chunk, timeline: &str) -> &'a [i64] {
    chunk.timelines().values().find(|found| found.name() == timeline).unwrap().times_raw()
}
