//! Points of a body that touch the ground, or will before the step is over.
//!
//! On a plane a box touches with its corners, a cylinder with four points of each rim: the lowest one, the one across,
//! and the two between them; a sphere with its lowest point, a capsule with those of its ends.

use super::kinematics::Place;
use super::model::{Outline, Surface};
use super::spatial::Spatial;
use nalgebra::{Matrix3, Vector3};

/// The most points that a solid touches a plane with.
pub const POINTS_PER_SOLID: usize = 8;

/// A point is looked after when it is nearer to the ground than this, now or by the end of the step, in metres. It
/// must be more than what a step's impulses move a point by that nothing pushed before.
pub const MARGIN_M: f64 = 0.002;

/// What bodies stand on. What kind it is is decided where a world is made, so that a plane costs no more for there
/// being others.
pub trait Footing {
    /// Which ways it faces.
    type Facing: Facing;
    /// The most touches of a solid.
    const TOUCHES_PER_SOLID: usize;

    /// Finds every point of a body that touches.
    fn find(&self, solids: &[Surface], stance: Stance, touches: &mut Vec<Touch<Self::Facing>>);
}

/// The way that the ground faces at a point: the axes that a contact has its rows along.
pub trait Facing: Copy + std::fmt::Debug {
    /// Away from the ground, of length 1.
    fn up(&self) -> Vector3<f64>;

    /// How far a vector goes up.
    fn rise(&self, vector: &Vector3<f64>) -> f64;

    /// A vector along the axes of the contact, the last of which is up.
    fn along(&self, vector: Vector3<f64>) -> Vector3<f64>;

    /// A vector that is given along the axes of the contact, in the world.
    fn world(&self, vector: Vector3<f64>) -> Vector3<f64>;

    /// The wrenches of unit forces along the axes of the contact that act at a point: a row a coordinate, a column
    /// an axis, and a column more to fill it.
    fn wrenches(&self, point_m: &Vector3<f64>) -> [[f64; 4]; 6];
}

/// The plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane;

impl Footing for Plane {
    type Facing = Level;
    const TOUCHES_PER_SOLID: usize = POINTS_PER_SOLID;

    fn find(&self, solids: &[Surface], stance: Stance, touches: &mut Vec<Touch>) {
        find(solids, stance, touches);
    }
}

/// Upwards; the axes are the world's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level;

impl Facing for Level {
    #[inline(always)]
    fn up(&self) -> Vector3<f64> {
        Vector3::z()
    }

    #[inline(always)]
    fn rise(&self, vector: &Vector3<f64>) -> f64 {
        vector.z
    }

    #[inline(always)]
    fn along(&self, vector: Vector3<f64>) -> Vector3<f64> {
        vector
    }

    #[inline(always)]
    fn world(&self, vector: Vector3<f64>) -> Vector3<f64> {
        vector
    }

    #[inline(always)]
    fn wrenches(&self, point_m: &Vector3<f64>) -> [[f64; 4]; 6] {
        let [x, y, z] = (*point_m).into();
        [
            [0.0, -z, y, 0.0],
            [z, 0.0, -x, 0.0],
            [-y, x, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ]
    }
}

/// A point near the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch<F = Level> {
    /// Which point of the body it is: the same one in the next step has the same name.
    pub name: usize,
    /// Its link.
    pub link: usize,
    /// Where it is half a step ahead, from the reference, in metres: its velocity is that of the link there.
    pub point_m: Vector3<f64>,
    /// Where it is when the step begins, from the reference, in metres: the ground pushes it there.
    pub acts_m: Vector3<f64>,
    /// Its height over the ground when the step begins, negative below it, in metres.
    pub height_m: f64,
    /// The way that the ground faces there.
    pub facing: F,
}

/// What there is to know of a body to find where it touches.
#[derive(Debug, Clone, Copy)]
pub struct Stance<'a> {
    /// The places of the links half a step ahead.
    pub places: &'a [Place],
    /// Their velocities.
    pub velocities: &'a [Spatial],
    /// The reference, half a step ahead, in metres.
    pub reference_m: Vector3<f64>,
    /// The time of a step, in seconds.
    pub step_s: f64,
}

