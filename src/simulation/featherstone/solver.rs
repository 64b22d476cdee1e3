//! Impulses of motors and contacts, by sweeps of projected Gauss–Seidel.
//!
//! Every constraint is a row y = L⁻ᵀJᵀ in the whitened velocities (see [`super::factor`]), and costs no more than the
//! loose hinges between its link and the root. Rows are of like size there whatever the masses are, so single
//! precision carries the sweeps: they find a small change of velocities that are known in double precision.
//! Contacts are solved as a block each: the normal impulse first, then friction within its cone (Moreau and Jean's
//! contact dynamics; Horak and Trinkle 2019 compare such solvers), started from the impulses of the step before.

use super::super::trial::FRICTION;
use super::contact::Touch;
use super::factor::{Factor, Whitened};
use super::spatial::Spatial;

/// The most sweeps of a step.
pub const SWEEPS: usize = 10;

/// The coefficient of friction between the ground and a link.
const GRIP: f32 = (FRICTION * FRICTION) as f32;

/// The share of a penetration that a step takes back (Baumgarte 1972).
const PUSH_SHARE: f64 = 0.2;
/// The greatest speed of that, in m/s: what is deep in the ground shall come out, not fly.
const PUSH_M_S_MAX: f64 = 1.0;

/// Whitened velocities of the root, with two lanes more to fill vectors.
type Root = [f32; 8];

/// The constraints of a step.
#[derive(Debug, Clone, Default)]
pub struct Solver {
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// The motors of loose hinges.
    pub motors: Vec<MotorRow>,
    contact_chains: Vec<ChainLink<3>>,
    motor_chains: Vec<ChainLink<1>>,
    root: Root,
    hinges: Vec<f32>,
}

/// A contact with the ground: three rows, along the world's axes.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Which.
    pub touch: Touch,
    /// The impulse on the link, in newton seconds.
    pub impulse_ns: [f32; 3],
    /// The velocity that the point would have without impulses, above what it may have, in m/s.
    free_m_s: [f32; 3],
    root: [Root; 3],
    chain: std::ops::Range<usize>,
    /// What the normal impulse does to the velocities along x and y.
    coupling: [f32; 2],
    inverse_normal: f32,
    /// The inverse of the block of the two tangents: xx, yy, xy.
    inverse_tangent: [f32; 3],
    /// What a sliding contact's impulse changes by for each unit of its velocity.
    slide: f32,
}

/// A motor that may slip.
#[derive(Debug, Clone)]
pub struct MotorRow {
    /// The hinge's link.
    pub link: usize,
    /// The impulse, in newton metre seconds.
    pub impulse_nms: f32,
    /// The greatest.
    bound_nms: f32,
    /// How much faster than its aim the hinge would be without impulses, in rad/s.
    free_rad_s: f32,
    root: Root,
    chain: std::ops::Range<usize>,
    inverse: f32,
}

/// A row's value at a loose hinge, for each direction.
#[derive(Debug, Clone, Copy)]
struct ChainLink<const N: usize> {
    y: [f32; N],
    hinge: u32,
}

impl Solver {
    /// Room for a body.
    pub fn new(links: usize) -> Self {
        Self { hinges: vec![0.0; links], ..Self::default() }
    }

