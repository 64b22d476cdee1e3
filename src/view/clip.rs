//! A champion's trajectory as columns of poses.
//!
//! All links of one kind of solid are one entity: their sizes are one row at the start, their poses one
//! batch for the whole clip. That is a hundred times faster than a row a link and frame.

use super::extent::{along_z, calm, every, half_height, mean, middle, reach};
use super::film::Screening;
use super::{GENERATION, PLAYBACK, ViewError, palette};
use crate::creature::morphology::Shape;
use crate::simulation::trajectory::{Pose, Trajectory};
use rerun::{
    Boxes3D, Capsules3D, Color, Cylinders3D, FillMode, LineStrips3D, Points3D, Quaternion, Radius,
    RecordingStream, SerializedComponentColumn, TimeColumn, Transform3D,
};
use std::iter::{RepeatN, repeat_n};

/// What is shown of a champion.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// Its island.
    pub island: u32,
    /// The generation in which it appeared.
    pub generation: u32,
    /// What stands above it.
    pub label: String,
    /// How it moves.
    pub trajectory: Trajectory,
}

/// Frames per second of film; Rerun does not interpolate, and more than this no screen shows.
const FRAME_RATE: f64 = 60.0;
/// Points per second of the trail.
const TRAIL_RATE: f64 = 10.0;
/// The side of two floor tiles: a floor moved by this looks as before.
const FLOOR_STEP_M: f32 = 2.0;
/// The highest that a label hangs in an island's own view, in reaches of the body: above it is out of sight.
const MARKER_MAX: f32 = 0.75;

/// Writes a clip into its place in the film.
pub fn show(rec: &RecordingStream, screening: Screening<'_>, slot_s: f64) -> Result<(), ViewError> {
    if screening.clip.trajectory.poses.is_empty() {
        return Ok(());
    }
    let take = Take::new(screening, slot_s);
    take.stamp(rec);
    take.bodies(rec)?;
    take.camera(rec)?;
    take.trail(rec)
}

/// The frames of a clip that are shown.
struct Take<'a> {
    screening: Screening<'a>,
    frames: Vec<usize>,
    /// The middle of the body on the ground in each shown frame, without its fast movements.
    follow: Vec<[f32; 2]>,
    /// How high the middle of the body is on average, in metres.
    height_m: f32,
    /// How far the body reaches from its middle, in metres.
    reach_m: f32,
}

impl<'a> Take<'a> {
    fn new(screening: Screening<'a>, slot_s: f64) -> Self {
        let trajectory = &screening.clip.trajectory;
        // The last moment belongs to the next slot.
        let frames = every(&trajectory.times_s, FRAME_RATE, slot_s - 0.5 / FRAME_RATE);
        let middles: Vec<_> = frames.iter().map(|&f| middle(&trajectory.poses[f])).collect();
        let times: Vec<_> = frames.iter().map(|&f| trajectory.times_s[f]).collect();
        let height_m = mean(frames.iter().flat_map(|&f| &trajectory.poses[f]), 2);
        let reach_m = frames
            .iter()
            .zip(&middles)
            .map(|(&f, &[x, y])| reach(&trajectory.shapes, &trajectory.poses[f], [x, y, height_m]))
            .fold(0.1, f32::max);
        Self { screening, frames, follow: calm(&times, &middles), height_m, reach_m }
    }

