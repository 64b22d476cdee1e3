//! Links: beams between neighbours that conserve momentum exactly and energy as far as steps allow.
//!
//! A link between voxels 1 and 2 along a lattice axis has the potential
//!
//! ```text
//! U = ½k(ℓ − r)² + b(5 − 3 e₁·c − 3 e₂·c + e₁·e₂) + ¼b(1 + e₁·e₂ − n₁·n₂ − p₁·p₂)
//! ```
//!
//! with ℓ the distance of their centres, c the unit vector from 1 to 2, r = half₁ + half₂ the rest length, and e, n, p
//! the link's axis and the two across it as each voxel has turned. k = EL for an edge L, E = 2E₁E₂/(E₁ + E₂), b = kL²/6.
//! For small angles the second term is that of an Euler–Bernoulli beam clamped to both voxels, b(w₁² + w₁·w₂ + w₂²)
//! with wᵢ = eᵢ × c, as Hiller & Lipson (*Dynamic Simulation of Soft Multimaterial 3D-Printed Objects*, 2014) join
//! voxels; the third is its torsion, ½·(b/2)·φ². Forces and torques are the gradients of U, which depends on nothing but
//! where the voxels are relative to each other: what a link does to its ends adds up to no force and no torque. Hiller &
//! Lipson's own equations do not have that property once muscles change r.
//!
//! Damping is Rayleigh's: along c with ζ√(km), across it in proportion to the rates of the same angles.

use super::body::Body;
use super::node::{Load, Node};
use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::lanes::{Everywhere, Real, Vec3};

/// A link in each lane.
#[derive(Clone, Copy)]
pub struct Link<W: Width> {
    /// The voxels that it goes from.
    pub from: usize,
    /// The voxels that it goes to.
    pub to: usize,
    /// In newtons a metre; 0 where there is no link.
    pub stiffness_n_m: Real<W>,
    /// In newton seconds a metre.
    pub damping_ns_m: Real<W>,
    /// The sum of the powers, step by step, with which muscles pulled, in watts.
    pub muscle_w: Real<W>,
}

/// What bending of a link has to do with pulling it: lengths squared, in m².
#[derive(Clone, Copy)]
pub struct Bending<W: Width> {
    /// L²/6: from the stiffness.
    pub elastic_m2: Real<W>,
    /// L²/12: from the damping.
    pub viscous_m2: Real<W>,
}

impl<W: Width> Bending<W> {
    /// Of a lattice's links.
    pub fn new(width: W, edge_m: f64) -> Self {
        let squared_m2 = edge_m * edge_m;
        Self { elastic_m2: width.real(squared_m2 / 6.0), viscous_m2: width.real(squared_m2 / 12.0) }
    }
}

/// What a link does to its ends: a force to the second and the opposite one to the first, and a torque to each.
pub struct Effect<W: Width> {
    /// On the second, in newtons.
    pub force_n: Vec3<W>,
    /// On each, in newton metres.
    pub torques_nm: [Vec3<W>; 2],
}

impl<W: Width> Link<W> {
    /// None between voxels.
    pub fn none(width: W, from: usize, to: usize) -> Self {
        let zero = width.real(0.0);
        Self { from, to, stiffness_n_m: zero, damping_ns_m: zero, muscle_w: zero }
    }

    /// Joins the voxels of one lane.
    pub fn put(&mut self, lane: usize, body: &Body, young_pa: [f64; 2]) {
        let [first_pa, second_pa] = young_pa;
        let stiffness_n_m = 2.0 * first_pa * second_pa / (first_pa + second_pa) * body.edge_m;
        let damping_ns_m = body.link_damping * (stiffness_n_m * body.mass_kg()).sqrt();
        self.stiffness_n_m.set(lane, stiffness_n_m);
        self.damping_ns_m.set(lane, damping_ns_m);
    }