    /// Forgets all constraints.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.motors.clear();
        self.contact_chains.clear();
        self.motor_chains.clear();
    }

    /// Adds a contact, with the impulse to begin with.
    pub fn add_contact(
        &mut self,
        touch: Touch,
        impulse_ns: [f32; 3],
        factor: &Factor,
        free: &Spatial,
        step_s: f64,
    ) {
        let start = self.contact_chains.len();
        let mut block = Block::default();
        let [x, y, z] = touch.point_m.into();
        let wrenches = [
            [0.0, -z, y, 0.0],
            [z, 0.0, -x, 0.0],
            [-y, x, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ];
        let root = factor.whiten_wrenches(touch.link, wrenches, |hinge, y| {
            block.add(y);
            let y = [y[0] as f32, y[1] as f32, y[2] as f32];
            self.contact_chains.push(ChainLink { y, hinge: hinge as u32 });
        });
        root.iter().for_each(|y| block.add(*y));
        let row = |lane: usize| {
            let value = |i: usize| if i < 6 { root[i][lane] as f32 } else { 0.0 };
            std::array::from_fn(value)
        };
        let mut free_m_s: [f64; 3] = free.velocity_at(&touch.point_m).into();
        free_m_s[2] -= least_speed(touch.height_m, step_s);
        let chain = start..self.contact_chains.len();
        let rows = [row(0), row(1), row(2)];
        self.contacts.push(Contact::new(touch, impulse_ns, free_m_s, rows, chain, &block));
    }

    /// Adds the motor of a loose hinge, with the impulse to begin with.
    pub fn add_motor(
        &mut self,
        link: usize,
        impulse_nms: f32,
        bound_nms: f64,
        excess_rad_s: f64,
        factor: &Factor,
    ) {
        let start = self.motor_chains.len();
        let mut square = 0.0;
        let root = factor.whiten_hinge(link, |hinge, [y]| {
            square += y * y;
            self.motor_chains.push(ChainLink { y: [y as f32], hinge: hinge as u32 });
        });
        root.iter().for_each(|[y]| square += y * y);
        let bound_nms = bound_nms as f32;
        self.motors.push(MotorRow {
            link,
            impulse_nms: impulse_nms.clamp(-bound_nms, bound_nms),
            bound_nms,
            free_rad_s: excess_rad_s as f32,
            root: std::array::from_fn(|i| if i < 6 { root[i][0] as f32 } else { 0.0 }),
            chain: start..self.motor_chains.len(),
            inverse: inverse(square) as f32,
        });
    }

    /// Finds the impulses, and adds what they change to the whitened velocities.
    pub fn solve(&mut self, velocities: &mut Whitened) {
        self.start();
        for _ in 0..SWEEPS {
            self.sweep_motors();
            self.sweep_contacts();
        }
        for (velocity, change) in velocities.root.iter_mut().zip(self.root) {
            *velocity += f64::from(change);
        }
        for (velocity, change) in velocities.hinges.iter_mut().zip(&self.hinges) {
            *velocity += f64::from(*change);
        }
    }

    /// What the impulses to begin with change.
    fn start(&mut self) {
        self.root = [0.0; 8];
        self.hinges.fill(0.0);
        for motor in &self.motors {
            motor.push(motor.impulse_nms, &mut self.root, &mut self.hinges, &self.motor_chains);
        }
        for contact in &self.contacts {
            let chain = &self.contact_chains[contact.chain.clone()];
            contact.push(contact.impulse_ns, &mut self.root, &mut self.hinges, chain);
        }
    }

    fn sweep_motors(&mut self) {
        for motor in &mut self.motors {
            let mut excess = motor.free_rad_s + dot(&motor.root, &self.root);
            for link in &self.motor_chains[motor.chain.clone()] {
                excess += link.y[0] * self.hinges[link.hinge as usize];
            }
            let wanted = motor.impulse_nms - excess * motor.inverse;
            let impulse_nms = wanted.clamp(-motor.bound_nms, motor.bound_nms);
            let change = impulse_nms - motor.impulse_nms;
            motor.impulse_nms = impulse_nms;
            motor.push(change, &mut self.root, &mut self.hinges, &self.motor_chains);
        }
    }

    fn sweep_contacts(&mut self) {
        let mut root = self.root;
        for contact in &mut self.contacts {
            let chain = &self.contact_chains[contact.chain.clone()];
            let velocity = contact.velocity(&root, &self.hinges, chain);
            let change = contact.improve(velocity);
            contact.push(change, &mut root, &mut self.hinges, chain);
        }
        self.root = root;
    }
}

impl MotorRow {
    #[inline]
    fn push(&self, impulse: f32, root: &mut Root, hinges: &mut [f32], chains: &[ChainLink<1>]) {
        for (velocity, y) in root.iter_mut().zip(self.root) {
            *velocity += y * impulse;
        }
        for link in &chains[self.chain.clone()] {
            hinges[link.hinge as usize] += link.y[0] * impulse;
        }
    }

    /// Whether the motor turns as it should without giving all that it has.
    pub fn is_at_ease(&self) -> bool {
        self.impulse_nms.abs() < self.bound_nms
    }
}