    fn trajectory(&self) -> &'a Trajectory {
        &self.screening.clip.trajectory
    }

    fn path(&self, name: &str) -> String {
        format!("islands/{}/{name}", self.screening.clip.island)
    }

    /// Sets the time of rows: the start of the clip.
    fn stamp(&self, rec: &RecordingStream) {
        rec.set_duration_secs(PLAYBACK, self.screening.start_s);
        rec.set_time_sequence(GENERATION, self.screening.generation);
    }

    /// The times of columns: those of some frames.
    fn times(&self, frames: &[usize]) -> [TimeColumn; 2] {
        let seconds = frames.iter().map(|&f| self.screening.start_s + self.trajectory().times_s[f]);
        let generations = frames.iter().map(|_| i64::from(self.screening.generation));
        [
            TimeColumn::new_duration_secs(PLAYBACK, seconds),
            TimeColumn::new_sequence(GENERATION, generations),
        ]
    }

    fn bodies(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let mut boxes = Kind::default();
        let mut cylinders = Kind::default();
        let mut capsules = Kind::default();
        for (link, shape) in self.trajectory().shapes.iter().enumerate() {
            let color = palette::link(self.screening.clip.island, link);
            match *shape {
                Shape::Cuboid { half_extents_m: h } => {
                    boxes.push(link, [h.x as f32, h.y as f32, h.z as f32], color);
                }
                Shape::Cylinder { radius_m, length_m } => {
                    cylinders.push(link, [length_m as f32, radius_m as f32], color);
                }
                Shape::Sphere { radius_m } => capsules.push(link, [0.0, radius_m as f32], color),
                Shape::Capsule { radius_m, length_m } => {
                    capsules.push(link, [length_m as f32, radius_m as f32], color);
                }
            }
        }
        self.boxes(rec, &boxes)?;
        self.cylinders(rec, &cylinders)?;
        self.capsules(rec, &capsules)
    }

    fn boxes(&self, rec: &RecordingStream, kind: &Kind<3>) -> Result<(), ViewError> {
        let path = self.path("champion/boxes");
        if kind.links.is_empty() {
            // Without this row the boxes of the champion before would stay.
            return Ok(rec.log(path, &Boxes3D::clear_fields())?);
        }
        let solids = Boxes3D::from_half_sizes(kind.sizes.iter().copied())
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        let poses = Boxes3D::update_fields()
            .with_centers(self.positions(kind))
            .with_quaternions(self.rotations(kind))
            .columns(self.lengths(kind))?;
        self.send(rec, path, poses)
    }

    fn cylinders(&self, rec: &RecordingStream, kind: &Kind<2>) -> Result<(), ViewError> {
        let path = self.path("champion/cylinders");
        if kind.links.is_empty() {
            return Ok(rec.log(path, &Cylinders3D::clear_fields())?);
        }
        let (lengths, radii): (Vec<_>, Vec<_>) = kind.sizes.iter().map(|&[l, r]| (l, r)).unzip();
        let solids = Cylinders3D::from_lengths_and_radii(lengths, radii)
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        let poses = Cylinders3D::update_fields()
            .with_centers(self.positions(kind))
            .with_quaternions(self.rotations(kind))
            .columns(self.lengths(kind))?;
        self.send(rec, path, poses)
    }

    /// Capsules, and spheres as capsules without a length. No gene makes them: the champion before had none that
    /// could stay.
    fn capsules(&self, rec: &RecordingStream, kind: &Kind<2>) -> Result<(), ViewError> {
        if kind.links.is_empty() {
            return Ok(());
        }
        let path = self.path("champion/capsules");
        let (lengths, radii): (Vec<_>, Vec<_>) = kind.sizes.iter().map(|&[l, r]| (l, r)).unzip();
        let solids = Capsules3D::from_lengths_and_radii(lengths, radii)
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        let poses = Capsules3D::update_fields()
            .with_translations(self.starts(kind))
            .with_quaternions(self.rotations(kind))
            .columns(self.lengths(kind))?;
        self.send(rec, path, poses)
    }

    fn send(
        &self,
        rec: &RecordingStream,
        path: String,
        columns: impl Iterator<Item = SerializedComponentColumn>,
    ) -> Result<(), ViewError> {
        Ok(rec.send_columns(path, self.times(&self.frames), columns)?)
    }

    /// The poses of the links of a kind, frame after frame.
    fn poses<const N: usize>(&self, kind: &Kind<N>) -> impl Iterator<Item = Pose> {
        let poses = &self.trajectory().poses;
        self.frames.iter().flat_map(move |&f| kind.links.iter().map(move |&link| poses[f][link]))
    }

    fn positions<const N: usize>(&self, kind: &Kind<N>) -> impl Iterator<Item = [f32; 3]> {
        self.poses(kind).map(|pose| pose.position_m)
    }

    /// Where capsules begin: rerun's stand on their first end, ours about their middle.
    fn starts(&self, kind: &Kind<2>) -> impl Iterator<Item = [f32; 3]> {
        let lengths = kind.sizes.iter().map(|&[length, _]| length).cycle();
        self.poses(kind).zip(lengths).map(|(pose, length)| along_z(&pose, -length / 2.0))
    }

    fn rotations<const N: usize>(&self, kind: &Kind<N>) -> impl Iterator<Item = Quaternion> {
        self.poses(kind).map(|pose| Quaternion::from_xyzw(pose.rotation_xyzw))
    }

    fn lengths<const N: usize>(&self, kind: &Kind<N>) -> RepeatN<usize> {
        repeat_n(kind.links.len(), self.frames.len())
    }

    /// What the camera looks at, the label that hangs there, and the floor below.
    fn camera(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let follow = self.path("follow");
        // In a frame as large as the body every champion fills its view.
        rec.log(follow.as_str(), &Transform3D::from_scale(self.reach_m))?;
        let here = self.follow.iter().map(|&[x, y]| [x, y, self.height_m]);
        let places = Transform3D::update_fields().with_many_translation(here);
        self.send(rec, follow.clone(), places.columns_of_unit_batches()?)?;

        let above = (self.top_m() - self.height_m) / self.reach_m;
        // Where champions are small on the screen, their labels need more room.
        self.label(rec, "marker", (above + 0.35).min(MARKER_MAX))?;
        self.label(rec, "flag", above + 1.4)?;

        let floor = self.follow.iter().map(|xy| {
            let [x, y] = xy.map(|v| (v / FLOOR_STEP_M).round() * FLOOR_STEP_M);
            [x, y, 0.0]
        });
        let places = Transform3D::update_fields().with_many_translation(floor);
        self.send(rec, self.path("ground"), places.columns_of_unit_batches()?)
    }

    fn label(&self, rec: &RecordingStream, name: &str, height: f32) -> Result<(), ViewError> {
        let Clip { island, label, .. } = self.screening.clip;
        let label = Points3D::new([[0.0, 0.0, height]])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_colors([palette::opaque(palette::island(*island))])
            .with_labels([label.as_str()])
            .with_show_labels(true);
        Ok(rec.log(self.path(&format!("follow/{name}")), &label)?)
    }

    /// The height of the highest point that any link ever reaches.
    fn top_m(&self) -> f32 {
        let trajectory = self.trajectory();
        let tops = self.frames.iter().flat_map(|&f| {
            let links = trajectory.poses[f].iter().zip(&trajectory.shapes);
            links.map(|(pose, shape)| pose.position_m[2] + half_height(shape, pose))
        });
        tops.fold(0.0, f32::max)
    }

    /// A line on the ground that grows as the champion goes; the first row has none.
    fn trail(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let path = self.path("trail");
        let style = LineStrips3D::update_fields()
            .with_radii([0.02 * self.reach_m])
            .with_colors([palette::opaque(palette::island(self.screening.clip.island))]);
        rec.log(path.as_str(), &style)?;

        let times: Vec<_> = self.frames.iter().map(|&f| self.trajectory().times_s[f]).collect();
        let picks = every(&times, TRAIL_RATE, f64::INFINITY);
        let points: Vec<_> =
            picks.iter().map(|&i| [self.follow[i][0], self.follow[i][1], 0.01]).collect();
        let strips = (2..=points.len()).map(|count| points[..count].to_vec());
        let counts = (0..points.len()).map(|row| usize::from(row > 0));
        let rows = LineStrips3D::update_fields().with_strips(strips).columns(counts)?;
        let frames: Vec<_> = picks.iter().map(|&i| self.frames[i]).collect();
        Ok(rec.send_columns(path, self.times(&frames), rows)?)
    }
}

/// The links of one kind of solid, each with `N` numbers for its size.
#[derive(Default)]
struct Kind<const N: usize> {
    links: Vec<usize>,
    sizes: Vec<[f32; N]>,
    colors: Vec<Color>,
}

impl<const N: usize> Kind<N> {
    fn push(&mut self, link: usize, size: [f32; N], color: Color) {
        self.links.push(link);
        self.sizes.push(size);
        self.colors.push(color);
    }
}