    /// What it does to its ends; see the module. `AXIS` is the lattice's axis that it lies along.
    #[inline(always)]
    pub fn effect<const AXIS: usize>(
        &mut self,
        first: &Node<W>,
        second: &Node<W>,
        bending: &Bending<W>,
    ) -> Effect<W> {
        let width = self.stiffness_n_m.width;
        let across_m = second.position_m - first.position_m;
        // Where there is no link, there may be no distance.
        let length_m = across_m.norm_squared().max(width.real(f64::MIN_POSITIVE)).sqrt();
        let inverse_m = width.real(1.0) / length_m;
        let chord = across_m.times(inverse_m);
        let [along, normal, other] = [AXIS, (AXIS + 1) % 3, (AXIS + 2) % 3];

        let velocity_m_s = second.velocity_m_s - first.velocity_m_s;
        let growth_m_s = first.growth_m_s + second.growth_m_s;
        let stretch_m = length_m - (first.half_m + second.half_m);
        let stretching_m_s = chord.dot(&velocity_m_s) - growth_m_s;
        let tension_n = self.stiffness_n_m * stretch_m + self.damping_ns_m * stretching_m_s;
        self.muscle_w -= tension_n * growth_m_s;

        let elastic_nm = self.stiffness_n_m * bending.elastic_m2;
        let viscous_nms = self.damping_ns_m * bending.viscous_m2;
        let (e1, e2) = (first.axes[along], second.axes[along]);
        let turn_rad_s = chord.cross(&velocity_m_s).times(inverse_m);
        let spins_rad_s = first.spin_rad_s + second.spin_rad_s;
        let bending_rad_s = turn_rad_s * 2.0 - (spins_rad_s - chord.times(chord.dot(&spins_rad_s)));
        // Half of the torques' sum, and half of their difference.
        let both_nm = (e1 + e2).cross(&chord).times(elastic_nm * 1.5)
            + bending_rad_s.times(viscous_nms * 1.5);
        let parting = e1.cross(&e2) * 5.0
            - first.axes[normal].cross(&second.axes[normal])
            - first.axes[other].cross(&second.axes[other]);
        let apart_nm = (e1 - e2).cross(&chord).times(elastic_nm * 1.5)
            - parting.times(elastic_nm * 0.25)
            + (second.spin_rad_s - first.spin_rad_s).times(viscous_nms * 0.5);

        let shear_n = chord.cross(&both_nm).times(inverse_m * 2.0);
        Effect {
            force_n: shear_n - chord.times(tension_n),
            torques_nm: [both_nm + apart_nm, both_nm - apart_nm],
        }
    }
}

impl<W: Width> Effect<W> {
    /// On the first end.
    #[inline(always)]
    pub fn load_first(&self, load: &mut Load<W>) {
        load.force_n = load.force_n - self.force_n;
        load.torque_nm += self.torques_nm[0];
    }

    /// On the second end.
    #[inline(always)]
    pub fn load_second(&self, load: &mut Load<W>) {
        load.force_n += self.force_n;
        load.torque_nm += self.torques_nm[1];
    }
}

/// The potential of a link along an axis, in joules.
pub fn energy_j(
    axis: usize,
    stiffness_n_m: f64,
    edge_m: f64,
    [first, second]: [&Node<Alone>; 2],
) -> f64 {
    let [e, n, p] = [axis, (axis + 1) % 3, (axis + 2) % 3];
    let across_m = (second.position_m - first.position_m).alone();
    let length_m = across_m.norm();
    let chord = across_m / length_m;
    let axes = |axis: usize| (first.axes[axis].alone(), second.axes[axis].alone());
    let cosine = |axis: usize| axes(axis).0.dot(&axes(axis).1);
    let stretch_m = length_m - first.half_m.get(0) - second.half_m.get(0);
    let bend = 5.0 - 3.0 * (axes(e).0 + axes(e).1).dot(&chord) + cosine(e);
    let twist = 1.0 + cosine(e) - cosine(n) - cosine(p);
    let bending_nm = stiffness_n_m * edge_m * edge_m / 6.0;
    0.5 * stiffness_n_m * stretch_m * stretch_m + bending_nm * (bend + 0.25 * twist)
}
