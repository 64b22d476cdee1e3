//! Constraints as rows in whitened velocities: what a motor or a contact sees of the body, and does to it.
//!
//! A row y = L⁻ᵀJᵀ (see [`super::factor`]) has entries at the root and at the loose hinges between its link and the
//! root only. Rows are of like size whatever the masses are, so single precision carries them: they look for a
//! small change of velocities that are known in double precision.

use super::contact::{Facing, Level, Touch};
use super::factor::{Factor, inverse};
use super::spatial::Spatial;
use nalgebra::Vector3;
use std::ops::Range;

/// The share of a penetration that a step takes back (Baumgarte 1972).
const PUSH_SHARE: f64 = 0.2;
/// The greatest speed of that, in m/s: what is deep in the ground shall come out, not fly.
const PUSH_M_S_MAX: f64 = 1.0;

/// Whitened velocities of the root, with two lanes more to fill vectors.
pub type Root = [f32; 8];

/// What the impulses of a step have changed, in whitened velocities.
#[derive(Debug)]
pub struct Change<'a> {
    /// At the root.
    pub root: Root,
    /// At each link's hinge.
    pub hinges: &'a mut [f32],
}

/// The entry of a row, or of several that go the same way, at a loose hinge.
#[derive(Debug, Clone, Copy)]
pub struct Entry<const N: usize> {
    hinge: usize,
    y: [f32; N],
}

/// A motor that may slip.
#[derive(Debug, Clone)]
pub struct MotorRow {
    /// The hinge's link.
    pub link: usize,
    /// The impulse so far, in newton metre seconds.
    pub impulse_nms: f32,
    /// The greatest.
    bound_nms: f32,
    /// How much faster than its aim the hinge would be without impulses, in rad/s.
    free_rad_s: f32,
    root: Root,
    chain: Range<usize>,
    /// What a unit of impulse does to the speed.
    square: f32,
    inverse: f32,
}

/// A contact with the ground: three rows, along the axes of the way that the ground faces.
#[derive(Debug, Clone)]
pub struct Contact<F = Level> {
    /// Where.
    pub touch: Touch<F>,
    /// The impulse on the link so far, in newton seconds.
    pub impulse_ns: [f32; 3],
    /// The velocity that the point would have without impulses, above what it may have, in m/s; and a lane more.
    free_m_s: [f32; 4],
    /// The rows at the root, by direction, to push with; and by coordinate, to multiply with.
    rows: [Root; 3],
    columns: [[f32; 4]; 6],
    chain: Range<usize>,
    /// What a unit of normal impulse does to the velocities along the ground.
    coupling: [f32; 2],
    inverse_normal: f32,
    /// The inverse of what impulses along x and y do to the velocities there: xx, yy, xy.
    inverse_tangent: [f32; 3],
    /// The impulse against a unit of sliding velocity that is too much in no direction.
    inverse_slide: f32,
    /// The most that a unit of impulse does to the velocity along an axis.
    square: f32,
}

impl MotorRow {
    /// The row of a loose hinge that would turn too fast by a speed, with the impulse to begin with.
    pub fn new(
        link: usize,
        excess_rad_s: f64,
        impulse_nms: f32,
        bound_nms: f64,
        factor: &Factor,
        entries: &mut Vec<Entry<1>>,
    ) -> Self {
        let start = entries.len();
        let mut square = 0.0;
        let root = factor.whiten_hinge(link, |hinge, [y]| {
            square += y * y;
            entries.push(Entry { hinge, y: [y as f32] });
        });
        root.iter().for_each(|[y]| square += y * y);
        let bound_nms = bound_nms as f32;
        Self {
            link,
            impulse_nms: impulse_nms.clamp(-bound_nms, bound_nms),
            bound_nms,
            free_rad_s: excess_rad_s as f32,
            root: filled(|i| root[i][0]),
            chain: start..entries.len(),
            square: square as f32,
            inverse: inverse(square) as f32,
        }
    }

    /// Whether the motor does not give all that it has.
    pub fn is_at_ease(&self) -> bool {
        self.impulse_nms.abs() < self.bound_nms
    }

