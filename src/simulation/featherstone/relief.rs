//! Points of a body that touch a terrain or its walls.
//!
//! Points touch the triangle that is below them; a round solid has a lowest point for the slope below it, and more for
//! those beside it that face another way, which it meets before its centre is over them. Between those at their ends,
//! solids touch with points a third of their length apart, since a rock may be where a plane is not. Walls are boxes:
//! from within they are touched with their sides, from above with their tops.

use super::super::terrain::Terrain;
use super::contact::{Facing, Footing, MARGIN_M, Stance, Touch};
use super::kinematics::Place;
use super::model::{Outline, Surface};
use super::spatial::Spatial;
use nalgebra::{Matrix3, Vector2, Vector3};

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
#[derive(Debug, Clone, Copy)]
pub struct Relief(pub &'static Terrain);

/// A way to face: two directions along the ground and the one up, as columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope(Matrix3<f64>);

impl Slope {
    /// Facing a way, of length 1.
    fn towards(up: Vector3<f64>) -> Self {
        // What is least along it leads across it.
        let axis = if up.x.abs() < 0.8 { Vector3::x() } else { Vector3::y() };
        let first = (axis - up * up.dot(&axis)).normalize();
        Self(Matrix3::from_columns(&[first, up.cross(&first), up]))
    }
}

impl Facing for Slope {
    fn up(&self) -> Vector3<f64> {
        self.0.column(2).into_owned()
    }

    fn rise(&self, vector: &Vector3<f64>) -> f64 {
        self.0.column(2).dot(vector)
    }

    fn along(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.0.tr_mul(&vector)
    }

    fn world(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.0 * vector
    }

    fn wrenches(&self, point_m: &Vector3<f64>) -> [[f64; 4]; 6] {
        let force = |axis: usize| self.0.column(axis).into_owned();
        let torques = [0, 1, 2].map(|axis| point_m.cross(&force(axis)));
        std::array::from_fn(|i| {
            let entry = |axis: usize| if i < 3 { torques[axis][i] } else { self.0[(i - 3, axis)] };
            [entry(0), entry(1), entry(2), 0.0]
        })
    }
}

impl Footing for Relief {
    type Facing = Slope;
    const TOUCHES_PER_SOLID: usize = GROUNDS * POINTS;

    fn find(&self, solids: &[Surface], stance: Stance, touches: &mut Vec<Touch<Slope>>) {
        touches.clear();
        for (index, surface) in solids.iter().enumerate() {
            let place = &stance.places[surface.link];
            let centre_m = place.origin_m + place.rotation * surface.centre_m;
            let name = index * Self::TOUCHES_PER_SOLID;
            let mut foot = Foot { stance, surface, place, centre_m, name, touches: &mut *touches };
            if self.is_near(&foot) {
                foot.touch_ground(self.0);
            }
            for axis in 0..2 {
                foot.touch_walls(self.0, axis);
            }
        }
    }
}

impl Relief {
    /// Whether any point of a solid may touch the ground.
    fn is_near(&self, foot: &Foot) -> bool {
        let centre_m = foot.stance.reference_m + foot.centre_m;
        let reach_m = foot.reach_m();
        let far = Vector2::repeat(reach_m);
        let highest_m = self.0.highest_m(centre_m.xy() - far, centre_m.xy() + far);
        centre_m.z - reach_m - highest_m < MARGIN_M
    }
}

/// A solid that may touch.
struct Foot<'a> {
    stance: Stance<'a>,
    surface: &'a Surface,
    place: &'a Place,
    /// Its centre, from the reference, in metres.
    centre_m: Vector3<f64>,
    /// The name of its first touch.
    name: usize,
    touches: &'a mut Vec<Touch<Slope>>,
}

