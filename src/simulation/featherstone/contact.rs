//! Points of a body that touch the ground, or will before the step is over.
//!
//! On a plane a box touches with its corners, a cylinder with four points of each rim: the lowest one, the one across,
//! and the two between them; a sphere with its lowest point, a capsule with those of its ends.

use super::kinematics::Place;
use super::model::{Outline, Surface};
use super::spatial::{Mat3, Spatial};
use crate::simulation::lanes::width::Width;
use crate::simulation::lanes::{Everywhere, Mask, Real, Vec3};
use nalgebra::Vector3;

/// The most points that a solid touches a plane with.
pub const POINTS_PER_SOLID: usize = 8;

/// A point is looked after when it is nearer to the ground than this, now or by the end of the step, in metres. It
/// must be more than what a step's impulses move a point by that nothing pushed before.
pub const MARGIN_M: f64 = 0.002;

/// What bodies stand on. What kind it is is decided where a world is made, so that a plane costs no more for there
/// being others.
pub trait Footing<W: Width> {
    /// Which ways it faces.
    type Facing: Facing<W>;
    /// The most touches of a solid.
    const TOUCHES_PER_SOLID: usize;

    /// Finds every point of a body that touches.
    fn find(
        &self,
        solids: &[Surface],
        stance: Stance<W>,
        touches: &mut Vec<Touch<Self::Facing, W>>,
    );
}

/// The way that the ground faces at a point: the axes that a contact has its rows along.
pub trait Facing<W: Width>: Copy {
    /// Away from the ground, of length 1.
    fn up(&self, width: W) -> Vec3<W>;

    /// How far a vector goes up.
    fn rise(&self, vector: &Vec3<W>) -> Real<W>;

    /// A vector along the axes of the contact, the last of which is up.
    fn along(&self, vector: Vec3<W>) -> Vec3<W>;

    /// A vector that is given along the axes of the contact, in the world.
    fn world(&self, vector: Vec3<W>) -> Vec3<W>;

    /// The wrenches of unit forces along the axes of the contact that act at a point: a row a coordinate, a column
    /// an axis.
    fn wrenches(&self, point_m: &Vec3<W>) -> [[Real<W>; 3]; 6];
}

/// The plane.
#[derive(Clone, Copy)]
pub struct Plane;

impl<W: Width> Footing<W> for Plane {
    type Facing = Level;
    const TOUCHES_PER_SOLID: usize = POINTS_PER_SOLID;

    #[inline(always)]
    fn find(&self, solids: &[Surface], stance: Stance<W>, touches: &mut Vec<Touch<Level, W>>) {
        touches.clear();
        for (index, surface) in solids.iter().enumerate() {
            let place = &stance.places[surface.link];
            let centre_m = place.origin_m + place.rotation.applied_to(&surface.centre_m);
            let reaches = stance.reaches(surface, &centre_m);
            if reaches.any() {
                let name = index * POINTS_PER_SOLID;
                surface.touch_plane(&stance, place, &centre_m, reaches, name, touches);
            }
        }
    }
}

/// Upwards; the axes are the world's.
#[derive(Clone, Copy)]
pub struct Level;

impl<W: Width> Facing<W> for Level {
    #[inline(always)]
    fn up(&self, width: W) -> Vec3<W> {
        width.vector(&Vector3::z())
    }

    #[inline(always)]
    fn rise(&self, vector: &Vec3<W>) -> Real<W> {
        vector.0[2]
    }

    #[inline(always)]
    fn along(&self, vector: Vec3<W>) -> Vec3<W> {
        vector
    }

    #[inline(always)]
    fn world(&self, vector: Vec3<W>) -> Vec3<W> {
        vector
    }

    #[inline(always)]
    fn wrenches(&self, point_m: &Vec3<W>) -> [[Real<W>; 3]; 6] {
        let [x, y, z] = point_m.0;
        let (none, one) = (x.width.real(0.0), x.width.real(1.0));
        [
            [none, -z, y],
            [z, none, -x],
            [-y, x, none],
            [one, none, none],
            [none, one, none],
            [none, none, one],
        ]
    }
}

