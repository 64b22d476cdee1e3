//! Constraints as rows in whitened velocities: what a motor or a contact sees of the body, and does to it.
//!
//! A row y = L⁻ᵀJᵀ (see [`super::factor`]) has entries at the root and at the loose hinges between its link and the
//! root only. Rows are of like size whatever the masses are, so single precision carries them: they look for a
//! small change of velocities that are known in double precision.
//!
//! A constraint that is there in some worlds only has no impulse in the others.

use super::contact::{Facing, Touch};
use super::factor::Factor;
use super::spatial::Spatial;
use crate::simulation::lanes::width::Width;
use crate::simulation::lanes::{Everywhere, Mask, Real, Single, Vec3};
use std::ops::Range;

/// The share of a penetration that a step takes back (Baumgarte 1972).
const PUSH_SHARE: f64 = 0.2;
/// The greatest speed of that, in m/s: what is deep in the ground shall come out, not fly.
const PUSH_M_S_MAX: f64 = 1.0;

/// Whitened velocities of the root.
pub type Root<W> = [Single<W>; 6];

/// What the impulses of a step have changed, in whitened velocities.
pub struct Change<'a, W: Width> {
    /// At the root.
    pub root: Root<W>,
    /// At each link's hinge.
    pub hinges: &'a mut [Single<W>],
}

/// The entry of a row, or of several that go the same way, at a loose hinge.
#[derive(Clone, Copy)]
pub struct Entry<const M: usize, W: Width> {
    hinge: usize,
    y: [Single<W>; M],
}

/// A motor that may slip.
#[derive(Clone)]
pub struct MotorRow<W: Width> {
    /// The hinge's link.
    pub link: usize,
    /// Where it slips.
    pub is_loose: Mask<W>,
    /// The impulse so far, in newton metre seconds.
    pub impulse_nms: Single<W>,
    /// The greatest.
    bound_nms: Single<W>,
    /// How much faster than its aim the hinge would be without impulses, in rad/s.
    free_rad_s: Single<W>,
    root: Root<W>,
    chain: Range<usize>,
    /// What a unit of impulse does to the speed.
    square: Single<W>,
    inverse: Single<W>,
}

/// A contact with the ground: three rows, along the axes of the way that the ground faces.
#[derive(Clone)]
pub struct Contact<W: Width> {
    /// Where it is.
    touches: Mask<W>,
    /// The impulse on the link so far, in newton seconds.
    pub impulse_ns: [Single<W>; 3],
    /// The velocity that the point would have without impulses, above what it may have, in m/s.
    free_m_s: [Single<W>; 3],
    /// The rows at the root, by coordinate and then by direction.
    root: [[Single<W>; 3]; 6],
    chain: Range<usize>,
    /// What a unit of normal impulse does to the velocities along the ground.
    coupling: [Single<W>; 2],
    inverse_normal: Single<W>,
    /// The inverse of what impulses along x and y do to the velocities there: xx, yy, xy.
    inverse_tangent: [Single<W>; 3],
    /// The impulse against a unit of sliding velocity that is too much in no direction.
    inverse_slide: Single<W>,
    /// The most that a unit of impulse does to the velocity along an axis.
    square: Single<W>,
}

impl<W: Width> MotorRow<W> {
    /// The row of a hinge that is loose in some worlds, where it would turn too fast by a speed, with the impulse to
    /// begin with.
    #[inline(always)]
    pub fn new(
        link: usize,
        is_loose: Mask<W>,
        excess_rad_s: Real<W>,
        impulse_nms: Single<W>,
        bound_nms: Real<W>,
        factor: &Factor<W>,
        entries: &mut Vec<Entry<1, W>>,
    ) -> Self {
        let start = entries.len();
        let mut square = excess_rad_s.width.real(0.0);
        let root = factor.whiten_hinge(link, |hinge, [y]| {
            square += y * y;
            entries.push(Entry { hinge, y: [y.single()] });
        });
        for [y] in &root {
            square += *y * *y;
        }
        let bound_nms = bound_nms.single();
        Self {
            link,
            is_loose,
            impulse_nms: impulse_nms.within(bound_nms).only(is_loose),
            bound_nms,
            free_rad_s: excess_rad_s.single(),
            root: single(&[root[0][0], root[1][0], root[2][0], root[3][0], root[4][0], root[5][0]]),
            chain: start..entries.len(),
            square: square.single(),
            inverse: square.inverse().single(),
        }
    }

    /// Where the motor does not give all that it has.
    #[inline(always)]
    pub fn is_at_ease(&self) -> Mask<W> {
        self.impulse_nms.abs().is_less(self.bound_nms)
    }