    /// Corrects the impulse, and returns the square of the speed that was wrong.
    #[inline(always)]
    pub fn improve(&mut self, change: &mut Change, entries: &[Entry<1>]) -> f32 {
        let mut excess_rad_s = self.free_rad_s + dot(&self.root, &change.root);
        for entry in &entries[self.chain.clone()] {
            excess_rad_s += entry.y[0] * change.hinges[entry.hinge];
        }
        let wanted = self.impulse_nms - excess_rad_s * self.inverse;
        let impulse_nms = wanted.clamp(-self.bound_nms, self.bound_nms);
        let more = impulse_nms - self.impulse_nms;
        self.impulse_nms = impulse_nms;
        self.push(more, change, entries);
        let corrected_rad_s = more * self.square;
        corrected_rad_s * corrected_rad_s
    }

    /// Applies an impulse.
    #[inline(always)]
    pub fn push(&self, impulse: f32, change: &mut Change, entries: &[Entry<1>]) {
        for (velocity, y) in change.root.iter_mut().zip(self.root) {
            *velocity += y * impulse;
        }
        for entry in &entries[self.chain.clone()] {
            change.hinges[entry.hinge] += entry.y[0] * impulse;
        }
    }
}

impl<F: Facing> Contact<F> {
    /// The rows of a point whose link would move by a velocity, with the impulse to begin with.
    pub fn new(
        touch: Touch<F>,
        free: &Spatial,
        impulse_ns: [f32; 3],
        step_s: f64,
        factor: &Factor,
        entries: &mut Vec<Entry<4>>,
    ) -> Self {
        let start = entries.len();
        let mut block = Block::default();
        let wrenches = touch.facing.wrenches(&touch.acts_m);
        let root = factor.whiten_wrenches(touch.link, wrenches, |hinge, y| {
            block.add(&y);
            entries.push(Entry { hinge, y: y.map(|y| y as f32) });
        });
        root.iter().for_each(|y| block.add(y));
        let mut free_m_s = touch.facing.along(free.velocity_at(&touch.point_m));
        free_m_s.z -= least_speed(touch.height_m, step_s);
        Self::of_rows(touch, &free_m_s, impulse_ns, &root, start..entries.len(), &block)
    }

    fn of_rows(
        touch: Touch<F>,
        free_m_s: &Vector3<f64>,
        impulse_ns: [f32; 3],
        root: &[[f64; 4]; 6],
        chain: Range<usize>,
        block: &Block,
    ) -> Self {
        let [xx, yy, zz] = block.squares;
        let [xy, yz, zx] = block.products;
        let determinant = inverse(xx * yy - xy * xy);
        let half_gap = (xx - yy) * 0.5;
        let eigenvalue_max = (xx + yy) * 0.5 + (half_gap * half_gap + xy * xy).sqrt();
        Self {
            touch,
            impulse_ns,
            free_m_s: [free_m_s.x as f32, free_m_s.y as f32, free_m_s.z as f32, 0.0],
            rows: std::array::from_fn(|row| filled(|i| root[i][row])),
            columns: root.map(|column| column.map(|y| y as f32)),
            chain,
            coupling: [zx as f32, yz as f32],
            inverse_normal: inverse(zz) as f32,
            inverse_tangent: [yy, xx, -xy].map(|x| (x * determinant) as f32),
            inverse_slide: inverse(eigenvalue_max) as f32,
            square: xx.max(yy).max(zz) as f32,
        }
    }

    /// Corrects the impulse, and returns the square of about the velocity that was wrong.
    #[inline(always)]
    pub fn improve(&mut self, change: &mut Change, entries: &[Entry<4>], grip: f32) -> f32 {
        let velocity_m_s = self.velocity(change, entries);
        let [x, y, z] = self.correct(velocity_m_s, grip);
        self.push([x, y, z], change, entries);
        (x * x + y * y + z * z) * (self.square * self.square)
    }

    /// The impulse on the link so far, in the world, in newton seconds.
    #[inline]
    pub fn world_impulse_ns(&self) -> Vector3<f64> {
        self.touch.facing.world(Vector3::from(self.impulse_ns.map(f64::from)))
    }

