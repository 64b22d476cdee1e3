//! A lattice in motion, so many voxels side by side as a width has.
//!
//! A row of voxels along x is cut into as many pieces as there are lanes: lane l of block g holds the voxel at
//! x = l·G + g, of G blocks. So neighbours along x are in the same lane of the next block, but for where two pieces meet
//! (a seam), and neighbours along y and z always are. Each voxel's forces are added up in one order, whatever the
//! width: first the two along x, whose order is indifferent as the sum begins at 0, then those along y, z, and contacts.

use super::body::{Body, Surroundings};
use super::collision::Collisions;
use super::link::{Bending, Link};
use super::motion::{Clock, Motion};
use super::node::{Constants, Load, Node, Place, shifted_back3};
use crate::simulation::lanes::Vec3;
use crate::simulation::lanes::width::{Width, Work};

/// A link between two voxels, and where it is kept.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// The axis along which it lies at rest.
    pub axis: usize,
    /// Its voxels.
    pub voxels: [usize; 2],
    /// The index of its block, in [`World::seams`] or the axis's list.
    pub block: usize,
    /// Its lane there.
    pub lane: usize,
    /// Whether it goes from one lane to the next.
    pub is_seam: bool,
}

/// A lattice.
pub struct World<W: Width> {
    width: W,
    /// What it is made of.
    pub body: Body,
    /// What is around it.
    pub surroundings: Surroundings,
    /// The length of a step in seconds.
    pub step_s: f64,
    /// Steps so far.
    pub steps: u64,
    /// The indices of the voxels in the body, ascending.
    pub indices: Vec<usize>,
    /// Where each voxel is kept.
    pub places: Vec<Place>,
    /// Each voxel's modulus, in pascals.
    pub young_pa: Vec<f64>,
    /// The links in the order of their first voxels.
    pub joints: Vec<Joint>,
    /// All blocks, of which some are empty.
    pub nodes: Vec<Node<W>>,
    constants: Vec<Constants<W>>,
    loads: Vec<Load<W>>,
    /// The blocks that are not empty.
    present: Vec<usize>,
    /// The links along each axis.
    pub links: [Vec<Link<W>>; 3],
    /// The links along x from one lane to the next.
    pub seams: Vec<Link<W>>,
    bending: Bending<W>,
    /// What may touch what.
    pub collisions: Collisions,
}

impl<W: Width> World<W> {
    /// A body at rest. Its steps last a share of what holds.
    pub fn new(width: W, body: Body, surroundings: Surroundings, share: f64) -> Self {
        let step_s = body.step_s() * share;
        let [along, rows, layers] = body.size;
        let blocks = along.div_ceil(W::LANES) * rows * layers;
        let indices: Vec<usize> =
            (0..body.voxels.len()).filter(|&index| body.voxels[index].is_some()).collect();
        let places: Vec<Place> = indices.iter().map(|&index| place::<W>(&body, index)).collect();
        let young_pa = body.voxels.iter().flatten().map(|voxel| voxel.young_pa).collect();
        let mut present: Vec<usize> = places.iter().map(|place| place.block).collect();
        present.sort_unstable();
        present.dedup();
        let mut world = Self {
            width,
            surroundings,
            step_s,
            steps: 0,
            indices,
            places,
            young_pa,
            joints: Vec::new(),
            nodes: vec![Node::nothing(width); blocks],
            constants: vec![Constants::nothing(width); blocks],
            loads: vec![Load::none(width); blocks],
            present,
            links: [Vec::new(), Vec::new(), Vec::new()],
            seams: Vec::new(),
            bending: Bending::new(width, body.edge_m),
            collisions: Collisions::default(),
            body,
        };
        world.put_voxels();
        world.join();
        if surroundings.self_collision {
            let links = world.joints.iter().map(|joint| joint.voxels);
            world.collisions = Collisions::new(world.places.len(), links);
        }
        world
    }

    fn put_voxels(&mut self) {
        for (&index, &Place { block, lane }) in self.indices.iter().zip(&self.places) {
            let Some(voxel) = &self.body.voxels[index] else { continue };
            let (body, surroundings) = (&self.body, &self.surroundings);
            self.constants[block].put(lane, voxel, body, surroundings, self.step_s);
            let node = &mut self.nodes[block];
            let middle_m = self.body.middle_m(index);
            node.half_m.set(lane, self.constants[block].rest_m.get(lane));
            node.growth_m_s.set(lane, 0.0);
            for (axis, coordinate) in node.position_m.0.iter_mut().enumerate() {
                coordinate.set(lane, middle_m[axis]);
            }
        }
    }

