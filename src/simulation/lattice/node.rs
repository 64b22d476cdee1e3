//! Voxels as they move: masses with six degrees of freedom.

use super::body::{Body, CONTACT_DAMPING, Surroundings, Voxel};
use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::lanes::{Everywhere, Real, Vec3};

/// Where a voxel is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The index of its block.
    pub block: usize,
    /// Its lane there.
    pub lane: usize,
}

/// A voxel in each lane.
#[derive(Clone, Copy)]
pub struct Node<W: Width> {
    /// In metres.
    pub position_m: Vec3<W>,
    /// In metres a second.
    pub velocity_m_s: Vec3<W>,
    /// In radians a second, along the world's axes.
    pub spin_rad_s: Vec3<W>,
    /// The unit quaternion w, x, y, z.
    pub rotation: [Real<W>; 4],
    /// The lattice's axes x, y, z as the voxel has turned.
    pub axes: [Vec3<W>; 3],
    /// Half of its length now, in metres.
    pub half_m: Real<W>,
    /// How fast that grows, in metres a second.
    pub growth_m_s: Real<W>,
    /// The sum of the powers, step by step, with which it grew against the floor, in watts.
    pub floor_w: Real<W>,
}

/// What pulls and turns a voxel.
#[derive(Clone, Copy)]
pub struct Load<W: Width> {
    /// In newtons.
    pub force_n: Vec3<W>,
    /// In newton metres.
    pub torque_nm: Vec3<W>,
}

/// What of a voxel stays the same.
#[derive(Clone, Copy)]
pub struct Constants<W: Width> {
    /// The step over the mass, in s/kg; 0 where there is no voxel.
    pub mobility_s_kg: Real<W>,
    /// The step over the moment of inertia; 0 where there is no voxel.
    pub turn_mobility: Real<W>,
    /// Half of the length at rest, in metres.
    pub rest_m: Real<W>,
    /// How much half of the length changes with the sine of the muscles' clock, in metres.
    pub sine_m: Real<W>,
    /// The same with its cosine.
    pub cosine_m: Real<W>,
    /// Of the contact with the floor, in newtons a metre.
    pub floor_n_m: Real<W>,
    /// Of the contact with the floor, in newton seconds a metre.
    pub floor_ns_m: Real<W>,
    /// Of the air, in newton seconds a metre.
    pub air_ns_m: Real<W>,
}

impl<W: Width> Node<W> {
    /// Nothing, at the origin.
    pub fn nothing(width: W) -> Self {
        let (zero, one) = (width.real(0.0), width.real(1.0));
        let zeros = Vec3([zero; 3]);
        Self {
            position_m: zeros,
            velocity_m_s: zeros,
            spin_rad_s: zeros,
            rotation: [one, zero, zero, zero],
            axes: [Vec3([one, zero, zero]), Vec3([zero, one, zero]), Vec3([zero, zero, one])],
            half_m: zero,
            growth_m_s: zero,
            floor_w: zero,
        }
    }

    /// The voxels of the next lane each, and what is in the first one in the last.
    #[inline(always)]
    pub fn shifted(&self) -> Self {
        Self {
            position_m: shifted3(&self.position_m),
            velocity_m_s: shifted3(&self.velocity_m_s),
            spin_rad_s: shifted3(&self.spin_rad_s),
            axes: [shifted3(&self.axes[0]), shifted3(&self.axes[1]), shifted3(&self.axes[2])],
            half_m: shifted(self.half_m),
            growth_m_s: shifted(self.growth_m_s),
            ..*self
        }
    }

    /// The voxel in one lane.
    pub fn lane(&self, lane: usize) -> Node<Alone> {
        let alone = |number: Real<W>| Alone.real(number.get(lane));
        Node {
            position_m: self.position_m.lane(lane),
            velocity_m_s: self.velocity_m_s.lane(lane),
            spin_rad_s: self.spin_rad_s.lane(lane),
            rotation: self.rotation.map(alone),
            axes: self.axes.map(|axis| axis.lane(lane)),
            half_m: alone(self.half_m),
            growth_m_s: alone(self.growth_m_s),
            floor_w: alone(self.floor_w),
        }
    }
}

/// The numbers of the next lane each.
#[inline(always)]
pub fn shifted<W: Width>(numbers: Real<W>) -> Real<W> {
    let mut all = numbers;
    for lane in 0..W::LANES {
        all.set(lane, numbers.get((lane + 1) % W::LANES));
    }
    all
}

/// The vectors of the next lane each.
#[inline(always)]
pub fn shifted3<W: Width>(vectors: &Vec3<W>) -> Vec3<W> {
    let [x, y, z] = vectors.0;
    Vec3([shifted(x), shifted(y), shifted(z)])
}

/// The numbers of the lane before each: what [`shifted3`] undoes.
#[inline(always)]
pub fn shifted_back3<W: Width>(vectors: &Vec3<W>) -> Vec3<W> {
    let back = |numbers: Real<W>| {
        let mut all = numbers;
        for lane in 0..W::LANES {
            all.set((lane + 1) % W::LANES, numbers.get(lane));
        }
        all
    };
    let [x, y, z] = vectors.0;
    Vec3([back(x), back(y), back(z)])
}

impl<W: Width> Load<W> {
    /// None.
    #[inline(always)]
    pub fn none(width: W) -> Self {
        let zeros = Vec3([width.real(0.0); 3]);
        Self { force_n: zeros, torque_nm: zeros }
    }
}

impl<W: Width> Constants<W> {
    /// Of no voxel.
    pub fn nothing(width: W) -> Self {
        let zero = width.real(0.0);
        Self {
            mobility_s_kg: zero,
            turn_mobility: zero,
            rest_m: zero,
            sine_m: zero,
            cosine_m: zero,
            floor_n_m: zero,
            floor_ns_m: zero,
            air_ns_m: zero,
        }
    }

    /// Sets those of a voxel.
    pub fn put(
        &mut self,
        lane: usize,
        voxel: &Voxel,
        body: &Body,
        surroundings: &Surroundings,
        step_s: f64,
    ) {
        let (mass_kg, stiffness_n_m) = (body.mass_kg(), voxel.young_pa * body.edge_m);
        let critical_ns_m = 2.0 * (mass_kg * stiffness_n_m).sqrt();
        let rest_m = 0.5 * body.edge_m * voxel.rest;
        let swing_m = rest_m * voxel.amplitude;
        self.mobility_s_kg.set(lane, step_s / mass_kg);
        self.turn_mobility.set(lane, step_s / body.inertia_kg_m2());
        self.rest_m.set(lane, rest_m);
        self.sine_m.set(lane, swing_m * libm::cos(voxel.phase_rad));
        self.cosine_m.set(lane, swing_m * libm::sin(voxel.phase_rad));
        self.floor_n_m.set(lane, 2.0 * stiffness_n_m);
        self.floor_ns_m.set(lane, CONTACT_DAMPING * critical_ns_m);
        self.air_ns_m.set(lane, surroundings.air_damping * critical_ns_m);
    }
}
