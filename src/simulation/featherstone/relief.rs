//! Points of a body that touch a terrain or its walls.
//!
//! Points touch the triangle that is below them; a round solid has a lowest point for the slope below it, and more for
//! those beside it that face another way, which it meets before its centre is over them. Between those at their ends,
//! solids touch with points a third of their length apart, since a rock may be where a plane is not. Walls are boxes:
//! from within they are touched with their sides, from above with their tops.

use super::super::terrain::Terrain;
use super::contact::{Facing, Footing, MARGIN_M, Stance, Touch};
use super::model::{Outline, Surface};
use super::spatial::{Mat3, Spatial};
use crate::simulation::lanes::width::Alone;
use crate::simulation::lanes::{Everywhere, Real, Vec3};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// Four points at each of four places along the axis of a solid.
const POINTS: usize = 16;
/// The places, in half lengths.
const RINGS: [f64; 4] = [1.0, 1.0 / 3.0, -1.0 / 3.0, -1.0];
/// A point may touch the ground, a wall to the east or the west, one to the north or the south, and of a round solid a
/// slope beside it.
const GROUNDS: usize = 4;
/// The name of the last of these.
const BESIDE: usize = 3;
/// Where round solids look for slopes beside them, in reaches along x and y.
const SIDES: [[f64; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
/// The cosine of the least angle that such a slope has with the one below, 3.6°: what is less steep is seen soon
/// enough.
const BEND: f64 = 0.998;

/// A terrain to stand on.
pub struct Relief(pub Arc<Terrain>);

/// A way to face: two directions along the ground and the one up, as columns.
#[derive(Clone, Copy)]
pub struct Slope(Mat3<Alone>);

impl Slope {
    /// Facing a way, of length 1.
    fn towards(up: Vector3<f64>) -> Self {
        // What is least along it leads across it.
        let axis = if up.x.abs() < 0.8 { Vector3::x() } else { Vector3::y() };
        let first = (axis - up * up.dot(&axis)).normalize();
        Self(Mat3([first, up.cross(&first), up].map(|column| Alone.vector(&column))))
    }
}

impl Facing<Alone> for Slope {
    fn up(&self, _: Alone) -> Vec3<Alone> {
        self.0.0[2]
    }

    fn rise(&self, vector: &Vec3<Alone>) -> Real<Alone> {
        self.0.0[2].dot(vector)
    }

    fn along(&self, vector: Vec3<Alone>) -> Vec3<Alone> {
        let [first, second, up] = &self.0.0;
        Vec3([first.dot(&vector), second.dot(&vector), up.dot(&vector)])
    }

    fn world(&self, vector: Vec3<Alone>) -> Vec3<Alone> {
        self.0.applied(&vector)
    }

    fn wrenches(&self, point_m: &Vec3<Alone>) -> [[Real<Alone>; 3]; 6] {
        let [first, second, up] = &self.0.0;
        let torques = Mat3([point_m.cross(first), point_m.cross(second), point_m.cross(up)]);
        let [Vec3(a), Vec3(b), Vec3(c)] = torques.transposed().0;
        let [Vec3(x), Vec3(y), Vec3(z)] = self.0.transposed().0;
        [a, b, c, x, y, z]
    }
}

/// One world at a time: most of a step is to look at the ground below one point after the other, so that several side
/// by side were no faster.
impl Footing<Alone> for Relief {
    type Facing = Slope;
    const TOUCHES_PER_SOLID: usize = GROUNDS * POINTS;

    fn find(
        &self,
        solids: &[Surface],
        stance: Stance<Alone>,
        touches: &mut Vec<Touch<Slope, Alone>>,
    ) {
        touches.clear();
        for (index, surface) in solids.iter().enumerate() {
            let place = &stance.places[surface.link];
            let mut foot = Foot {
                surface,
                rotation: place.rotation,
                velocity: stance.velocities[surface.link],
                reference_m: stance.reference_m.alone(),
                step_s: stance.step_s.get(0),
                centre_m: place.origin_m + place.rotation.applied_to(&surface.centre_m),
                name: index * GROUNDS * POINTS,
                touches: &mut *touches,
            };
            foot.touch(&self.0);
        }
    }
}

/// A solid that may touch.
struct Foot<'a> {
    surface: &'a Surface,
    /// The world's axes from its link's.
    rotation: Mat3<Alone>,
    velocity: Spatial<Alone>,
    /// The reference in the world, in metres.
    reference_m: Vector3<f64>,
    step_s: f64,
    /// Its centre, from the reference, in metres.
    centre_m: Vec3<Alone>,
    /// The name of its first touch.
    name: usize,
    touches: &'a mut Vec<Touch<Slope, Alone>>,
}

impl Foot<'_> {
    fn touch(&mut self, terrain: &Terrain) {
        if self.is_near(terrain) {
            self.touch_ground(terrain);
        }
        for axis in 0..2 {
            self.touch_walls(terrain, axis);
        }
    }

    /// Whether any of its points may touch the ground.
    fn is_near(&self, terrain: &Terrain) -> bool {
        let centre_m = self.reference_m + self.centre_m.alone();
        let reach_m = self.reach_m();
        let far = Vector2::repeat(reach_m);
        let highest_m = terrain.highest_m(centre_m.xy() - far, centre_m.xy() + far);
        centre_m.z - reach_m - highest_m < MARGIN_M
    }

    /// How far from its centre it touches within half a step, in metres.
    fn reach_m(&self) -> f64 {
        let turn_m_s = self.surface.reach_m * self.velocity.angular().alone().norm();
        let speed_m_s = self.velocity.velocity_at(&self.centre_m).alone().norm() + turn_m_s;
        self.surface.reach_m + 0.5 * speed_m_s * self.step_s
    }

    fn touch_ground(&mut self, terrain: &Terrain) {
        let centre_m = self.reference_m + self.centre_m.alone();
        let below = terrain.facet(centre_m.x, centre_m.y).normal;
        self.touch_facets(terrain, below, 0);
        if let Outline::Ends(_) = self.surface.outline {
            self.touch_beside(terrain, below);
        }
    }

    /// Touches slopes beside a round solid. The points of other solids are where they are whatever is below; a round
    /// one has a lowest point for each way that the ground faces.
    fn touch_beside(&mut self, terrain: &Terrain, below: Vector3<f64>) {
        let centre_m = self.reference_m + self.centre_m.alone();
        let mut seen = [below; 1 + SIDES.len()];
        for (side, [x, y]) in SIDES.into_iter().enumerate() {
            let [x_m, y_m] = [(centre_m.x, x), (centre_m.y, y)]
                .map(|(at_m, side)| at_m + side * self.surface.reach_m);
            let up = terrain.facet(x_m, y_m).normal;
            if seen.iter().all(|other| other.dot(&up) < BEND) {
                seen[1 + side] = up;
                self.touch_facets(terrain, up, BESIDE * POINTS + side * RINGS.len());
            }
        }
    }

    /// Touches the ground with the points that are lowest where it faces a way, the first of which has a name.
    fn touch_facets(&mut self, terrain: &Terrain, up: Vector3<f64>, first: usize) {
        let towards = Slope::towards(up);
        let (points, count) = self.points(&towards);
        let motion = self.motion(&towards);
        for (corner, point_m) in points.iter().enumerate().take(count) {
            let at_m = self.reference_m + point_m.alone();
            let facet = terrain.facet(at_m.x, at_m.y);
            let height_m = (at_m.z - facet.height_m) * facet.normal.z;
            self.note(first + corner, point_m, &motion, height_m, facet.normal);
        }
    }

    /// Touches the walls that stand across an axis, the tops of which are as wide as it takes.
    fn touch_walls(&mut self, terrain: &Terrain, axis: usize) {
        let half_m = terrain.half_m()[axis];
        let centre_m = self.reference_m[axis] + self.centre_m.alone()[axis];
        if centre_m.abs() + self.reach_m() + MARGIN_M < half_m {
            return;
        }
        let side = centre_m.signum();
        let inwards = -side * Vector3::ith(axis, 1.0);
        let towards = Slope::towards(inwards);
        let (points, count) = self.points(&towards);
        let motion = self.motion(&towards);
        for (corner, point_m) in points.iter().enumerate().take(count) {
            let at_m = self.reference_m + point_m.alone();
            let within_m = half_m - side * at_m[axis];
            let above_m = at_m.z - terrain.wall_top_m();
            let corner = (axis + 1) * POINTS + corner;
            if within_m < 0.0 && above_m >= within_m {
                self.note(corner, point_m, &motion, above_m, Vector3::z());
            } else if above_m < 0.0 {
                self.note(corner, point_m, &motion, within_m, inwards);
            }
        }
    }

    /// Notes a point that has a motion and is so high over a ground that faces a way, half a step ahead, if it touches
    /// by the end of the step.
    fn note(
        &mut self,
        corner: usize,
        point_m: &Vec3<Alone>,
        motion: &Spatial<Alone>,
        ahead_m: f64,
        up: Vector3<f64>,
    ) {
        let way_m = motion.velocity_at(point_m) * self.step_s;
        let rise_m = up.dot(&way_m.alone());
        let height_m = ahead_m - 0.5 * rise_m;
        if height_m + rise_m.min(0.0) < MARGIN_M {
            self.touches.push(Touch {
                name: self.name + corner,
                link: self.surface.link,
                is_there: Alone.mask(true),
                point_m: *point_m,
                acts_m: *point_m - way_m * 0.5,
                height_m: Alone.real(height_m),
                facing: Slope::towards(up),
            });
        }
    }

    /// The motion of its points, where the ground faces a way.
    fn motion(&self, facing: &Slope) -> Spatial<Alone> {
        let Self { surface, centre_m, rotation, velocity, .. } = self;
        surface.outline_motion(velocity, centre_m, rotation, facing)
    }

    /// The points that it can touch a ground with that faces a way, from the reference, and how many there are.
    fn points(&self, facing: &Slope) -> ([Vec3<Alone>; POINTS], usize) {
        let Self { surface, centre_m, rotation, .. } = self;
        let up = rotation.applied_to(&surface.axes.column(2).into_owned());
        match surface.outline {
            Outline::Ends(count) => {
                let (lowest_m, to_end_m) = surface.ends(centre_m, &up, facing);
                let at = |point: usize| lowest_m + to_end_m * RINGS[point % RINGS.len()];
                (std::array::from_fn(at), if count == 1 { 1 } else { RINGS.len() })
            }
            Outline::Corners | Outline::Rims => {
                let end_m = up * surface.half_m.z;
                let spokes_m = surface.spokes(&up, rotation, facing);
                let at = |point: usize| *centre_m + spokes_m[point % 4] + end_m * RINGS[point / 4];
                (std::array::from_fn(at), POINTS)
            }
        }
    }
}