    fn join(&mut self) {
        for first in 0..self.indices.len() {
            let index = self.indices[first];
            let at = self.body.place(index);
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                if next[axis] == self.body.size[axis] {
                    continue;
                }
                // Voxels are sorted by their indices.
                if let Ok(second) = self.indices.binary_search(&self.body.index(next)) {
                    self.join_two(axis, [first, second]);
                }
            }
        }
    }

    fn join_two(&mut self, axis: usize, voxels: [usize; 2]) {
        let [from, to] = voxels.map(|voxel| self.places[voxel]);
        let is_seam = from.lane != to.lane;
        let list = if is_seam { &mut self.seams } else { &mut self.links[axis] };
        let known = list.iter().position(|link| (link.from, link.to) == (from.block, to.block));
        let block = known.unwrap_or_else(|| {
            list.push(Link::none(self.width, from.block, to.block));
            list.len() - 1
        });
        let young_pa = voxels.map(|voxel| self.young_pa[voxel]);
        list[block].put(from.lane, &self.body, young_pa);
        self.joints.push(Joint { axis, voxels, block, lane: from.lane, is_seam });
    }

    /// Moves everything by one step.
    pub fn step(&mut self) {
        self.width.with(Step(self));
    }

    #[inline(always)]
    fn step_side_by_side(&mut self) {
        self.pull();
        if self.surroundings.self_collision {
            self.collide();
        }
        self.steps += 1;
        self.advance();
    }

    /// Sums up what links do.
    #[inline(always)]
    fn pull(&mut self) {
        let Self { nodes, loads, links: [along_x, along_y, along_z], seams, bending, .. } = self;
        for link in along_x {
            let effect = link.effect::<0>(&nodes[link.from], &nodes[link.to], bending);
            effect.load_first(&mut loads[link.from]);
            effect.load_second(&mut loads[link.to]);
        }
        for link in seams {
            let mut effect =
                link.effect::<0>(&nodes[link.from], &nodes[link.to].shifted(), bending);
            effect.load_first(&mut loads[link.from]);
            effect.force_n = shifted_back3(&effect.force_n);
            effect.torques_nm[1] = shifted_back3(&effect.torques_nm[1]);
            effect.load_second(&mut loads[link.to]);
        }
        for link in along_y {
            let effect = link.effect::<1>(&nodes[link.from], &nodes[link.to], bending);
            effect.load_first(&mut loads[link.from]);
            effect.load_second(&mut loads[link.to]);
        }
        for link in along_z {
            let effect = link.effect::<2>(&nodes[link.from], &nodes[link.to], bending);
            effect.load_first(&mut loads[link.from]);
            effect.load_second(&mut loads[link.to]);
        }
    }

    fn collide(&mut self) {
        let Self { nodes, places, collisions, loads, body, young_pa, steps, .. } = self;
        let at = |voxel: usize| {
            let Place { block, lane } = places[voxel];
            nodes[block].position_m.lane(lane).alone()
        };
        collisions.look(*steps, body, young_pa, at);
        collisions.push(nodes, loads, places);
    }

    #[inline(always)]
    fn advance(&mut self) {
        let clock = Clock::at(self.time_s(), self.body.frequency_hz);
        let Surroundings { gravity_m_s2, floor, .. } = &self.surroundings;
        let motion = Motion::new(self.width, self.step_s, gravity_m_s2, *floor, clock);
        for &block in &self.present {
            let load = &mut self.loads[block];
            motion.advance(&mut self.nodes[block], &self.constants[block], load);
            *load = Load::none(self.width);
        }
    }

    /// The time since the start, in seconds.
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.step_s
    }

    /// Sets a voxel in motion, in m/s and rad/s.
    pub fn kick(&mut self, voxel: usize, velocity_m_s: [f64; 3], spin_rad_s: [f64; 3]) {
        let Place { block, lane } = self.places[voxel];
        let node = &mut self.nodes[block];
        set(&mut node.velocity_m_s, lane, velocity_m_s);
        set(&mut node.spin_rad_s, lane, spin_rad_s);
    }

    /// Nails a voxel to where it is.
    pub fn nail(&mut self, voxel: usize) {
        let Place { block, lane } = self.places[voxel];
        self.constants[block].mobility_s_kg.set(lane, 0.0);
        self.constants[block].turn_mobility.set(lane, 0.0);
    }
}

fn set<W: Width>(vector: &mut Vec3<W>, lane: usize, to: [f64; 3]) {
    for (coordinate, to) in vector.0.iter_mut().zip(to) {
        coordinate.set(lane, to);
    }
}

/// Where the voxel of a place is kept.
fn place<W: Width>(body: &Body, index: usize) -> Place {
    let [x, y, z] = body.place(index);
    let blocks = body.size[0].div_ceil(W::LANES);
    Place { block: (z * body.size[1] + y) * blocks + x % blocks, lane: x / blocks }
}

struct Step<'a, W: Width>(&'a mut World<W>);

impl<W: Width> Work for Step<'_, W> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.step_side_by_side();
    }
}
