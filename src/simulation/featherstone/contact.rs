//! Points of a body that touch the ground, or will before the step is over.
//!
//! A box touches with its corners, a cylinder with four points of each rim: the lowest one, the one across, and the
//! two between them.

use super::kinematics::Place;
use super::model::Surface;
use super::spatial::Spatial;
use nalgebra::{Matrix3, Vector3};

/// The most points that a solid touches with.
pub const POINTS_PER_SOLID: usize = 8;

/// A point is looked after when it is nearer to the ground than this, now or by the end of the step, in metres. It
/// must be more than what a step's impulses move a point by that nothing pushed before.
const MARGIN_M: f64 = 0.002;

/// A point near the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Which point of the body it is: the same one in the next step has the same name.
    pub name: usize,
    /// Its link.
    pub link: usize,
    /// Where it is, from the reference, in metres.
    pub point_m: Vector3<f64>,
    /// Its height over the ground when the step begins, negative below it, in metres.
    pub height_m: f64,
}

/// What there is to know of a body to find where it touches.
#[derive(Debug, Clone, Copy)]
pub struct Stance<'a> {
    /// The places of the links half a step ahead.
    pub places: &'a [Place],
    /// Their velocities.
    pub velocities: &'a [Spatial],
    /// The reference's height over the ground, half a step ahead, in metres.
    pub height_m: f64,
    /// The time of a step, in seconds.
    pub step_s: f64,
}

/// Finds every point of a body that touches.
pub fn find(surfaces: &[Surface], stance: Stance, touches: &mut Vec<Touch>) {
    touches.clear();
    for (index, surface) in surfaces.iter().enumerate() {
        let place = &stance.places[surface.link];
        let centre_m = place.origin_m + place.rotation * surface.centre_m;
        if stance.can_reach(surface, &centre_m) {
            let points = surface.points(&centre_m, &place.rotation);
            for (corner, point_m) in points.iter().enumerate() {
                if let Some(height_m) = stance.touches(surface.link, point_m) {
                    let name = index * POINTS_PER_SOLID + corner;
                    touches.push(Touch { name, link: surface.link, point_m: *point_m, height_m });
                }
            }
        }
    }
}

impl Stance<'_> {
    /// Whether any point of a solid may touch.
    fn can_reach(&self, surface: &Surface, centre_m: &Vector3<f64>) -> bool {
        let velocity = &self.velocities[surface.link];
        let turn_m_s = surface.reach_m * velocity.angular().norm();
        let speed_m_s = velocity.velocity_at(centre_m).z.abs() + turn_m_s;
        let lowest_m = self.height_m + centre_m.z - surface.reach_m;
        lowest_m - 0.5 * speed_m_s * self.step_s < MARGIN_M
    }

    /// The height of a point when the step begins, half a step before its place, if it touches by the step's end.
    fn touches(&self, link: usize, point_m: &Vector3<f64>) -> Option<f64> {
        let rise_m = self.velocities[link].velocity_at(point_m).z * self.step_s;
        let height_m = self.height_m + point_m.z - 0.5 * rise_m;
        (height_m + rise_m.min(0.0) < MARGIN_M).then_some(height_m)
    }
}

impl Surface {
    /// The points that it can touch with, from the reference.
    fn points(
        &self,
        centre_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> [Vector3<f64>; POINTS_PER_SOLID] {
        let up = rotation * self.axes.column(2);
        let end_m = up * self.half_m.z;
        let spokes_m = if self.is_round {
            let down_m = self.downwards(&up, rotation) * self.half_m.x;
            let across_m = up.cross(&down_m);
            [down_m, across_m, -down_m, -across_m]
        } else {
            let x_m = rotation * self.axes.column(0) * self.half_m.x;
            let y_m = rotation * self.axes.column(1) * self.half_m.y;
            [x_m + y_m, y_m - x_m, -x_m - y_m, x_m - y_m]
        };
        std::array::from_fn(|corner| {
            let spoke_m = spokes_m[corner % 4];
            centre_m + if corner < 4 { spoke_m + end_m } else { spoke_m - end_m }
        })
    }

    /// The unit vector across the axis of a cylinder that points down most; one of the solid's own if the cylinder
    /// stands upright and none does.
    fn downwards(&self, up: &Vector3<f64>, rotation: &Matrix3<f64>) -> Vector3<f64> {
        const UPRIGHT: f64 = 1e-6;
        let down = up * up.z - Vector3::z();
        let length = down.norm();
        if length > UPRIGHT { down / length } else { rotation * self.axes.column(0) }
    }
}
