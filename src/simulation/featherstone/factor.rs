//! The mass matrix, factorised along the tree, and what the factor does.
//!
//! The articulated-body recursion (Featherstone 2008, section 7.3) is a factorisation M = LᵀL of the joint-space
//! mass matrix, with L lower triangular and as sparse as the tree (section 6.5, branch-induced sparsity; that the
//! two are one: Rodriguez, Jain and Kreutz-Delgado 1992, the innovations factorisation). Row i of L is known by two
//! things of link i alone, √D and the wrench U/√D, so that neither M nor L is ever formed, and a product with L⁻¹ or
//! L⁻ᵀ is a walk along the tree.
//!
//! A hinge whose speed is given has no row: it is a rigid connection that moves (section 9.2, hybrid dynamics).
//!
//! *Whitened* is said of velocities z = L q̇: in them kinetic energy is |z|²/2, an impulse with the Jacobian J changes
//! them by y = L⁻ᵀJᵀ, and all masses are one.
//!
//! A hinge may be held in some worlds and loose in others. Where it is held it lets nothing through: its part of the
//! factor is zero there.

use super::kinematics::Place;
use super::model::Model;
use super::spatial::{Inertia, Spatial};
use crate::simulation::lanes::width::Width;
use crate::simulation::lanes::{Everywhere, Mask, Real};

/// The factor of one moment.
#[derive(Clone)]
pub struct Factor<W: Width> {
    /// What each link contributes.
    links: Vec<FactorLink<W>>,
    /// The root's block: its articulated inertia is CCᵀ, and this is C with the inverse of its diagonal.
    root: [[Real<W>; 6]; 6],
}

#[derive(Clone)]
struct FactorLink<W: Width> {
    parent: usize,
    axis: Spatial<W>,
    /// The articulated inertia of the link and all that hangs on it.
    inertia: Inertia<W>,
    /// The wrench that accelerates it.
    wrench: Spatial<W>,
    /// Whether the hinge's speed is given.
    is_held: Mask<W>,
    /// U/√D, with U = inertia · axis and D = axis · U.
    unit_wrench: Spatial<W>,
    /// 1/√D.
    scale: Real<W>,
    /// The nearest link with a hinge that is loose in any world from this one on towards the root; 0 if there is none.
    loose: usize,
}

/// What the motion of a hinge's axis does to the hinge.
#[derive(Clone, Copy)]
pub struct Swing<W: Width> {
    /// The impulse, in newton metre seconds.
    pub impulse_nms: Real<W>,
    /// The most that it may change the hinge's rate by, in rad/s.
    pub change_rad_s_max: Real<W>,
}

impl<W: Width> Swing<W> {
    /// Nothing.
    pub fn none(width: W) -> Self {
        Self { impulse_nms: width.real(0.0), change_rad_s_max: width.real(0.0) }
    }
}

/// Whitened velocities of a body.
#[derive(Clone)]
pub struct Whitened<W: Width> {
    /// The root's six.
    pub root: [Real<W>; 6],
    /// One for each link; only those of loose hinges count.
    pub hinges: Vec<Real<W>>,
}

impl<W: Width> Factor<W> {
    /// A factor of nothing yet.
    pub fn new(width: W, model: &Model) -> Self {
        let link = |link: &super::model::Link| FactorLink {
            parent: link.parent,
            axis: Spatial::zero(width),
            inertia: Inertia::zero(width),
            wrench: Spatial::zero(width),
            is_held: width.mask(false),
            unit_wrench: Spatial::zero(width),
            scale: width.real(0.0),
            loose: 0,
        };
        Self { links: model.links.iter().map(link).collect(), root: [[width.real(0.0); 6]; 6] }
    }

