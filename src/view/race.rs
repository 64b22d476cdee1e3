//! The view of all lanes: where it is seen from, and how far it reaches.

use super::ViewError;
use super::card::RunCard;
use super::scenery::LANE_AHEAD_M;
use super::track::Track;
use crate::simulation::{Ground, Terrain};
use libm::{cosf, log2f, sinf};
use nalgebra::{Matrix3, Vector3};
use rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;
use rerun::{RecordingStream, Transform3D};
use std::collections::BTreeMap;

/// Half the height of what an eye sees, a metre before it, in metres; Rerun's angle of view is 55°.
const HALF_VIEW: f32 = 0.52;
/// A view is at least as wide as it is high: this much of its height is for the lanes, the rest for the tabs above.
const FILLED: f32 = 0.96;
/// The least that is seen of a lane, in metres from the start line.
const AHEAD_MIN_M: f32 = 5.0;
/// What is seen behind the start line, in metres.
const BEHIND_M: f32 = 0.6;
/// How high what is seen is, in metres: bodies and their labels.
const HEIGHT_M: f32 = 1.2;
/// Where the view stands: in a frame that grows as champions get farther. A terrain has its size.
pub const FRAME: &str = "race/frame";

/// An eye that sees all champions.
pub fn eye(card: &RunCard) -> EyeControls3D {
    match &card.ground {
        Ground::Plane => race_eye(card.track()),
        Ground::Terrain(terrain) => visitor(terrain),
    }
}

/// An eye that sees all lanes of a track from its right, a little ahead; the more lanes, the more from above.
fn race_eye(track: Track) -> EyeControls3D {
    let many = (log2f(track.lanes.max(1) as f32) / 4.0).min(1.0);
    let [ahead, above] = [22.0_f32.to_radians(), (26.0 + 30.0 * many).to_radians()];
    let level = cosf(above);
    let look = Vector3::new(-sinf(ahead) * level, cosf(ahead) * level, -sinf(above));
    let [position, target] = fit(look, &corners(track));
    EyeControls3D::new()
        .with_position(<[f32; 3]>::from(position))
        .with_look_target(<[f32; 3]>::from(target))
        .with_eye_up([0.0, 0.0, 1.0])
}

/// An eye outside of a terrain, on the side where creatures begin, that sees them and the middle.
fn visitor(terrain: &Terrain) -> EyeControls3D {
    let [position, target] = visit(terrain);
    EyeControls3D::new()
        .with_position(position)
        .with_look_target(target)
        .with_eye_up([0.0, 0.0, 1.0])
}

/// Where that eye is, and what it looks at.
fn visit(terrain: &Terrain) -> [[f32; 3]; 2] {
    let half_m = terrain.half_m().cast::<f32>();
    let far_m = half_m.max();
    let above_m = terrain.wall_top_m() as f32 + 0.45 * far_m;
    let middle_m = terrain.height_m(0.0, 0.0) as f32;
    let side = if terrain.start_m()[1] > 0.0 { 1.0 } else { -1.0 };
    let position = [0.75 * half_m.x, side * (half_m.y + 0.5 * far_m), above_m];
    [position, [0.0, side * 0.35 * half_m.y, 0.25 * middle_m]]
}

/// How far ahead the frame reaches before it has grown: of many lanes the view has room for more.
fn ahead_m(track: Track) -> f32 {
    AHEAD_MIN_M.max(track.width_m() / 5.0)
}

/// The corners of what is to be seen, in the frame.
fn corners(track: Track) -> Vec<Vector3<f32>> {
    let (left, ahead) = (track.width_m() / 2.0, ahead_m(track) + 0.4);
    let mut corners = Vec::new();
    for x in [-BEHIND_M, ahead] {
        // The numbers on the ground stand on the right.
        corners.push(Vector3::new(x, -left - track.digit_m() * 1.4, 0.0));
        for (y, z) in [(-left, HEIGHT_M), (left, 0.0), (left, HEIGHT_M)] {
            corners.push(Vector3::new(x, y, z));
        }
    }
    corners
}

/// The nearest place from where all points are in view, and a point in the middle of it.
fn fit(look: Vector3<f32>, points: &[Vector3<f32>]) -> [Vector3<f32>; 2] {
    let right = look.cross(&Vector3::z()).normalize();
    let up = right.cross(&look);
    let half = HALF_VIEW * FILLED;
    // Each border of the view is a plane through the eye, behind which no point may be.
    let side = |axis: Vector3<f32>| {
        let border = |sign: f32| {
            let past = points.iter().map(|point| sign * axis.dot(point) - half * look.dot(point));
            past.fold(f32::NEG_INFINITY, f32::max)
        };
        let (plus, minus) = (border(1.0), border(-1.0));
        ((plus - minus) / 2.0, -(plus + minus) / (2.0 * half))
    };
    let ((along, back), (above, farther_back)) = (side(right), side(up));
    let back = back.min(farther_back);
    let position = Matrix3::from_columns(&[right, up, look]) * Vector3::new(along, above, back);
    let middle = points.iter().map(|point| look.dot(point)).sum::<f32>() / points.len() as f32;
    [position, position + look * (middle - back)]
}

