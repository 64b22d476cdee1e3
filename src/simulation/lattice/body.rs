//! What a soft body is, and what is around it.

use nalgebra::Vector3;

/// The dimensionless damping of a link: 1 is critical (Cheney et al. 2013).
pub const LINK_DAMPING: f64 = 1.0;
/// The dimensionless damping of a contact (Cheney et al. 2013).
pub const CONTACT_DAMPING: f64 = 0.8;
/// The dimensionless damping of a motion through still air (Cheney et al. 2013).
pub const AIR_DAMPING: f64 = 0.01;

/// A cube of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Voxel {
    /// Young's modulus in pascals, above 0.
    pub young_pa: f64,
    /// Its length at rest, as a multiple of the lattice's edge.
    pub rest: f64,
    /// The share of its length by which a muscle grows and shrinks; 0 for what is no muscle.
    pub amplitude: f64,
    /// Where in its cycle a muscle begins, in radians.
    pub phase_rad: f64,
}

/// Voxels on a grid. Neighbours that share a face are joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Places along x, y and z.
    pub size: [usize; 3],
    /// What is in each place, x first, then y, then z.
    pub voxels: Vec<Option<Voxel>>,
    /// The edge of a voxel at rest, in metres.
    pub edge_m: f64,
    /// The same for all materials.
    pub density_kg_m3: f64,
    /// Cycles of the muscles a second.
    pub frequency_hz: f64,
    /// Dimensionless damping of the links: [`LINK_DAMPING`], or 0 for tests of conservation.
    pub link_damping: f64,
}

impl Body {
    /// The mass of a voxel, in kilograms.
    pub fn mass_kg(&self) -> f64 {
        self.density_kg_m3 * self.edge_m * self.edge_m * self.edge_m
    }

    /// The moment of inertia of a voxel, in kg·m².
    pub fn inertia_kg_m2(&self) -> f64 {
        self.mass_kg() * self.edge_m * self.edge_m / 6.0
    }

    /// The stiffest link's, in newtons a metre; 0 without a voxel.
    pub fn stiffness_max_n_m(&self) -> f64 {
        let young_pa = self.voxels.iter().flatten().map(|voxel| voxel.young_pa);
        young_pa.fold(0.0, f64::max) * self.edge_m
    }

    /// The longest step that holds, in seconds: damping, not frequency, bounds it.
    pub fn step_s(&self) -> f64 {
        let fastest_rad_s = (self.stiffness_max_n_m() / self.mass_kg()).sqrt();
        0.9 / (std::f64::consts::TAU * fastest_rad_s)
    }

    /// The index of a place.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Where a place is.
    pub fn place(&self, index: usize) -> [usize; 3] {
        let [x, y, _] = self.size;
        [index % x, index / x % y, index / (x * y)]
    }

    /// The middle of a place at rest, in metres, where the lowest voxels stand on z = 0.
    pub fn middle_m(&self, index: usize) -> Vector3<f64> {
        let lowest = self.voxels.iter().position(Option::is_some);
        let below = lowest.map_or(0, |index| self.place(index)[2]) as f64;
        let [x, y, z] = self.place(index).map(|place| place as f64 + 0.5);
        Vector3::new(x, y, z - below) * self.edge_m
    }
}

/// What is around a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// Which way things fall, in m/s². On a slope the floor stays level and the weight leans.
    pub gravity_m_s2: Vector3<f64>,
    /// The floor z = 0, if there is one.
    pub floor: Option<Floor>,
    /// The dimensionless damping of every motion: [`AIR_DAMPING`], or 0.
    pub air_damping: f64,
    /// Whether a body feels itself.
    pub self_collision: bool,
}

/// A floor with Coulomb's friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// What rests begins to slide if the horizontal force is more than this share of the normal force.
    pub static_friction: f64,
    /// The horizontal force on what slides, as a share of the normal force.
    pub kinetic_friction: f64,
}

impl Surroundings {
    /// No weight, no floor, no air.
    pub const VACUUM: Self = Self {
        gravity_m_s2: Vector3::new(0.0, 0.0, 0.0),
        floor: None,
        air_damping: 0.0,
        self_collision: false,
    };

    /// The ground of Cheney et al. 2013: µ 1 at rest and 0.5 in motion.
    pub const GROUND: Self = Self {
        gravity_m_s2: Vector3::new(0.0, 0.0, -9.81),
        floor: Some(Floor { static_friction: 1.0, kinetic_friction: 0.5 }),
        air_damping: AIR_DAMPING,
        self_collision: true,
    };
}

/// Where a voxel is and what it looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Its middle, in metres.
    pub position_m: Vector3<f64>,
    /// The directions of its edges.
    pub axes: [Vector3<f64>; 3],
    /// Half of its length, in metres.
    pub half_m: f64,
}
