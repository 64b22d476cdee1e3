//! A champion's trajectory as columns of rows: a hundred times faster than a row an entity and frame.

use super::clip::Clip;
use super::extent::{calm, every, half_height, mean, middle, reach};
use super::film::Screening;
use super::heading::{self, Heading};
use super::ruler::Ruler;
use super::{GENERATION, PLAYBACK, ViewError, palette};
use crate::simulation::Ground;
use crate::simulation::trajectory::Trajectory;
use rerun::{
    Color, LineStrips3D, Points3D, Radius, RecordingStream, SerializedComponentColumn, TimeColumn,
    Transform3D,
};

/// Frames per second of film; Rerun does not interpolate, and more than this no screen shows.
const FRAME_RATE: f64 = 60.0;
/// Points per second of the trail.
const TRAIL_RATE: f64 = 10.0;
/// The side of two floor tiles: a floor moved by this looks as before.
const FLOOR_STEP_M: f32 = 2.0;
/// The longest ruler, in metres.
const RULER_MAX_M: f32 = 100.0;
/// The highest that a label hangs in an island's own view, in reaches of the body: above it is out of sight.
const MARKER_MAX: f32 = 0.78;

/// How much higher a label hangs in the view of all lanes for each lane, in metres: from farther away and above it
/// would cover its body.
const FLAG_M: f32 = 0.06;

/// The frames of a clip that are shown. The camera, and all that is drawn but the links, is the champion's.
pub(super) struct Take<'a> {
    pub screening: Screening<'a>,
    pub frames: Vec<usize>,
    /// Which way it goes: everything but the links themselves is written as it is in the lane.
    pub heading: Heading,
    /// How far the body reaches from its middle, in metres.
    pub reach_m: f32,
    /// The middle of the body on the ground in each shown frame, without its fast movements.
    pub follow: Vec<[f32; 2]>,
    /// The centre of mass on the ground in each shown frame.
    pub centres: Vec<[f32; 2]>,
    /// How high the middle of the body is above the ground on average, in metres.
    height_m: f32,
}

impl<'a> Take<'a> {
    pub fn new(screening: Screening<'a>, slot_s: f64) -> Self {
        let Clip { creature, trajectory, .. } = screening.clip;
        let morphology = &creature.morphology;
        // The last moment belongs to the next slot.
        let frames = every(&trajectory.times_s, FRAME_RATE, slot_s - 0.5 / FRAME_RATE);
        let heading = Heading::of(morphology, trajectory);
        let shown = || frames.iter().map(|&f| trajectory.first_body(f));
        let middles: Vec<_> = shown().map(|poses| heading.turn(middle(poses))).collect();
        let centre = |poses: &[_]| heading.turn(heading::centre_of_mass(morphology, poses));
        let centres = shown().map(centre).collect();
        let times: Vec<_> = frames.iter().map(|&f| trajectory.times_s[f]).collect();
        let floor_m = |[x, y]: [f32; 2]| floor_m(trajectory, [x, y]);
        let floors_m = shown().map(|poses| floor_m(middle(poses))).sum::<f32>();
        let height_m = mean(shown().flatten(), 2) - floors_m / f32::max(frames.len() as f32, 1.0);
        let reach_m = shown()
            .map(|poses| {
                let [x, y] = middle(poses);
                reach(&trajectory.shapes, poses, [x, y, floor_m([x, y]) + height_m])
            })
            .fold(0.1, f32::max);
        let follow = calm(&times, &middles);
        Self { screening, frames, heading, reach_m, follow, centres, height_m }
    }

    /// The height of the ground at a place in the lane.
    pub fn floor_m(&self, place: [f32; 2]) -> f32 {
        // Only planes are turned, and they are level.
        floor_m(self.trajectory(), place)
    }

    /// The height of the body's middle at a place in the lane.
    pub fn middle_m(&self, place: [f32; 2]) -> f32 {
        self.floor_m(place) + self.height_m
    }