    /// Factorises the mass matrix of a body, given which hinges are held.
    #[inline(always)]
    pub fn factorise(&mut self, places: &[Place<W>], is_held: &[Mask<W>]) {
        for ((link, place), is_held) in self.links.iter_mut().zip(places).zip(is_held) {
            link.axis = place.axis;
            link.inertia = place.inertia.spread();
            link.is_held = *is_held;
        }
        for index in (1..self.links.len()).rev() {
            let (inner, outer) = self.links.split_at_mut(index);
            let link = &mut outer[0];
            let parent = &mut inner[link.parent];
            parent.inertia.add(&link.inertia);
            if !link.is_held.all() {
                link.open_hinge();
                parent.inertia.subtract_square(&link.unit_wrench);
            }
        }
        for index in 1..self.links.len() {
            let link = &self.links[index];
            self.links[index].loose =
                if link.is_held.all() { self.links[link.parent].loose } else { index };
        }
        self.root = cholesky(&self.links[0].inertia);
    }

    /// L⁻ᵀ of the generalised impulses: those that wrenches (or momenta) of the links make, plus what each
    /// loose hinge's own axis adds. Held hinges turn at their rates.
    #[inline(always)]
    pub fn whiten(
        &mut self,
        wrenches: &[Spatial<W>],
        swings: &mut [Swing<W>],
        rates: &[Real<W>],
        to: &mut Whitened<W>,
    ) {
        for (link, wrench) in self.links.iter_mut().zip(wrenches) {
            link.wrench = *wrench;
        }
        for index in (1..self.links.len()).rev() {
            let (inner, outer) = self.links.split_at_mut(index);
            let link = &outer[0];
            let mut rest = Spatial::zero(link.scale.width);
            if link.is_held.any() {
                rest = link.inertia.times(&(link.axis * rates[index]));
            }
            if !link.is_held.all() {
                let swing = &mut swings[index];
                swing.impulse_nms = swing.impulse_nms.where_or(link.is_held, link.bounded(swing));
                let whitened = (link.axis.dot(&link.wrench) + swing.impulse_nms) * link.scale;
                to.hinges[index] = whitened;
                let loose = link.unit_wrench * whitened;
                for (rest, loose) in rest.0.iter_mut().zip(loose.0) {
                    *rest = rest.where_or(link.is_held, loose);
                }
            }
            inner[link.parent].wrench += link.wrench - rest;
        }
        let [a, b, c, x, y, z] = self.links[0].wrench.0;
        to.root = self.forward_substitute([[a], [b], [c], [x], [y], [z]]).map(|[y]| y);
    }

    /// L⁻¹ of whitened velocities: the rate of every loose hinge, and the velocity of every link.
    #[inline(always)]
    pub fn unwhiten(
        &self,
        whitened: &Whitened<W>,
        rates: &mut [Real<W>],
        velocities: &mut [Spatial<W>],
    ) {
        velocities[0] = self.back_substitute(&whitened.root);
        for (index, link) in self.links.iter().enumerate().skip(1) {
            let parent = velocities[link.parent];
            if !link.is_held.all() {
                let slack = whitened.hinges[index] - link.unit_wrench.dot(&parent);
                rates[index] = rates[index].where_or(link.is_held, slack * link.scale);
            }
            velocities[index] = parent + link.axis * rates[index];
        }
    }

    /// Walks from a link to the root with some wrenches on it: hands out y = L⁻ᵀJᵀ at every loose hinge on the way and
    /// returns the root's six.
    #[inline(always)]
    pub fn whiten_wrenches<const M: usize>(
        &self,
        link: usize,
        mut wrenches: [[Real<W>; M]; 6],
        mut hand_out: impl FnMut(usize, [Real<W>; M]),
    ) -> [[Real<W>; M]; 6] {
        let mut index = self.links[link].loose;
        while index != 0 {
            let link = &self.links[index];
            let mut whitened = [link.scale.width.real(0.0); M];
            for (row, axis) in wrenches.iter().zip(link.axis.0) {
                for (sum, wrench) in whitened.iter_mut().zip(row) {
                    *sum += *wrench * axis;
                }
            }
            for y in &mut whitened {
                *y = *y * link.scale;
            }
            for (row, unit) in wrenches.iter_mut().zip(link.unit_wrench.0) {
                for (wrench, y) in row.iter_mut().zip(whitened) {
                    *wrench -= y * unit;
                }
            }
            hand_out(index, whitened);
            index = self.links[link.parent].loose;
        }
        self.forward_substitute(wrenches)
    }