/// A point near the ground.
#[derive(Clone, Copy)]
pub struct Touch<F, W: Width> {
    /// Which point of the body it is: the same one in the next step has the same name.
    pub name: usize,
    /// Its link.
    pub link: usize,
    /// In which worlds it is near the ground.
    pub is_there: Mask<W>,
    /// Where it is half a step ahead, from the reference, in metres: its velocity is that of the link there.
    pub point_m: Vec3<W>,
    /// Where it is when the step begins, from the reference, in metres: the ground pushes it there.
    pub acts_m: Vec3<W>,
    /// Its height over the ground when the step begins, negative below it, in metres.
    pub height_m: Real<W>,
    /// The way that the ground faces there.
    pub facing: F,
}

/// What there is to know of a body to find where it touches.
#[derive(Clone, Copy)]
pub struct Stance<'a, W: Width> {
    /// The places of the links half a step ahead.
    pub places: &'a [Place<W>],
    /// Their velocities.
    pub velocities: &'a [Spatial<W>],
    /// The reference, half a step ahead, in metres.
    pub reference_m: Vec3<W>,
    /// The time of a step, in seconds.
    pub step_s: Real<W>,
    /// The worlds that have a body.
    pub worlds: Mask<W>,
}

impl<W: Width> Stance<'_, W> {
    /// Where any point of a solid may touch.
    #[inline(always)]
    fn reaches(&self, surface: &Surface, centre_m: &Vec3<W>) -> Mask<W> {
        let velocity = &self.velocities[surface.link];
        let turn_m_s = velocity.angular().norm() * surface.reach_m;
        let speed_m_s = velocity.velocity_at(centre_m).0[2].abs() + turn_m_s;
        let lowest_m = self.reference_m.0[2] + centre_m.0[2] - turn_m_s.width.real(surface.reach_m);
        let near_m = lowest_m - speed_m_s * 0.5 * self.step_s;
        near_m.is_less(near_m.width.real(MARGIN_M)) & self.worlds
    }
}

impl Surface {
    /// Notes the points that touch a plane, the first of which has a name.
    #[inline(always)]
    fn touch_plane<W: Width>(
        &self,
        stance: &Stance<W>,
        place: &Place<W>,
        centre_m: &Vec3<W>,
        reaches: Mask<W>,
        name: usize,
        touches: &mut Vec<Touch<Level, W>>,
    ) {
        let (points, count) = self.points(centre_m, &place.rotation);
        let velocity = &stance.velocities[self.link];
        let motion = self.outline_motion(velocity, centre_m, &place.rotation, &Level);
        for (corner, point_m) in points.iter().enumerate().take(count) {
            let way_m = motion.velocity_at(point_m).times(stance.step_s);
            let acts_m = *point_m - way_m * 0.5;
            let height_m = stance.reference_m.0[2] + acts_m.0[2];
            let lowest_m = height_m + way_m.0[2].min(height_m.width.real(0.0));
            let is_there = lowest_m.is_less(height_m.width.real(MARGIN_M)) & reaches;
            if is_there.any() {
                let (name, link, point_m) = (name + corner, self.link, *point_m);
                let facing = Level;
                touches.push(Touch { name, link, is_there, point_m, acts_m, height_m, facing });
            }
        }
    }

