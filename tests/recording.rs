//! What a viewer gets to see is what was scored.

use crate::support::{TINY, World, signal, until};
use islands::creature::{Gene, Profile, Shape};
use islands::formats::{genome_csv, metrics};
use islands::problems::{Locomotion, Task};
use islands::simulation::{Pose, Trajectory};
use islands::store::{RunDir, checkpoint};
use re_log_encoding::DecoderApp;
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

const WALK: Locomotion =
    Locomotion { profile: Profile::Native, task: Task::Walk, genes: 2, links_max: 32 };

#[test]
fn a_recording_shows_each_islands_champion_as_it_was_simulated() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let recording = Recording::read(&world.path("run/recording.rrd"));
    for index in 0..2 {
        let dir = RunDir::at(world.path("run"));
        let island = checkpoint::load::<Gene>(&dir.checkpoint(index, 3)).unwrap().island;
        let (evaluation, film) = WALK.film(&island.champion.genome).unwrap();
        assert_eq!(evaluation.fitness, island.champion.fitness);
        recording.assert_ends_with(index, &film, Task::Walk);
    }
}

#[test]
fn a_recording_holds_the_curves_of_every_island() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 43 --out run --quiet --json {TINY}"));
    let recording = Recording::read(&world.path("run/recording.rrd"));
    let rows = metrics::read(world.read("run/metrics.csv").as_bytes()).unwrap();
    for island in 0..2 {
        let rows = rows.iter().filter(|row| row.island == island);
        let expected: Vec<_> =
            rows.map(|row| (i64::from(row.generation), row.best.unwrap())).collect();
        assert_eq!(recording.scalars(&format!("/fitness/best/{island}")), expected);
        for curve in ["fitness/mean", "diversity"] {
            assert_eq!(recording.scalars(&format!("/{curve}/{island}")).len(), 4, "{curve}");
        }
    }
}

#[test]
fn a_monitor_that_comes_late_still_films_the_whole_of_a_short_run() {
    let world = World::new();
    let settings = "--population 6 --generations 6 --genes 2";
    let run = world.start(&format!("--n 2 --seed 43 --out run --quiet --json {settings}"));
    let monitor = run.child("monitor");
    signal(monitor, "STOP");
    let dir = RunDir::at(world.path("run"));
    until("the islands have finished", || (0..2).all(|i| dir.checkpoint(i, 6).exists()));
    signal(monitor, "CONT");
    let ending = run.wait();
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    let recording = Recording::read(&dir.recording());
    for island in 0..2 {
        assert_eq!(recording.scalars(&format!("/fitness/mean/{island}")).len(), 7);
    }
}

#[test]
fn a_recording_tells_what_happened() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let events = Recording::read(&world.path("run/recording.rrd")).texts("/events");
    let count = |word: &str| events.iter().filter(|event| event.contains(word)).count();
    assert!(count("new champion") >= 2, "{events:?}");
    assert_eq!(count("2 immigrants arrive"), 2, "{events:?}");
    assert_eq!(count("WARNING"), 0, "{events:?}");
}

#[test]
fn a_replay_shows_the_simulation_that_got_the_score() {
    let world = World::new();
    let run = world.json(&format!("--n 1 --seed 47 --out run --no-monitor --json {TINY}"));
    let ending = world.islands("replay run/champion.csv --out champion.rrd");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let score = format!("{:.3} m", run["best_fitness"].as_f64().unwrap());
    assert!(ending.stdout.contains(&score), "{ending:?}");
    assert!(ending.stdout.ends_with("view it:  rerun champion.rrd\n"), "{ending:?}");

    let genome = genome_csv::read(world.read("run/champion.csv").as_bytes()).unwrap().genome;
    let (evaluation, film) = WALK.film(&genome).unwrap();
    assert_eq!(run["best_fitness"], evaluation.fitness.get());
    Recording::read(&world.path("champion.rrd")).assert_ends_with(0, &film, Task::Walk);
}

#[test]
fn several_creatures_race_in_one_replay() {
    let world = World::new();
    let course = |i| format!("genome_{i}.csv");
    for i in [1, 2] {
        world.write(&course(i), crate::course::fixture(&course(i)));
    }
    let problem = Locomotion { profile: Profile::Coursework, task: Task::Course, ..WALK };
    let files = [1, 2].map(course).join(" ");
    let ending =
        world.islands(&format!("replay {files} --profile coursework --task course --out race.rrd"));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let recording = Recording::read(&world.path("race.rrd"));
    for (lane, i) in [(0, 1), (1, 2)] {
        let genome = genome_csv::read(world.read(&course(i)).as_bytes()).unwrap().genome;
        let (_, film) = problem.film(&genome).unwrap();
        recording.assert_ends_with(lane, &film, Task::Course);
    }
}

/// The entity that shows a champion's links of this shape.
fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::Cuboid { .. } => "boxes",
        Shape::Cylinder { .. } => "cylinders",
    }
}

/// The positions and rotations of the links of one kind in a frame.
type Frame = (Vec<[f32; 3]>, Vec<[f32; 4]>);

struct Recording(Vec<Chunk>);

impl Recording {
    fn read(path: &Path) -> Self {
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
    fn assert_ends_with(&self, island: u32, film: &Trajectory, task: Task) {
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
    fn frames(&self, path: &str) -> Vec<Frame> {
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
    fn scalars(&self, path: &str) -> Vec<(i64, f64)> {
        let mut points = Vec::new();
        for chunk in self.chunks(path) {
            let Some(scalars) = component(chunk, ":scalars") else { continue };
            let values = chunk.iter_slices::<f64>(scalars).map(|row| row[0]);
            points.extend(times(chunk, "generation").iter().copied().zip(values));
        }
        points.sort_by_key(|&(generation, _)| generation);
        points
    }

    fn texts(&self, path: &str) -> Vec<String> {
        let texts = self.chunks(path).filter_map(|chunk| Some((chunk, component(chunk, ":text")?)));
        texts
            .flat_map(|(chunk, text)| chunk.iter_slices::<String>(text).flatten())
            .map(|text| text.to_string())
            .collect()
    }

    fn chunks<'a>(&'a self, path: &'a str) -> impl Iterator<Item = &'a Chunk> {
        let here =
            move |chunk: &&Chunk| chunk.entity_path().to_string() == path && !chunk.is_static();
        self.0.iter().filter(here)
    }
}

fn frame(poses: &[Pose], links: &[usize]) -> Frame {
    links.iter().map(|&link| (poses[link].position_m, poses[link].rotation_xyzw)).unzip()
}

fn component(chunk: &Chunk, ending: &str) -> Option<rerun::ComponentIdentifier> {
    chunk.components_identifiers().find(|component| component.as_str().ends_with(ending))
}

fn times<'a>(chunk: &'a Chunk, timeline: &str) -> &'a [i64] {
    chunk.timelines().values().find(|found| found.name() == timeline).unwrap().times_raw()
}
