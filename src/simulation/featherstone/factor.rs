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

use super::Swing;
use super::kinematics::Place;
use super::model::Model;
use super::spatial::{Inertia, Spatial};

/// The factor of one moment.
#[derive(Debug, Clone)]
pub struct Factor {
    /// What each link contributes.
    links: Vec<FactorLink>,
    /// The root's block: its articulated inertia is CCᵀ, and this is C with the inverse of its diagonal.
    root: [[f64; 6]; 6],
}

#[derive(Debug, Clone)]
struct FactorLink {
    parent: usize,
    axis: Spatial,
    /// The articulated inertia of the link and all that hangs on it.
    inertia: Inertia,
    /// The wrench that accelerates it.
    wrench: Spatial,
    /// Whether the hinge's speed is given.
    is_held: bool,
    /// U/√D, with U = inertia · axis and D = axis · U.
    unit_wrench: Spatial,
    /// 1/√D.
    scale: f64,
    /// The nearest link with a loose hinge from this one on towards the root; 0 if there is none.
    loose: usize,
}

/// Whitened velocities of a body.
#[derive(Debug, Clone)]
pub struct Whitened {
    /// The root's six.
    pub root: [f64; 6],
    /// One for each link; only those of loose hinges count.
    pub hinges: Vec<f64>,
}

impl Factor {
    /// A factor of nothing yet.
    pub fn new(model: &Model) -> Self {
        let link = |link: &super::model::Link| FactorLink {
            parent: link.parent,
            axis: Spatial::ZERO,
            inertia: Inertia::ZERO,
            wrench: Spatial::ZERO,
            is_held: false,
            unit_wrench: Spatial::ZERO,
            scale: 0.0,
            loose: 0,
        };
        Self { links: model.links.iter().map(link).collect(), root: [[0.0; 6]; 6] }
    }

    /// Factorises the mass matrix of a body, given which hinges are held.
    pub fn factorise(&mut self, places: &[Place], is_held: &[bool]) {
        for ((link, place), is_held) in self.links.iter_mut().zip(places).zip(is_held) {
            link.axis = place.axis;
            link.inertia = place.inertia.spread();
            link.is_held = *is_held;
        }
        for index in (1..self.links.len()).rev() {
            let (inner, outer) = self.links.split_at_mut(index);
            let link = &mut outer[0];
            let parent = &mut inner[link.parent];
            link.open_hinge();
            parent.inertia.add(&link.inertia);
            if !link.is_held {
                parent.inertia.subtract_square(&link.unit_wrench);
            }
        }
        for index in 1..self.links.len() {
            let link = &self.links[index];
            self.links[index].loose =
                if link.is_held { self.links[link.parent].loose } else { index };
        }
        self.root = cholesky(&self.links[0].inertia);
    }

    /// L⁻ᵀ of the generalised impulses: those that wrenches (or momenta) of the links make, plus what each
    /// loose hinge's own axis adds. Held hinges turn at their rates.
    pub fn whiten(
        &mut self,
        wrenches: &[Spatial],
        swings: &mut [Swing],
        rates: &[f64],
        to: &mut Whitened,
    ) {
        for (link, wrench) in self.links.iter_mut().zip(wrenches) {
            link.wrench = *wrench;
        }
        for index in (1..self.links.len()).rev() {
            let (inner, outer) = self.links.split_at_mut(index);
            let link = &outer[0];
            let rest = if link.is_held {
                link.inertia.times(&(link.axis * rates[index]))
            } else {
                let swing = &mut swings[index];
                swing.impulse_nms = link.bounded(swing);
                let whitened = (link.axis.dot(&link.wrench) + swing.impulse_nms) * link.scale;
                to.hinges[index] = whitened;
                link.unit_wrench * whitened
            };
            inner[link.parent].wrench += link.wrench - rest;
        }
        to.root = self.forward_substitute(&self.links[0].wrench.0);
    }

    /// L⁻¹ of whitened velocities: the rate of every loose hinge, and the velocity of every link.
    pub fn unwhiten(&self, whitened: &Whitened, rates: &mut [f64], velocities: &mut [Spatial]) {
        velocities[0] = self.back_substitute(&whitened.root);
        for (index, link) in self.links.iter().enumerate().skip(1) {
            let parent = velocities[link.parent];
            if !link.is_held {
                let slack = whitened.hinges[index] - link.unit_wrench.dot(&parent);
                rates[index] = slack * link.scale;
            }
            velocities[index] = parent + link.axis * rates[index];
        }
    }