impl Contact {
    fn new(
        touch: Touch,
        impulse_ns: [f32; 3],
        free_m_s: [f64; 3],
        root: [Root; 3],
        chain: std::ops::Range<usize>,
        block: &Block,
    ) -> Self {
        let [xx, yy, zz] = block.squares;
        let [xy, yz, zx] = block.products;
        let determinant = inverse(xx * yy - xy * xy);
        // The larger eigenvalue of the tangents' block.
        let half_gap = (xx - yy) * 0.5;
        let largest = (xx + yy) * 0.5 + (half_gap * half_gap + xy * xy).sqrt();
        Self {
            touch,
            impulse_ns,
            free_m_s: free_m_s.map(|x| x as f32),
            root,
            chain,
            coupling: [zx as f32, yz as f32],
            inverse_normal: inverse(zz) as f32,
            inverse_tangent: [yy, xx, -xy].map(|x| (x * determinant) as f32),
            slide: inverse(largest) as f32,
        }
    }

    /// The point's velocity above what it may have, with the impulses so far.
    #[inline]
    fn velocity(&self, root: &Root, hinges: &[f32], chain: &[ChainLink<3>]) -> [f32; 3] {
        let mut velocity: [f32; 3] =
            std::array::from_fn(|i| self.free_m_s[i] + dot(&self.root[i], root));
        for link in chain {
            let hinge = hinges[link.hinge as usize];
            for (sum, y) in velocity.iter_mut().zip(link.y) {
                *sum += y * hinge;
            }
        }
        velocity
    }

    /// Finds a better impulse for a velocity, and returns its change.
    #[inline]
    fn improve(&mut self, [mut x, mut y, z]: [f32; 3]) -> [f32; 3] {
        let [xz, yz] = self.coupling;
        let [old_x, old_y, old_z] = self.impulse_ns;
        let normal = (old_z - z * self.inverse_normal).max(0.0);
        let change = normal - old_z;
        x += xz * change;
        y += yz * change;
        let [inverse_xx, inverse_yy, inverse_xy] = self.inverse_tangent;
        let stick =
            [old_x - (inverse_xx * x + inverse_xy * y), old_y - (inverse_xy * x + inverse_yy * y)];
        let most = GRIP * normal;
        let square = stick[0] * stick[0] + stick[1] * stick[1];
        let [new_x, new_y] = if square <= most * most {
            stick
        } else {
            let slide = [old_x - self.slide * x, old_y - self.slide * y];
            let length = (slide[0] * slide[0] + slide[1] * slide[1]).sqrt();
            let scale = if length > most { most / length } else { 1.0 };
            [slide[0] * scale, slide[1] * scale]
        };
        self.impulse_ns = [new_x, new_y, normal];
        [new_x - old_x, new_y - old_y, change]
    }

    #[inline]
    fn push(&self, impulse: [f32; 3], root: &mut Root, hinges: &mut [f32], chain: &[ChainLink<3>]) {
        for (i, velocity) in root.iter_mut().enumerate() {
            *velocity += (self.root[0][i] * impulse[0] + self.root[1][i] * impulse[1])
                + self.root[2][i] * impulse[2];
        }
        for link in chain {
            hinges[link.hinge as usize] +=
                (link.y[0] * impulse[0] + link.y[1] * impulse[1]) + link.y[2] * impulse[2];
        }
    }
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

/// Products of the three rows of a contact with each other.
#[derive(Default)]
struct Block {
    squares: [f64; 3],
    /// x·y, y·z, z·x.
    products: [f64; 3],
}

impl Block {
    #[inline]
    fn add(&mut self, y: [f64; 4]) {
        for lane in 0..3 {
            self.squares[lane] += y[lane] * y[lane];
            self.products[lane] += y[lane] * y[(lane + 1) % 3];
        }
    }
}

#[inline]
fn dot(a: &Root, b: &Root) -> f32 {
    let product: Root = std::array::from_fn(|i| a[i] * b[i]);
    let half: [f32; 4] = std::array::from_fn(|i| product[i] + product[i + 4]);
    (half[0] + half[2]) + (half[1] + half[3])
}

/// 1/x, and nothing of what is not positive: what cannot be moved needs no impulse.
fn inverse(x: f64) -> f64 {
    if x > f64::MIN_POSITIVE { 1.0 / x } else { 0.0 }
}
