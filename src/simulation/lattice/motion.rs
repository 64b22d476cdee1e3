//! How voxels move: weight, air, the floor, and a step of semi-implicit Euler.

use super::body::Floor;
use super::node::{Constants, Load, Node};
use crate::simulation::lanes::width::Width;
use crate::simulation::lanes::{Everywhere, Real, Vec3};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The muscles' clock: what a muscle's length follows. It starts softly, over one cycle, so that nothing jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// The sine of the cycle's angle, and how fast that changes a second.
    pub sine: [f64; 2],
    /// The cosine, and how fast that changes a second.
    pub cosine: [f64; 2],
}

impl Clock {
    /// At a time.
    pub fn at(time_s: f64, frequency_hz: f64) -> Self {
        let omega = TAU * frequency_hz;
        let (sine, cosine) = (libm::sin(omega * time_s), libm::cos(omega * time_s));
        let cycles = time_s * frequency_hz;
        // 3x² − 2x³.
        let (gain, gain_s) = match cycles < 1.0 {
            true => (
                cycles * cycles * (3.0 - 2.0 * cycles),
                6.0 * cycles * (1.0 - cycles) * frequency_hz,
            ),
            false => (1.0, 0.0),
        };
        Self {
            sine: [gain * sine, gain_s * sine + gain * omega * cosine],
            cosine: [gain * cosine, gain_s * cosine - gain * omega * sine],
        }
    }
}

/// What moves every voxel of a step alike.
pub struct Motion<W: Width> {
    step_s: Real<W>,
    weight_m_s: Vec3<W>,
    floor: Option<[Real<W>; 2]>,
    clock: [Real<W>; 4],
}

impl<W: Width> Motion<W> {
    /// For a step after which the clock is as given.
    #[inline(always)]
    pub fn new(
        width: W,
        step_s: f64,
        gravity_m_s2: &Vector3<f64>,
        floor: Option<Floor>,
        clock: Clock,
    ) -> Self {
        let Clock { sine: [sine, sine_s], cosine: [cosine, cosine_s] } = clock;
        let frictions =
            |floor: Floor| [floor.static_friction, floor.kinetic_friction].map(|mu| width.real(mu));
        Self {
            step_s: width.real(step_s),
            weight_m_s: width.vector(&(gravity_m_s2 * step_s)),
            floor: floor.map(frictions),
            clock: [sine, sine_s, cosine, cosine_s].map(|number| width.real(number)),
        }
    }

    /// Moves a voxel in each lane.
    #[inline(always)]
    pub fn advance(&self, node: &mut Node<W>, constants: &Constants<W>, load: &Load<W>) {
        self.push(node, constants, load);
        node.position_m += node.velocity_m_s.times(self.step_s);
        node.spin_rad_s += load.torque_nm.times(constants.turn_mobility);
        self.turn(node);
        self.grow(node, constants);
    }

    /// The next velocity.
    #[inline(always)]
    fn push(&self, node: &mut Node<W>, constants: &Constants<W>, load: &Load<W>) {
        let width = self.step_s.width;
        let zero = width.real(0.0);
        let is_there = zero.is_less(constants.mobility_s_kg);
        let old_m_s = node.velocity_m_s;
        let force_n = load.force_n - old_m_s.times(constants.air_ns_m);
        let mut free_m_s = old_m_s + force_n.times(constants.mobility_s_kg);
        for (velocity, weight) in free_m_s.0.iter_mut().zip(self.weight_m_s.0) {
            *velocity += weight.only(is_there);
        }
        if let Some([at_rest, in_motion]) = self.floor {
            let depth_m = node.half_m - node.position_m.0[2];
            let approach_m_s = node.growth_m_s - old_m_s.0[2];
            let pressed_n = constants.floor_n_m * depth_m + constants.floor_ns_m * approach_m_s;
            let normal_n = pressed_n.max(zero).only(zero.is_less(depth_m));
            node.floor_w += normal_n * node.growth_m_s;
            let normal_m_s = normal_n * constants.mobility_s_kg;
            free_m_s.0[2] += normal_m_s;
            // What rests has no horizontal speed at all: only what stopped here has that.
            let [x, y, _] = old_m_s.0;
            let rests = (x * x + y * y).is_at_most(zero);
            let [x, y, z] = free_m_s.0;
            let speed_m_s = (x * x + y * y).sqrt();
            let limit_m_s = normal_m_s * at_rest.where_or(rests, in_motion);
            let slides = limit_m_s.is_less(speed_m_s);
            let slowed_m_s = normal_m_s * in_motion;
            let kept = width.real(1.0) - slowed_m_s / speed_m_s.max(width.real(f64::MIN_POSITIVE));
            let kept = kept.max(zero).only(slides);
            free_m_s = Vec3([x * kept, y * kept, z]);
        }
        node.velocity_m_s = free_m_s;
    }

    /// The next rotation: q + ½Δt·ω·q, of length 1.
    #[inline(always)]
    fn turn(&self, node: &mut Node<W>) {
        let width = self.step_s.width;
        let [x, y, z] = node.spin_rad_s.times(self.step_s * 0.5).0;
        let [w, i, j, k] = node.rotation;
        let q = [
            w - (x * i + y * j + z * k),
            i + (x * w + y * k - z * j),
            j + (y * w + z * i - x * k),
            k + (z * w + x * j - y * i),
        ];
        let squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        let inverse = width.real(1.0) / squared.sqrt();
        node.rotation = q.map(|number| number * inverse);
        node.axes = axes(node.rotation);
    }

    /// The next length.
    #[inline(always)]
    fn grow(&self, node: &mut Node<W>, constants: &Constants<W>) {
        let Constants { rest_m, sine_m, cosine_m, .. } = *constants;
        let [sine, sine_s, cosine, cosine_s] = self.clock;
        node.half_m = rest_m + (sine_m * sine + cosine_m * cosine);
        node.growth_m_s = sine_m * sine_s + cosine_m * cosine_s;
    }
}

/// The columns of a rotation's matrix.
#[inline(always)]
fn axes<W: Width>([w, x, y, z]: [Real<W>; 4]) -> [Vec3<W>; 3] {
    let one = w.width.real(1.0);
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [
        Vec3([one - (yy + zz), xy + wz, xz - wy]),
        Vec3([xy - wz, one - (xx + zz), yz + wx]),
        Vec3([xz + wy, yz - wx, one - (xx + yy)]),
    ]
}