/// How far champions get, slot by slot.
#[derive(Debug)]
pub struct Field {
    track: Track,
    /// The lanes that are known of a slot, and the farthest that one of them gets, in metres.
    slots: BTreeMap<u32, (u32, f32)>,
    /// The farthest so far.
    farthest_m: f32,
}

impl Field {
    /// Nobody on a track.
    pub fn new(track: Track) -> Self {
        Self { track, slots: BTreeMap::new(), farthest_m: 0.0 }
    }

    /// In a slot one more lane is known; when all are, the slot's frame is told.
    pub fn learn(&mut self, slot: u32, reach_m: f32) -> Option<Transform3D> {
        let (lanes, farthest_m) = self.slots.entry(slot).or_default();
        (*lanes, *farthest_m) = (*lanes + 1, farthest_m.max(reach_m));
        if *lanes < self.track.lanes {
            return None;
        }
        let (_, reach_m) = self.slots.remove(&slot)?;
        Some(self.reach(reach_m))
    }

    /// The frame when somebody has got so far.
    pub fn reach(&mut self, reach_m: f32) -> Transform3D {
        self.farthest_m = self.farthest_m.max(reach_m.min(LANE_AHEAD_M as f32));
        let scale = match self.track.is_shared() {
            true => 1.0,
            false => (self.farthest_m / ahead_m(self.track)).max(1.0),
        };
        Transform3D::from_translation([0.0, self.track.middle_y(), 0.0]).with_scale(scale)
    }
}

/// Writes a frame; its time is that of the stream.
pub(super) fn show(rec: &RecordingStream, frame: &Transform3D) -> Result<(), ViewError> {
    Ok(rec.log(FRAME, frame)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_is_in_view_whatever_their_number() {
        for lanes in [1, 2, 4, 7, 9, 16, 64] {
            let points = corners(Track::of(lanes));
            let look = Vector3::new(-0.3, 0.8, -0.5).normalize();
            let [eye, target] = fit(look, &points);
            assert!((target - eye).normalize().dot(&look) > 0.999);
            let right = look.cross(&Vector3::z()).normalize();
            let up = right.cross(&look);
            let mut widest = 0.0_f32;
            for point in points {
                let from_eye = point - eye;
                let ahead = look.dot(&from_eye);
                assert!(ahead > 0.0, "{lanes}: {point} is behind the eye");
                let sides = [right, up].map(|axis| (axis.dot(&from_eye) / ahead).abs());
                widest = sides.into_iter().fold(widest, f32::max);
            }
            assert!((widest - HALF_VIEW * FILLED).abs() < 1e-3, "{lanes}: {widest}");
        }
    }

    #[test]
    fn an_eye_on_a_terrain_stands_beyond_the_wall_that_creatures_begin_near() {
        for (start_m, side) in [([0.0, -7.0], -1.0), ([0.0, 8.0], 1.0), ([3.0, 0.0], -1.0)] {
            let terrain = Terrain::new([21, 21], 1.0, vec![0.0; 21 * 21], start_m).unwrap();
            let [eye, target] = visit(&terrain);
            assert!(side * eye[1] > 10.0 && (0.0..10.0).contains(&(side * target[1])), "{eye:?}");
        }
    }

    #[test]
    fn the_frame_grows_when_all_lanes_of_a_slot_are_known_and_never_shrinks() {
        let scale = |frame: Transform3D| format!("{:?}", frame.scale);
        let mut field = Field::new(Track::of(2));
        assert!(field.learn(0, 2.0).is_none());
        assert!(field.learn(1, 8.0).is_none(), "one lane is ahead");
        let first = scale(field.learn(0, 3.0).unwrap());
        let second = scale(field.learn(1, 1.0).unwrap());
        assert_ne!(first, second);
        assert_eq!(scale(field.reach(0.0)), second);
        assert_ne!(scale(field.reach(1e9)), second);
        assert_eq!(scale(field.reach(2e9)), scale(field.reach(1e9)));
        let mut arena = Field::new(Track::shared(2));
        assert_eq!(scale(arena.reach(0.0)), scale(arena.reach(1e9)), "a terrain does not grow");
    }
}