    /// The points that it can touch a plane with, from the reference, and how many of them there are.
    #[inline(always)]
    fn points<W: Width>(
        &self,
        centre_m: &Vec3<W>,
        rotation: &Mat3<W>,
    ) -> ([Vec3<W>; POINTS_PER_SOLID], usize) {
        let up = rotation.applied_to(&self.axes.column(2).into_owned());
        let end_m = up * self.half_m.z;
        let mut points = [*centre_m; POINTS_PER_SOLID];
        if let Outline::Ends(count) = self.outline {
            let (lowest_m, to_end_m) = self.ends(centre_m, &up, &Level);
            (points[0], points[1]) = (lowest_m + to_end_m, lowest_m - to_end_m);
            return (points, count);
        }
        let spokes_m = self.spokes(&up, rotation, &Level);
        for (corner, point_m) in points.iter_mut().enumerate() {
            let spoke_m = spokes_m[corner % 4];
            *point_m = *centre_m + if corner < 4 { spoke_m + end_m } else { spoke_m - end_m };
        }
        (points, POINTS_PER_SOLID)
    }

    /// The motion of the points that it can touch with, given the velocity of its link. Corners move with the link; the
    /// lowest point of what is round stays lowest while the link rolls.
    #[inline(always)]
    pub fn outline_motion<W: Width>(
        &self,
        velocity: &Spatial<W>,
        centre_m: &Vec3<W>,
        rotation: &Mat3<W>,
        facing: &impl Facing<W>,
    ) -> Spatial<W> {
        let (turn, width) = (velocity.angular(), velocity.0[0].width);
        match self.outline {
            Outline::Corners => *velocity,
            Outline::Rims => {
                let up = rotation.applied_to(&self.axes.column(2).into_owned());
                let spin = up.times(up.dot(&turn));
                *velocity - Spatial::new(spin, centre_m.cross(&spin))
            }
            Outline::Ends(_) => {
                let roll_m_s = turn.cross(&(facing.up(width) * self.half_m.x));
                *velocity + Spatial::new(width.vector(&Vector3::zeros()), roll_m_s)
            }
        }
    }

    /// The lowest point of a round end, as if it were in the middle, and the way from there to its place.
    #[inline(always)]
    pub fn ends<W: Width>(
        &self,
        centre_m: &Vec3<W>,
        up: &Vec3<W>,
        facing: &impl Facing<W>,
    ) -> (Vec3<W>, Vec3<W>) {
        let radius_m = self.half_m.x;
        (*centre_m - facing.up(up.0[0].width) * radius_m, *up * (self.half_m.z - radius_m))
    }

    /// The ways from the axis of a box or a cylinder, which points along `up`, to four points of its outline.
    #[inline(always)]
    pub fn spokes<W: Width>(
        &self,
        up: &Vec3<W>,
        rotation: &Mat3<W>,
        facing: &impl Facing<W>,
    ) -> [Vec3<W>; 4] {
        if self.outline == Outline::Rims {
            let down_m = self.downwards(up, rotation, facing) * self.half_m.x;
            let across_m = up.cross(&down_m);
            return [down_m, across_m, -down_m, -across_m];
        }
        let x_m = rotation.applied_to(&self.axes.column(0).into_owned()) * self.half_m.x;
        let y_m = rotation.applied_to(&self.axes.column(1).into_owned()) * self.half_m.y;
        [x_m + y_m, y_m - x_m, -x_m - y_m, x_m - y_m]
    }

    /// The unit vector across the axis of a cylinder that points down most; one of the solid's own if the cylinder
    /// stands upright and none does.
    #[inline(always)]
    fn downwards<W: Width>(
        &self,
        up: &Vec3<W>,
        rotation: &Mat3<W>,
        facing: &impl Facing<W>,
    ) -> Vec3<W> {
        const UPRIGHT: f64 = 1e-6;
        let down = up.times(facing.rise(up)) - facing.up(up.0[0].width);
        let length = down.norm();
        let leans = length.width.real(UPRIGHT).is_less(length);
        let [x, y, z] = down.0;
        let down = Vec3([x / length, y / length, z / length]);
        if leans.all() {
            return down;
        }
        let own = rotation.applied_to(&self.axes.column(0).into_owned());
        let ([x, y, z], [own_x, own_y, own_z]) = (down.0, own.0);
        Vec3([x.where_or(leans, own_x), y.where_or(leans, own_y), z.where_or(leans, own_z)])
    }
}