    pub fn clip(&self) -> &'a Clip {
        self.screening.clip
    }

    pub fn trajectory(&self) -> &'a Trajectory {
        &self.clip().trajectory
    }

    /// The times of the shown frames in the trial, in seconds.
    pub fn times_s(&self) -> Vec<f64> {
        self.frames.iter().map(|&f| self.trajectory().times_s[f]).collect()
    }

    pub fn path(&self, name: &str) -> String {
        format!("islands/{}/{name}", self.clip().lane)
    }

    pub fn color(&self) -> Color {
        palette::opaque(palette::island(self.clip().hue))
    }

    /// Sets the time of rows: the start of the clip.
    pub fn stamp(&self, rec: &RecordingStream) {
        rec.set_duration_secs(PLAYBACK, self.screening.start_s);
        rec.set_time_sequence(GENERATION, self.screening.generation);
    }

    /// Writes columns with a row for each of some frames.
    pub fn send(
        &self,
        rec: &RecordingStream,
        path: String,
        frames: &[usize],
        columns: impl Iterator<Item = SerializedComponentColumn>,
    ) -> Result<(), ViewError> {
        let seconds = frames.iter().map(|&f| self.screening.start_s + self.trajectory().times_s[f]);
        let generations = frames.iter().map(|_| i64::from(self.screening.generation));
        let times = [
            TimeColumn::new_duration_secs(PLAYBACK, seconds),
            TimeColumn::new_sequence(GENERATION, generations),
        ];
        Ok(rec.send_columns(path, times, columns)?)
    }

    /// What the camera looks at, the label that hangs there, and the floor below.
    pub fn camera(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let follow = self.path("follow");
        // In a frame as large as the body every champion fills its view.
        rec.log(follow.as_str(), &Transform3D::from_scale(self.reach_m))?;
        let here = self.follow.iter().map(|&[x, y]| [x, y, self.middle_m([x, y])]);
        let places = Transform3D::update_fields().with_many_translation(here);
        self.send(rec, follow, &self.frames, places.columns_of_unit_batches()?)?;

        let Clip { label, short_label, .. } = self.clip();
        let above = (self.top_m() - self.height_m) / self.reach_m;
        // Where champions are small on the screen, their labels need more room.
        self.label(rec, "marker", label, (above + 0.35).min(MARKER_MAX))?;
        let flag = above + 0.35 + FLAG_M * self.screening.lanes as f32 / self.reach_m;
        self.label(rec, "flag", short_label, flag)?;

        match &self.trajectory().ground {
            Ground::Plane => self.floor(rec),
            Ground::Terrain(_) => Ok(()),
        }
    }

    /// The floor below: a row whenever it moves.
    fn floor(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let places = self.follow.iter().map(|xy| xy.map(|v| (v / FLOOR_STEP_M).round()));
        let mut rows: Vec<(usize, [f32; 2])> = self.frames.iter().copied().zip(places).collect();
        rows.dedup_by_key(|(_, place)| *place);
        let (frames, places): (Vec<usize>, Vec<_>) = rows.into_iter().unzip();
        let places = places.into_iter().map(|[x, y]| [x * FLOOR_STEP_M, y * FLOOR_STEP_M, 0.0]);
        let rows = Transform3D::update_fields().with_many_translation(places);
        self.send(rec, self.path("ground"), &frames, rows.columns_of_unit_batches()?)
    }

    fn label(
        &self,
        rec: &RecordingStream,
        name: &str,
        text: &str,
        height: f32,
    ) -> Result<(), ViewError> {
        let label = Points3D::new([[0.0, 0.0, height]])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_colors([self.color()])
            .with_labels([text])
            .with_show_labels(true);
        Ok(rec.log(self.path(&format!("follow/{name}")), &label)?)
    }

    /// How far along its lane it gets, in metres.
    pub fn farthest_m(&self) -> f32 {
        self.follow.iter().map(|&[x, _]| x).fold(0.0, f32::max)
    }

    /// The height of the highest point that any of its links ever reaches, above the ground below the body's middle.
    fn top_m(&self) -> f32 {
        let trajectory = self.trajectory();
        let tops = self.frames.iter().flat_map(|&f| {
            let poses = trajectory.first_body(f);
            let floor_m = floor_m(trajectory, middle(poses));
            let links = poses.iter().zip(&trajectory.shapes);
            links.map(move |(pose, shape)| pose.position_m[2] + half_height(shape, pose) - floor_m)
        });
        tops.fold(0.0, f32::max)
    }

    /// A line and a number on the ground at each metre from the start, as large as suits the body; none on a terrain.
    pub fn ruler(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        if self.trajectory().ground.terrain().is_some() {
            return Ok(());
        }
        let farthest = self.farthest_m();
        let ruler = Ruler {
            // Whoever blows up is soon on another planet.
            metres: (farthest + 3.0).min(RULER_MAX_M).ceil() as u32,
            left_m: 0.9 * self.reach_m,
            right_m: -0.62 * self.reach_m,
            digit_m: 0.13 * self.reach_m,
            line_m: 0.006 * self.reach_m,
            every: 1,
        };
        let color = palette::paint(self.clip().hue);
        Ok(rec.log(self.path("ruler"), &ruler.paint(color))?)
    }

    /// The way of the centre of mass, which is what is scored, as a line on the ground that grows as the champion
    /// goes; the first row has none.
    pub fn trail(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let path = self.path("trail");
        let style = LineStrips3D::update_fields()
            .with_radii([0.016 * self.reach_m])
            .with_colors([self.color()]);
        rec.log(path.as_str(), &style)?;

        let (times_s, from_s) = (self.times_s(), self.trajectory().scoring_from_s);
        let mut picks = every(&times_s, TRAIL_RATE, f64::INFINITY);
        // The first row has no line, and is there from the beginning.
        picks.retain(|&pick| pick == 0 || times_s[pick] >= from_s);
        let over = |[x, y]: [f32; 2]| [x, y, self.floor_m([x, y]) + 0.012];
        let points: Vec<_> = picks.iter().map(|&i| over(self.centres[i])).collect();
        let strips = (3..=points.len()).map(|count| points[1..count].to_vec());
        let counts = (0..points.len()).map(|row| usize::from(row > 1));
        let rows = LineStrips3D::update_fields().with_strips(strips).columns(counts)?;
        let frames: Vec<_> = picks.iter().map(|&i| self.frames[i]).collect();
        self.send(rec, path, &frames, rows)
    }
}

/// The height of the ground of a film.
fn floor_m(trajectory: &Trajectory, [x, y]: [f32; 2]) -> f32 {
    trajectory.ground.height_m(f64::from(x), f64::from(y)) as f32
}
