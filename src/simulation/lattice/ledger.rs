//! What a lattice has: energy, momentum, and what it owes nobody.

use super::body::Corner;
use super::link;
use super::node::Node;
use super::world::{Joint, World};
use crate::simulation::failure::Failure;
use crate::simulation::lanes::width::{Alone, Width};
use nalgebra::Vector3;

/// Where energy is, in joules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// Of motion.
    pub kinetic_j: f64,
    /// In links and contacts.
    pub elastic_j: f64,
    /// In the weight, above z = 0.
    pub weight_j: f64,
    /// What muscles have put in since the start. Damping and friction only take.
    pub work_j: f64,
}

impl Energy {
    /// What there is.
    pub fn stored_j(&self) -> f64 {
        self.kinetic_j + self.elastic_j + self.weight_j
    }
}

impl<W: Width> World<W> {
    /// A voxel by its rank.
    fn voxel(&self, voxel: usize) -> Node<Alone> {
        let place = self.places[voxel];
        self.nodes[place.block].lane(place.lane)
    }

    fn voxels(&self) -> impl Iterator<Item = Node<Alone>> + '_ {
        (0..self.places.len()).map(|voxel| self.voxel(voxel))
    }

    /// Where a voxel is.
    pub fn corner(&self, voxel: usize) -> Corner {
        let node = self.voxel(voxel);
        Corner {
            position_m: node.position_m.alone(),
            axes: node.axes.map(|axis| axis.alone()),
            half_m: node.half_m.get(0),
        }
    }

    /// The centre of mass.
    pub fn centre_m(&self) -> Vector3<f64> {
        let sum: Vector3<f64> = self.voxels().map(|node| node.position_m.alone()).sum();
        sum / self.places.len().max(1) as f64
    }

    /// Momentum, and angular momentum about the origin.
    pub fn momenta(&self) -> [Vector3<f64>; 2] {
        let (mass_kg, inertia_kg_m2) = (self.body.mass_kg(), self.body.inertia_kg_m2());
        let mut sums = [Vector3::zeros(); 2];
        for node in self.voxels() {
            let momentum = node.velocity_m_s.alone() * mass_kg;
            sums[0] += momentum;
            sums[1] +=
                node.position_m.alone().cross(&momentum) + node.spin_rad_s.alone() * inertia_kg_m2;
        }
        sums
    }

    /// Where energy is.
    pub fn energy(&self) -> Energy {
        let (mass_kg, inertia_kg_m2) = (self.body.mass_kg(), self.body.inertia_kg_m2());
        let mut energy = Energy { kinetic_j: 0.0, elastic_j: 0.0, weight_j: 0.0, work_j: 0.0 };
        for (node, young_pa) in self.voxels().zip(&self.young_pa) {
            let position_m = node.position_m.alone();
            energy.kinetic_j += 0.5 * mass_kg * node.velocity_m_s.alone().norm_squared()
                + 0.5 * inertia_kg_m2 * node.spin_rad_s.alone().norm_squared();
            energy.weight_j -= mass_kg * self.surroundings.gravity_m_s2.dot(&position_m);
            if self.surroundings.floor.is_some() {
                let depth_m = (node.half_m.get(0) - position_m.z).max(0.0);
                energy.elastic_j += young_pa * self.body.edge_m * depth_m * depth_m;
            }
            energy.work_j += node.floor_w.get(0) * self.step_s;
        }
        for joint in &self.joints {
            let [first, second] = joint.voxels.map(|voxel| self.voxel(voxel));
            let (stiffness_n_m, muscle_w) = self.link(joint);
            let edge_m = self.body.edge_m;
            energy.elastic_j +=
                link::energy_j(joint.axis, stiffness_n_m, edge_m, [&first, &second]);
            energy.work_j += muscle_w * self.step_s;
        }
        energy.elastic_j += self.collisions.energy_j(|pair| self.overlap_m(pair));
        energy
    }

    /// The stiffness of a link, and the sum of its muscles' powers.
    fn link(&self, joint: &Joint) -> (f64, f64) {
        let list = if joint.is_seam { &self.seams } else { &self.links[joint.axis] };
        let link = &list[joint.block];
        (link.stiffness_n_m.get(joint.lane), link.muscle_w.get(joint.lane))
    }

    fn overlap_m(&self, pair: [usize; 2]) -> f64 {
        let [first, second] = pair.map(|voxel| self.voxel(voxel));
        let across_m = second.position_m.alone() - first.position_m.alone();
        first.half_m.get(0) + second.half_m.get(0) - across_m.norm()
    }

    /// How deep the deepest voxel is in the floor, as a share of half of its length; negative above it.
    pub fn depth(&self) -> f64 {
        let depth = |node: Node<Alone>| 1.0 - node.position_m.alone().z / node.half_m.get(0);
        self.voxels().map(depth).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Makes sure that everything is a number, and no voxel faster than it may be.
    pub fn check(&self, speed_max_m_s: f64) -> Result<(), Failure> {
        for node in self.voxels() {
            let rotation: f64 = node.rotation.iter().map(|number| number.get(0)).sum();
            let sum = node.position_m.alone().sum() + node.spin_rad_s.alone().sum() + rotation;
            let speed_m_s = node.velocity_m_s.alone().norm();
            if !sum.is_finite() || !speed_m_s.is_finite() {
                return Err(Failure::NotFinite);
            }
            if speed_m_s > speed_max_m_s {
                return Err(Failure::TooFast);
            }
        }
        Ok(())
    }
}