    /// The whitened row of a loose hinge itself, as [`Factor::whiten_wrenches`] gives those of wrenches.
    #[inline(always)]
    pub fn whiten_hinge(
        &self,
        hinge: usize,
        mut hand_out: impl FnMut(usize, [Real<W>; 1]),
    ) -> [[Real<W>; 1]; 6] {
        let link = &self.links[hinge];
        hand_out(hinge, [link.scale]);
        let wrench = link.unit_wrench * -link.scale;
        let [a, b, c, x, y, z] = wrench.0;
        self.whiten_wrenches(link.parent, [[a], [b], [c], [x], [y], [z]], hand_out)
    }

    /// C⁻¹ of the root's part of several.
    #[inline(always)]
    fn forward_substitute<const M: usize>(
        &self,
        mut solved: [[Real<W>; M]; 6],
    ) -> [[Real<W>; M]; 6] {
        for (row, lower) in self.root.iter().enumerate() {
            let (known, rest) = solved.split_at_mut(row);
            for (known, lower) in known.iter().zip(lower) {
                for (right, known) in rest[0].iter_mut().zip(known) {
                    *right -= *known * *lower;
                }
            }
            for right in &mut rest[0] {
                *right = *right * lower[row];
            }
        }
        solved
    }

    /// C⁻ᵀ of the root's part.
    #[inline(always)]
    fn back_substitute(&self, right: &[Real<W>; 6]) -> Spatial<W> {
        let mut solved = *right;
        for row in (0..6).rev() {
            for below in row + 1..6 {
                let known = self.root[below][row] * solved[below];
                solved[row] -= known;
            }
            solved[row] = solved[row] * self.root[row][row];
        }
        Spatial(solved)
    }
}

impl<W: Width> FactorLink<W> {
    /// Finds what the hinge lets through. One that nothing hangs on, or so little that rounding leaves nothing of
    /// it, cannot be told from a rigid connection.
    #[inline(always)]
    fn open_hinge(&mut self) {
        let wrench = self.inertia.times(&self.axis);
        let pivot = self.axis.dot(&wrench);
        let is_loose = !self.is_held;
        self.scale = pivot.inverse_root().only(is_loose);
        self.unit_wrench = wrench * self.scale;
        for part in &mut self.unit_wrench.0 {
            *part = part.only(is_loose);
        }
    }

    /// The impulse of a swing, so far as it may change the hinge's rate.
    #[inline(always)]
    fn bounded(&self, swing: &Swing<W>) -> Real<W> {
        let bound = swing.change_rad_s_max * (self.scale * self.scale).inverse();
        // Unlike clamp this needs no bound to be a number.
        bound.min((-bound).max(swing.impulse_nms))
    }
}

/// The lower triangular C with CCᵀ = A, and on its diagonal the inverses.
#[inline(always)]
fn cholesky<W: Width>(matrix: &Inertia<W>) -> [[Real<W>; 6]; 6] {
    let none = matrix.at(0, 0).width.real(0.0);
    let mut lower = [[none; 6]; 6];
    for row in 0..6 {
        for column in 0..=row {
            let mut products = none;
            for (a, b) in lower[row].iter().zip(&lower[column]).take(column) {
                products += *a * *b;
            }
            let rest = matrix.at(row, column) - products;
            lower[row][column] =
                if row == column { rest.inverse_root() } else { rest * lower[column][column] };
        }
    }
    lower
}
