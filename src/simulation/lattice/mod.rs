//! Soft bodies: a lattice of voxels that beams join, and trusses of bars.
//!
//! A [`Lattice`] is a [`Body`] of [`Voxel`]s in some [`Surroundings`], stepped explicitly. Voxels are masses with six
//! degrees of freedom (`node`); `link` joins neighbours by beams whose forces are the gradient of a potential, after
//! Hiller & Lipson (*Dynamic Simulation of Soft Multimaterial 3D-Printed Objects*, Soft Robotics 1, 2014), but
//! conserving momentum; `motion` adds weight, the floor and the muscles' clock; `collision` keeps a body from passing
//! through itself; `world` does it for as many voxels at a time as the processor has lanes for, with the same bits at
//! every width; `ledger` adds up energy and momentum.
//!
//! Only + − × ÷ √ are used in a step, and the libm sine of one clock: a trial has the same bits on every machine.

mod body;
mod collision;
mod ledger;
mod link;
mod motion;
mod node;
#[cfg(test)]
mod tests;
mod world;

pub use body::{
    AIR_DAMPING, Body, CONTACT_DAMPING, Corner, Floor, LINK_DAMPING, Surroundings, Voxel,
};
pub use ledger::Energy;

use super::lanes::width::{Alone, Avx2, Pair, avx2, pair};
use crate::simulation::failure::Failure;
use nalgebra::Vector3;
use world::World;

/// A lattice in motion.
pub enum Lattice {
    /// One voxel at a time.
    One(Box<World<Alone>>),
    /// Two at a time.
    Two(Box<World<Pair>>),
    /// Four at a time.
    Four(Box<World<Avx2>>),
}

/// How many voxels go side by side; it changes no bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breadth {
    /// What the processor is fastest with.
    Best,
    /// As many as given, or as the processor has of that.
    AtMost(usize),
}

macro_rules! every_width {
    ($lattice:expr, $world:ident => $work:expr) => {
        match $lattice {
            Lattice::One($world) => $work,
            Lattice::Two($world) => $work,
            Lattice::Four($world) => $work,
        }
    };
}

impl Lattice {
    /// A body at rest, whose steps last a share of what holds: 1, or ½ for a judge.
    pub fn new(body: Body, surroundings: Surroundings, share: f64) -> Self {
        Self::with(Breadth::Best, body, surroundings, share)
    }

    /// The same, so many voxels side by side.
    pub fn with(breadth: Breadth, body: Body, surroundings: Surroundings, share: f64) -> Self {
        let lanes_max = match breadth {
            Breadth::Best => 4,
            Breadth::AtMost(lanes) => lanes,
        };
        if let Some(four) = avx2().filter(|_| lanes_max >= 4) {
            return Self::Four(Box::new(World::new(four, body, surroundings, share)));
        }
        if let Some(two) = pair().filter(|_| lanes_max >= 2) {
            return Self::Two(Box::new(World::new(two, body, surroundings, share)));
        }
        Self::One(Box::new(World::new(Alone, body, surroundings, share)))
    }

    /// Moves everything by one step.
    pub fn step(&mut self) {
        every_width!(self, world => world.step());
    }

    /// The length of a step in seconds.
    pub fn step_s(&self) -> f64 {
        every_width!(self, world => world.step_s)
    }

    /// The time since the start, in seconds.
    pub fn time_s(&self) -> f64 {
        every_width!(self, world => world.time_s())
    }

    /// How many voxels there are.
    pub fn len(&self) -> usize {
        every_width!(self, world => world.places.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where a voxel is, by its rank among the body's.
    pub fn corner(&self, voxel: usize) -> Corner {
        every_width!(self, world => world.corner(voxel))
    }

    /// The centre of mass, in metres.
    pub fn centre_m(&self) -> Vector3<f64> {
        every_width!(self, world => world.centre_m())
    }

    /// The momentum in kg·m/s, and the angular momentum about the origin in kg·m²/s.
    pub fn momenta(&self) -> [Vector3<f64>; 2] {
        every_width!(self, world => world.momenta())
    }

    /// Where its energy is, and what muscles have put into it.
    pub fn energy(&self) -> Energy {
        every_width!(self, world => world.energy())
    }

    /// How deep the deepest voxel is in the floor, as a share of half of its length.
    pub fn depth(&self) -> f64 {
        every_width!(self, world => world.depth())
    }

    /// Makes sure that all is as physics has it.
    ///
    /// # Errors
    /// If something is no number, or a voxel is faster than so many metres a second.
    pub fn check(&self, speed_max_m_s: f64) -> Result<(), Failure> {
        every_width!(self, world => world.check(speed_max_m_s))
    }

    /// Sets a voxel in motion, in m/s and rad/s.
    pub fn kick(&mut self, voxel: usize, velocity_m_s: [f64; 3], spin_rad_s: [f64; 3]) {
        every_width!(self, world => world.kick(voxel, velocity_m_s, spin_rad_s));
    }

    /// Nails a voxel to where it is.
    pub fn nail(&mut self, voxel: usize) {
        every_width!(self, world => world.nail(voxel));
    }
}