impl Foot<'_> {
    /// How far from its centre it touches within half a step, in metres.
    fn reach_m(&self) -> f64 {
        let velocity = &self.stance.velocities[self.surface.link];
        let turn_m_s = self.surface.reach_m * velocity.angular().norm();
        let speed_m_s = velocity.velocity_at(&self.centre_m).norm() + turn_m_s;
        self.surface.reach_m + 0.5 * speed_m_s * self.stance.step_s
    }

    fn touch_ground(&mut self, terrain: &Terrain) {
        let centre_m = self.stance.reference_m + self.centre_m;
        let below = terrain.facet(centre_m.x, centre_m.y).normal;
        self.touch_facets(terrain, below, 0);
        if let Outline::Ends(_) = self.surface.outline {
            self.touch_beside(terrain, below);
        }
    }

    /// Touches slopes beside a round solid. The points of other solids are where they are whatever is below; a round
    /// one has a lowest point for each way that the ground faces.
    fn touch_beside(&mut self, terrain: &Terrain, below: Vector3<f64>) {
        let centre_m = self.stance.reference_m + self.centre_m;
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
            let at_m = self.stance.reference_m + point_m;
            let facet = terrain.facet(at_m.x, at_m.y);
            let height_m = (at_m.z - facet.height_m) * facet.normal.z;
            self.touch(first + corner, point_m, &motion, height_m, facet.normal);
        }
    }

    /// Touches the walls that stand across an axis, the tops of which are as wide as it takes.
    fn touch_walls(&mut self, terrain: &Terrain, axis: usize) {
        let half_m = terrain.half_m()[axis];
        let centre_m = self.stance.reference_m[axis] + self.centre_m[axis];
        if centre_m.abs() + self.reach_m() + MARGIN_M < half_m {
            return;
        }
        let side = centre_m.signum();
        let inwards = -side * Vector3::ith(axis, 1.0);
        let towards = Slope::towards(inwards);
        let (points, count) = self.points(&towards);
        let motion = self.motion(&towards);
        for (corner, point_m) in points.iter().enumerate().take(count) {
            let at_m = self.stance.reference_m + point_m;
            let within_m = half_m - side * at_m[axis];
            let above_m = at_m.z - terrain.wall_top_m();
            let corner = (axis + 1) * POINTS + corner;
            if within_m < 0.0 && above_m >= within_m {
                self.touch(corner, point_m, &motion, above_m, Vector3::z());
            } else if above_m < 0.0 {
                self.touch(corner, point_m, &motion, within_m, inwards);
            }
        }
    }

    /// Notes a point that has a motion and is so high over a ground that faces a way, half a step ahead, if it touches
    /// by the end of the step.
    fn touch(
        &mut self,
        corner: usize,
        point_m: &Vector3<f64>,
        motion: &Spatial,
        ahead_m: f64,
        up: Vector3<f64>,
    ) {
        let link = self.surface.link;
        let way_m = motion.velocity_at(point_m) * self.stance.step_s;
        let rise_m = up.dot(&way_m);
        let height_m = ahead_m - 0.5 * rise_m;
        if height_m + rise_m.min(0.0) < MARGIN_M {
            let (name, facing) = (self.name + corner, Slope::towards(up));
            let acts_m = point_m - way_m * 0.5;
            let point_m = *point_m;
            self.touches.push(Touch { name, link, point_m, acts_m, height_m, facing });
        }
    }

    /// The motion of its points, where the ground faces a way.
    fn motion(&self, facing: &Slope) -> Spatial {
        let Self { stance, surface, centre_m, place, .. } = self;
        let velocity = &stance.velocities[surface.link];
        surface.outline_motion(velocity, centre_m, &place.rotation, facing)
    }

    /// The points that it can touch a ground with that faces a way, from the reference, and how many there are.
    fn points(&self, facing: &Slope) -> ([Vector3<f64>; POINTS], usize) {
        let Self { surface, centre_m, place, .. } = self;
        let up = place.rotation * surface.axes.column(2);
        match surface.outline {
            Outline::Ends(count) => {
                let (lowest_m, to_end_m) = surface.ends(centre_m, &up, facing);
                let at = |point: usize| lowest_m + to_end_m * RINGS[point % RINGS.len()];
                (std::array::from_fn(at), if count == 1 { 1 } else { RINGS.len() })
            }
            Outline::Corners | Outline::Rims => {
                let end_m = up * surface.half_m.z;
                let spokes_m = surface.spokes(&up, &place.rotation, facing);
                let at = |point: usize| centre_m + spokes_m[point % 4] + end_m * RINGS[point / 4];
                (std::array::from_fn(at), POINTS)
            }
        }
    }
}