    /// Corrects the impulse in some worlds, and returns the square of the speed that was wrong.
    #[inline(always)]
    pub fn improve(
        &mut self,
        improves: Mask<W>,
        change: &mut Change<W>,
        entries: &[Entry<1, W>],
    ) -> Single<W> {
        let improves = improves & self.is_loose;
        if !improves.any() {
            return self.square.width.single(0.0);
        }
        let mut excess_rad_s = self.free_rad_s + dot(&self.root, &change.root);
        for entry in &entries[self.chain.clone()] {
            excess_rad_s += entry.y[0] * change.hinges[entry.hinge];
        }
        let wanted = self.impulse_nms - excess_rad_s * self.inverse;
        let impulse_nms = wanted.within(self.bound_nms);
        let more = (impulse_nms - self.impulse_nms).only(improves);
        self.impulse_nms = impulse_nms.where_or(improves, self.impulse_nms);
        self.push(more, change, entries);
        let corrected_rad_s = more * self.square;
        corrected_rad_s * corrected_rad_s
    }

    /// Applies an impulse.
    #[inline(always)]
    pub fn push(&self, impulse: Single<W>, change: &mut Change<W>, entries: &[Entry<1, W>]) {
        for (velocity, y) in change.root.iter_mut().zip(self.root) {
            *velocity += y * impulse;
        }
        for entry in &entries[self.chain.clone()] {
            change.hinges[entry.hinge] += entry.y[0] * impulse;
        }
    }
}

impl<W: Width> Contact<W> {
    /// The rows of a point whose link would move by a velocity, with the impulse to begin with.
    #[inline(always)]
    pub fn new<F: Facing<W>>(
        touch: &Touch<F, W>,
        free: &Spatial<W>,
        impulse_ns: [Single<W>; 3],
        step_s: Real<W>,
        factor: &Factor<W>,
        entries: &mut Vec<Entry<3, W>>,
    ) -> Self {
        let start = entries.len();
        let mut block = Block::new(step_s.width);
        let wrenches = touch.facing.wrenches(&touch.acts_m);
        let root = factor.whiten_wrenches(touch.link, wrenches, |hinge, y| {
            block.add(&y);
            entries.push(Entry { hinge, y: single(&y) });
        });
        for y in &root {
            block.add(y);
        }
        let mut free_m_s = touch.facing.along(free.velocity_at(&touch.point_m));
        free_m_s.0[2] -= least_speed(touch.height_m, step_s);
        let [x, y, z] = impulse_ns;
        let there = touch.is_there;
        let impulse_ns = [x.only(there), y.only(there), z.only(there)];
        Self::of_rows(touch.is_there, &free_m_s, impulse_ns, &root, start..entries.len(), &block)
    }

    #[inline(always)]
    fn of_rows(
        touches: Mask<W>,
        free_m_s: &Vec3<W>,
        impulse_ns: [Single<W>; 3],
        root: &[[Real<W>; 3]; 6],
        chain: Range<usize>,
        block: &Block<W>,
    ) -> Self {
        let [xx, yy, zz] = block.squares;
        let [xy, yz, zx] = block.products;
        let determinant = (xx * yy - xy * xy).inverse();
        let half_gap = (xx - yy) * 0.5;
        let eigenvalue_max = (xx + yy) * 0.5 + (half_gap * half_gap + xy * xy).sqrt();
        Self {
            touches,
            impulse_ns,
            free_m_s: single(&free_m_s.0),
            root: [
                single(&root[0]),
                single(&root[1]),
                single(&root[2]),
                single(&root[3]),
                single(&root[4]),
                single(&root[5]),
            ],
            chain,
            coupling: [zx.single(), yz.single()],
            inverse_normal: zz.inverse().single(),
            inverse_tangent: [
                (yy * determinant).single(),
                (xx * determinant).single(),
                (-xy * determinant).single(),
            ],
            inverse_slide: eigenvalue_max.inverse().single(),
            square: xx.max(yy).max(zz).single(),
        }
    }

    /// Corrects the impulse in some worlds, and returns the square of about the velocity that was wrong.
    #[inline(always)]
    pub fn improve(
        &mut self,
        improves: Mask<W>,
        change: &mut Change<W>,
        entries: &[Entry<3, W>],
        grip: Single<W>,
    ) -> Single<W> {
        let improves = improves & self.touches;
        if !improves.any() {
            return grip.width.single(0.0);
        }
        let velocity_m_s = self.velocity(change, entries);
        let more = self.correct(improves, velocity_m_s, grip);
        self.push(more, change, entries);
        let [x, y, z] = more;
        (x * x + y * y + z * z) * (self.square * self.square)
    }

    /// Applies an impulse.
    #[inline(always)]
    pub fn push(&self, [x, y, z]: [Single<W>; 3], change: &mut Change<W>, entries: &[Entry<3, W>]) {
        for (velocity, row) in change.root.iter_mut().zip(&self.root) {
            *velocity += (row[0] * x + row[1] * y) + row[2] * z;
        }
        for entry in &entries[self.chain.clone()] {
            change.hinges[entry.hinge] += (entry.y[0] * x + entry.y[1] * y) + entry.y[2] * z;
        }
    }