    /// Applies an impulse.
    #[inline(always)]
    pub fn push(&self, [x, y, z]: [f32; 3], change: &mut Change, entries: &[Entry<4>]) {
        let [row_x, row_y, row_z] = &self.rows;
        for (i, velocity) in change.root.iter_mut().enumerate() {
            *velocity += (row_x[i] * x + row_y[i] * y) + row_z[i] * z;
        }
        for entry in &entries[self.chain.clone()] {
            change.hinges[entry.hinge] += (entry.y[0] * x + entry.y[1] * y) + entry.y[2] * z;
        }
    }

    /// The point's velocity above what it may have, with the impulses so far.
    #[inline(always)]
    fn velocity(&self, change: &Change, entries: &[Entry<4>]) -> [f32; 4] {
        let column = |i: usize| self.columns[i].map(|y| y * change.root[i]);
        let mut velocity = sum(
            sum(sum(self.free_m_s, column(0)), sum(column(1), column(2))),
            sum(column(3), sum(column(4), column(5))),
        );
        for entry in &entries[self.chain.clone()] {
            let hinge = change.hinges[entry.hinge];
            velocity = sum(velocity, entry.y.map(|y| y * hinge));
        }
        velocity
    }

    /// Finds a better impulse at a velocity, and returns what is new: the normal impulse first, then friction,
    /// which holds the point if it can and slows it if not.
    #[inline(always)]
    fn correct(&mut self, [mut x, mut y, z, _]: [f32; 4], grip: f32) -> [f32; 3] {
        let [old_x, old_y, old_z] = self.impulse_ns;
        let normal = (old_z - z * self.inverse_normal).max(0.0);
        let more = normal - old_z;
        x += self.coupling[0] * more;
        y += self.coupling[1] * more;
        let [xx, yy, xy] = self.inverse_tangent;
        let hold = [old_x - (xx * x + xy * y), old_y - (xy * x + yy * y)];
        let most = grip * normal;
        let [new_x, new_y] = if hold[0] * hold[0] + hold[1] * hold[1] <= most * most {
            hold
        } else {
            let slow = [old_x - self.inverse_slide * x, old_y - self.inverse_slide * y];
            shortened(slow, most)
        };
        self.impulse_ns = [new_x, new_y, normal];
        [new_x - old_x, new_y - old_y, more]
    }
}

/// A vector that is no longer than may be.
#[inline]
fn shortened([x, y]: [f32; 2], most: f32) -> [f32; 2] {
    let length = (x * x + y * y).sqrt();
    let scale = if length > most { most / length } else { 1.0 };
    [x * scale, y * scale]
}

/// The least upward speed of a point at a height, in m/s: one above the ground may reach it and no more
/// (Anitescu and Potra 1997), one below it has to come back.
fn least_speed(height_m: f64, step_s: f64) -> f64 {
    if height_m >= 0.0 {
        -height_m / step_s
    } else {
        (-height_m * PUSH_SHARE / step_s).min(PUSH_M_S_MAX)
    }
}

/// Products of the three rows of a contact with each other: what their impulses do to their velocities.
#[derive(Default)]
struct Block {
    /// xx, yy, zz.
    squares: [f64; 3],
    /// xy, yz, zx.
    products: [f64; 3],
}

impl Block {
    #[inline]
    fn add(&mut self, y: &[f64; 4]) {
        for lane in 0..3 {
            self.squares[lane] += y[lane] * y[lane];
            self.products[lane] += y[lane] * y[(lane + 1) % 3];
        }
    }
}

/// Six numbers of the root, filled up.
fn filled(number: impl Fn(usize) -> f64) -> Root {
    std::array::from_fn(|i| if i < 6 { number(i) as f32 } else { 0.0 })
}

#[inline]
fn sum(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + b[i])
}

#[inline]
fn dot(a: &Root, b: &Root) -> f32 {
    let product: Root = std::array::from_fn(|i| a[i] * b[i]);
    let half: [f32; 4] = std::array::from_fn(|i| product[i] + product[i + 4]);
    (half[0] + half[2]) + (half[1] + half[3])
}