    /// Walks from a link to the root with some wrenches on it, a lane each: hands out y = L⁻ᵀJᵀ at every loose
    /// hinge on the way and returns the root's six.
    #[inline]
    pub fn whiten_wrenches<const N: usize>(
        &self,
        link: usize,
        mut wrenches: [[f64; N]; 6],
        mut hand_out: impl FnMut(usize, [f64; N]),
    ) -> [[f64; N]; 6] {
        let mut index = self.links[link].loose;
        while index != 0 {
            let link = &self.links[index];
            let mut whitened = [0.0; N];
            for (wrench, axis) in wrenches.iter().zip(link.axis.0) {
                for (sum, wrench) in whitened.iter_mut().zip(wrench) {
                    *sum += wrench * axis;
                }
            }
            whitened.iter_mut().for_each(|y| *y *= link.scale);
            for (wrench, unit) in wrenches.iter_mut().zip(link.unit_wrench.0) {
                for (wrench, y) in wrench.iter_mut().zip(whitened) {
                    *wrench -= y * unit;
                }
            }
            hand_out(index, whitened);
            index = self.links[link.parent].loose;
        }
        self.forward_substitute(&wrenches)
    }

    /// The whitened row of a loose hinge itself, as [`Factor::whiten_wrenches`] gives those of wrenches.
    #[inline]
    pub fn whiten_hinge(
        &self,
        hinge: usize,
        mut hand_out: impl FnMut(usize, [f64; 1]),
    ) -> [[f64; 1]; 6] {
        let link = &self.links[hinge];
        hand_out(hinge, [link.scale]);
        let wrench = link.unit_wrench * -link.scale;
        self.whiten_wrenches(link.parent, wrench.0.map(|part| [part]), hand_out)
    }

    /// C⁻¹ of the root's part, for each lane.
    #[inline]
    fn forward_substitute<T: Lanes>(&self, right: &[T; 6]) -> [T; 6] {
        let mut solved = *right;
        for row in 0..6 {
            for column in 0..row {
                solved[row] = solved[row].minus(solved[column], self.root[row][column]);
            }
            solved[row] = solved[row].times(self.root[row][row]);
        }
        solved
    }

    /// C⁻ᵀ of the root's part.
    fn back_substitute(&self, right: &[f64; 6]) -> Spatial {
        let mut solved = *right;
        for row in (0..6).rev() {
            for below in row + 1..6 {
                solved[row] -= self.root[below][row] * solved[below];
            }
            solved[row] *= self.root[row][row];
        }
        Spatial(solved)
    }
}

impl FactorLink {
    /// Finds what the hinge lets through. One that nothing hangs on, or so little that rounding leaves nothing of
    /// it, cannot be told from a rigid connection.
    #[inline]
    fn open_hinge(&mut self) {
        if self.is_held {
            return;
        }
        let wrench = self.inertia.times(&self.axis);
        let pivot = self.axis.dot(&wrench);
        self.scale = inverse_root(pivot);
        self.unit_wrench = wrench * self.scale;
    }

    /// The impulse of a swing, so far as it may change the hinge's rate.
    #[inline]
    fn bounded(&self, swing: &Swing) -> f64 {
        let bound = swing.change_rad_s_max * inverse(self.scale * self.scale);
        // Unlike clamp this needs no bound to be a number.
        swing.impulse_nms.max(-bound).min(bound)
    }
}

/// A number, or several that go the same way.
trait Lanes: Copy {
    fn minus(self, other: Self, factor: f64) -> Self;
    fn times(self, factor: f64) -> Self;
}

impl Lanes for f64 {
    #[inline]
    fn minus(self, other: Self, factor: f64) -> Self {
        self - other * factor
    }

    #[inline]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
}

impl<const N: usize> Lanes for [f64; N] {
    #[inline]
    fn minus(self, other: Self, factor: f64) -> Self {
        std::array::from_fn(|lane| self[lane] - other[lane] * factor)
    }

    #[inline]
    fn times(self, factor: f64) -> Self {
        self.map(|x| x * factor)
    }
}

/// The lower triangular C with CCᵀ = A, and on its diagonal the inverses.
fn cholesky(matrix: &Inertia) -> [[f64; 6]; 6] {
    let mut lower = [[0.0; 6]; 6];
    for row in 0..6 {
        for column in 0..=row {
            let products = lower[row].iter().zip(&lower[column]).take(column).map(|(a, b)| a * b);
            let rest = matrix[(row, column)] - products.sum::<f64>();
            lower[row][column] =
                if row == column { inverse_root(rest) } else { rest * lower[column][column] };
        }
    }
    lower
}

/// 1/x, and nothing of what is not positive: what cannot be moved needs no impulse.
#[inline]
pub fn inverse(x: f64) -> f64 {
    if x > f64::MIN_POSITIVE { 1.0 / x } else { 0.0 }
}

/// 1/√x, and nothing of what is no positive number: a direction that has no inertia left does not move.
#[inline]
fn inverse_root(pivot: f64) -> f64 {
    if pivot > f64::MIN_POSITIVE { 1.0 / pivot.sqrt() } else { 0.0 }
}