    /// The point's velocity above what it may have, with the impulses so far.
    #[inline(always)]
    fn velocity(&self, change: &Change<W>, entries: &[Entry<3, W>]) -> [Single<W>; 3] {
        let mut velocity = self.free_m_s;
        for (axis, velocity) in velocity.iter_mut().enumerate() {
            let (row, root) = (&self.root, &change.root);
            *velocity = ((*velocity + row[0][axis] * root[0])
                + (row[1][axis] * root[1] + row[2][axis] * root[2]))
                + (row[3][axis] * root[3] + (row[4][axis] * root[4] + row[5][axis] * root[5]));
        }
        for entry in &entries[self.chain.clone()] {
            let hinge = change.hinges[entry.hinge];
            for (velocity, y) in velocity.iter_mut().zip(entry.y) {
                *velocity += y * hinge;
            }
        }
        velocity
    }

    /// Finds a better impulse at a velocity, and returns what is new: the normal impulse first, then friction,
    /// which holds the point if it can and slows it if not.
    #[inline(always)]
    fn correct(
        &mut self,
        improves: Mask<W>,
        [mut x, mut y, z]: [Single<W>; 3],
        grip: Single<W>,
    ) -> [Single<W>; 3] {
        let [old_x, old_y, old_z] = self.impulse_ns;
        let normal = (old_z - z * self.inverse_normal).max(z.width.single(0.0));
        let more = normal - old_z;
        x += self.coupling[0] * more;
        y += self.coupling[1] * more;
        let [xx, yy, xy] = self.inverse_tangent;
        let hold = [old_x - (xx * x + xy * y), old_y - (xy * x + yy * y)];
        let most = grip * normal;
        let holds = (hold[0] * hold[0] + hold[1] * hold[1]).is_at_most(most * most);
        let [mut new_x, mut new_y] = hold;
        if !(holds | !improves).all() {
            let slow = [old_x - self.inverse_slide * x, old_y - self.inverse_slide * y];
            let [slow_x, slow_y] = shortened(slow, most);
            (new_x, new_y) = (hold[0].where_or(holds, slow_x), hold[1].where_or(holds, slow_y));
        }
        let new = [new_x, new_y, normal];
        let old = self.impulse_ns;
        for axis in 0..3 {
            self.impulse_ns[axis] = new[axis].where_or(improves, old[axis]);
        }
        [(new_x - old_x).only(improves), (new_y - old_y).only(improves), more.only(improves)]
    }
}

/// A vector that is no longer than may be.
#[inline(always)]
fn shortened<W: Width>([x, y]: [Single<W>; 2], most: Single<W>) -> [Single<W>; 2] {
    let length = (x * x + y * y).sqrt();
    let scale = (most / length).where_or(most.is_less(length), x.width.single(1.0));
    [x * scale, y * scale]
}

/// The least upward speed of a point at a height, in m/s: one above the ground may reach it and no more
/// (Anitescu and Potra 1997), one below it has to come back.
#[inline(always)]
fn least_speed<W: Width>(height_m: Real<W>, step_s: Real<W>) -> Real<W> {
    let width = step_s.width;
    let back = (-height_m * PUSH_SHARE / step_s).min(width.real(PUSH_M_S_MAX));
    (-height_m / step_s).where_or(width.real(0.0).is_at_most(height_m), back)
}

/// Products of the three rows of a contact with each other: what their impulses do to their velocities.
struct Block<W: Width> {
    /// xx, yy, zz.
    squares: [Real<W>; 3],
    /// xy, yz, zx.
    products: [Real<W>; 3],
}

impl<W: Width> Block<W> {
    #[inline(always)]
    fn new(width: W) -> Self {
        Self { squares: [width.real(0.0); 3], products: [width.real(0.0); 3] }
    }

    #[inline(always)]
    fn add(&mut self, y: &[Real<W>; 3]) {
        for axis in 0..3 {
            self.squares[axis] += y[axis] * y[axis];
            self.products[axis] += y[axis] * y[(axis + 1) % 3];
        }
    }
}

#[inline(always)]
fn dot<W: Width>(a: &Root<W>, b: &Root<W>) -> Single<W> {
    ((a[0] * b[0] + a[4] * b[4]) + a[2] * b[2]) + ((a[1] * b[1] + a[5] * b[5]) + a[3] * b[3])
}

/// Numbers in single precision.
#[inline(always)]
fn single<W: Width, const M: usize>(numbers: &[Real<W>; M]) -> [Single<W>; M] {
    let mut single = [numbers[0].single(); M];
    for (single, number) in single.iter_mut().zip(numbers) {
        *single = number.single();
    }
    single
}
