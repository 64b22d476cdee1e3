//! Self-collision: voxels that are not neighbours push each other apart where they overlap.
//!
//! Two voxels touch as spheres as wide as they are long, with the stiffness of a contact with the floor and the damping
//! of a link. Pairs that may touch soon are listed anew when the body has changed its shape; most steps only look
//! through that list.

use super::body::{Body, CONTACT_DAMPING};
use super::node::{Load, Node, Place};
use crate::simulation::lanes::width::Width;
use nalgebra::Vector3;

/// Steps between two looks at how much a body has changed its shape.
const LOOK_STEPS: u64 = 16;
/// Pairs are listed that are closer than so many edges.
const NEAR: f64 = 1.7;
/// A list is made anew when a voxel has moved by so many edges among the others.
const STALE: f64 = 0.2;
/// Voxels that so few links join keep each other apart anyway.
const KIN: usize = 3;

/// What may touch what.
#[derive(Debug, Clone, Default)]
pub struct Collisions {
    /// Voxels that have an open side.
    surface: Vec<usize>,
    /// The voxels that [`KIN`] links or fewer lead to from each one, ascending.
    kin: Vec<Vec<usize>>,
    /// Where each voxel was when the list was made, seen from the first one.
    listed_m: Vec<Vector3<f64>>,
    near: Vec<Pair>,
}

/// Two voxels that may touch.
#[derive(Debug, Clone, Copy)]
struct Pair {
    voxels: [usize; 2],
    stiffness_n_m: f64,
    damping_ns_m: f64,
}

impl Collisions {
    /// Of so many voxels and the pairs of them that links join.
    pub fn new(voxels: usize, links: impl Iterator<Item = [usize; 2]>) -> Self {
        let mut neighbours = vec![Vec::new(); voxels];
        for [a, b] in links {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        let surface = (0..voxels).filter(|&voxel| neighbours[voxel].len() < 6).collect();
        let kin = (0..voxels).map(|voxel| kin(&neighbours, voxel)).collect();
        Self { surface, kin, listed_m: Vec::new(), near: Vec::new() }
    }

    /// Makes a new list where the old one is stale.
    pub fn look(
        &mut self,
        step: u64,
        body: &Body,
        young_pa: &[f64],
        at: impl Fn(usize) -> Vector3<f64>,
    ) {
        let Some(&first) = self.surface.first().filter(|_| step.is_multiple_of(LOOK_STEPS)) else {
            return;
        };
        let origin_m = at(first);
        let now_m: Vec<_> = self.surface.iter().map(|&voxel| at(voxel) - origin_m).collect();
        let allowed_m = STALE * body.edge_m;
        let moved = |(now, then): (&Vector3<f64>, &Vector3<f64>)| {
            (now - then).norm_squared() > allowed_m * allowed_m
        };
        if self.listed_m.len() == now_m.len() && !now_m.iter().zip(&self.listed_m).any(moved) {
            return;
        }
        self.list(body, young_pa, &now_m);
        self.listed_m = now_m;
    }

    fn list(&mut self, body: &Body, young_pa: &[f64], places_m: &[Vector3<f64>]) {
        let near_m = NEAR * body.edge_m;
        self.near.clear();
        for (i, &first) in self.surface.iter().enumerate() {
            for (j, &second) in self.surface.iter().enumerate().skip(i + 1) {
                let is_near = (places_m[j] - places_m[i]).norm_squared() < near_m * near_m;
                if is_near && self.kin[first].binary_search(&second).is_err() {
                    let stiffness_n_m = young_pa[first].min(young_pa[second]) * body.edge_m;
                    let damping_ns_m = CONTACT_DAMPING * (stiffness_n_m * body.mass_kg()).sqrt();
                    self.near.push(Pair { voxels: [first, second], stiffness_n_m, damping_ns_m });
                }
            }
        }
    }

    /// Pushes apart what overlaps.
    pub fn push<W: Width>(&self, nodes: &[Node<W>], loads: &mut [Load<W>], places: &[Place]) {
        for pair in &self.near {
            let [a, b] = pair.voxels.map(|voxel| places[voxel]);
            let (first, second) = (&nodes[a.block], &nodes[b.block]);
            let position = |node: &Node<W>, place: Place| node.position_m.lane(place.lane).alone();
            let velocity =
                |node: &Node<W>, place: Place| node.velocity_m_s.lane(place.lane).alone();
            let across_m = position(second, b) - position(first, a);
            let reach_m = first.half_m.get(a.lane) + second.half_m.get(b.lane);
            let squared_m2 = across_m.norm_squared();
            if squared_m2 >= reach_m * reach_m || squared_m2 <= f64::MIN_POSITIVE {
                continue;
            }
            let length_m = squared_m2.sqrt();
            let normal = across_m / length_m;
            let parting_m_s = (velocity(second, b) - velocity(first, a)).dot(&normal);
            let push_n =
                pair.stiffness_n_m * (reach_m - length_m) - pair.damping_ns_m * parting_m_s;
            let force_n = normal * push_n.max(0.0);
            load(&mut loads[a.block], a.lane, -force_n);
            load(&mut loads[b.block], b.lane, force_n);
        }
    }

    /// The potential of all overlaps, in joules; an overlap is measured by a function of two voxels, in metres.
    pub fn energy_j(&self, overlap_m: impl Fn([usize; 2]) -> f64) -> f64 {
        let energy = |pair: &Pair| {
            let overlap_m = overlap_m(pair.voxels).max(0.0);
            0.5 * pair.stiffness_n_m * overlap_m * overlap_m
        };
        self.near.iter().map(energy).sum()
    }
}

fn load<W: Width>(load: &mut Load<W>, lane: usize, force_n: Vector3<f64>) {
    for (sum, more) in load.force_n.0.iter_mut().zip([force_n.x, force_n.y, force_n.z]) {
        sum.set(lane, sum.get(lane) + more);
    }
}

/// The voxels that [`KIN`] links or fewer lead to, ascending.
fn kin(neighbours: &[Vec<usize>], voxel: usize) -> Vec<usize> {
    let mut kin = vec![voxel];
    let mut done = 0;
    for _ in 0..KIN {
        let reached = kin.len();
        for at in done..reached {
            for &next in &neighbours[kin[at]] {
                if !kin.contains(&next) {
                    kin.push(next);
                }
            }
        }
        done = reached;
    }
    kin.sort_unstable();
    kin
}