fn find(surfaces: &[Surface], stance: Stance, touches: &mut Vec<Touch>) {
    touches.clear();
    for (index, surface) in surfaces.iter().enumerate() {
        let place = &stance.places[surface.link];
        let centre_m = place.origin_m + place.rotation * surface.centre_m;
        if stance.can_reach(surface, &centre_m) {
            let (points, count) = surface.points(&centre_m, &place.rotation);
            let velocity = &stance.velocities[surface.link];
            let motion = surface.outline_motion(velocity, &centre_m, &place.rotation, &Level);
            for (corner, point_m) in points.iter().enumerate().take(count) {
                let way_m = motion.velocity_at(point_m) * stance.step_s;
                let acts_m = point_m - way_m * 0.5;
                let height_m = stance.reference_m.z + acts_m.z;
                if height_m + way_m.z.min(0.0) < MARGIN_M {
                    let name = index * POINTS_PER_SOLID + corner;
                    let (link, point_m) = (surface.link, *point_m);
                    touches.push(Touch { name, link, point_m, acts_m, height_m, facing: Level });
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
        let lowest_m = self.reference_m.z + centre_m.z - surface.reach_m;
        lowest_m - 0.5 * speed_m_s * self.step_s < MARGIN_M
    }
}

impl Surface {
    /// The points that it can touch a plane with, from the reference, and how many of them there are.
    fn points(
        &self,
        centre_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> ([Vector3<f64>; POINTS_PER_SOLID], usize) {
        let up = rotation * self.axes.column(2);
        let end_m = up * self.half_m.z;
        if let Outline::Ends(count) = self.outline {
            let (lowest_m, to_end_m) = self.ends(centre_m, &up, &Level);
            let side_m = |corner: usize| if corner == 0 { to_end_m } else { -to_end_m };
            return (std::array::from_fn(|corner| lowest_m + side_m(corner)), count);
        }
        let spokes_m = self.spokes(&up, rotation, &Level);
        let points = std::array::from_fn(|corner| {
            let spoke_m = spokes_m[corner % 4];
            centre_m + if corner < 4 { spoke_m + end_m } else { spoke_m - end_m }
        });
        (points, POINTS_PER_SOLID)
    }

    /// The motion of the points that it can touch with, given the velocity of its link. Corners move with the link; the
    /// lowest point of what is round stays lowest while the link rolls.
    pub fn outline_motion(
        &self,
        velocity: &Spatial,
        centre_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
        facing: &impl Facing,
    ) -> Spatial {
        let turn = velocity.angular();
        match self.outline {
            Outline::Corners => *velocity,
            Outline::Rims => {
                let up = rotation * self.axes.column(2);
                let spin = up * up.dot(&turn);
                *velocity - Spatial::new(spin, centre_m.cross(&spin))
            }
            Outline::Ends(_) => {
                let roll_m_s = turn.cross(&(facing.up() * self.half_m.x));
                *velocity + Spatial::new(Vector3::zeros(), roll_m_s)
            }
        }
    }

    /// The lowest point of a round end, as if it were in the middle, and the way from there to its place.
    pub fn ends(
        &self,
        centre_m: &Vector3<f64>,
        up: &Vector3<f64>,
        facing: &impl Facing,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let radius_m = self.half_m.x;
        (centre_m - facing.up() * radius_m, up * (self.half_m.z - radius_m))
    }

    /// The ways from the axis of a box or a cylinder, which points along `up`, to four points of its outline.
    pub fn spokes(
        &self,
        up: &Vector3<f64>,
        rotation: &Matrix3<f64>,
        facing: &impl Facing,
    ) -> [Vector3<f64>; 4] {
        if self.outline == Outline::Rims {
            let down_m = self.downwards(up, rotation, facing) * self.half_m.x;
            let across_m = up.cross(&down_m);
            return [down_m, across_m, -down_m, -across_m];
        }
        let x_m = rotation * self.axes.column(0) * self.half_m.x;
        let y_m = rotation * self.axes.column(1) * self.half_m.y;
        [x_m + y_m, y_m - x_m, -x_m - y_m, x_m - y_m]
    }

    /// The unit vector across the axis of a cylinder that points down most; one of the solid's own if the cylinder
    /// stands upright and none does.
    fn downwards(
        &self,
        up: &Vector3<f64>,
        rotation: &Matrix3<f64>,
        facing: &impl Facing,
    ) -> Vector3<f64> {
        const UPRIGHT: f64 = 1e-6;
        let down = up * facing.rise(up) - facing.up();
        let length = down.norm();
        if length > UPRIGHT { down / length } else { rotation * self.axes.column(0) }
    }
}
