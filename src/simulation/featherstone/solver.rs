//! Impulses of motors and contacts, by sweeps of projected Gauss–Seidel.
//!
//! Constraint by constraint, the impulse is corrected for what the others do to its velocity; a contact's three
//! components go together (block Gauss–Seidel of contact dynamics: Moreau 1999; Jourdan, Alart and Jean 1998). A
//! step begins with the impulses of the one before, which at rest are right already.

use super::constraint::{Change, Contact, Entry, MotorRow, Root};
use super::contact::{Facing, Touch};
use super::factor::{Factor, Whitened};
use super::spatial::Spatial;
use crate::simulation::lanes::width::Width;
use crate::simulation::lanes::{Everywhere, Mask, Real, Single};

/// A sweep that corrects no velocity by more than this, in m/s or rad/s, is the last one: half a millimetre in a
/// second is nothing that a body does.
const TOLERANCE: f32 = 5e-4;

/// The most sweeps of a step. Bodies of the course take three on average; with ten at most, hand-made bodies move by
/// the same millimetres.
const SWEEPS_MAX: usize = 30;

/// The constraints of a step.
#[derive(Clone)]
pub struct Solver<W: Width> {
    /// The coefficient of friction between the ground and a link.
    pub grip: Single<W>,
    /// The motors of loose hinges.
    pub motors: Vec<MotorRow<W>>,
    /// The contacts.
    pub contacts: Vec<Contact<W>>,
    motor_entries: Vec<Entry<1, W>>,
    contact_entries: Vec<Entry<3, W>>,
    /// What impulses have changed at each link's hinge.
    hinges: Vec<Single<W>>,
}

impl<W: Width> Solver<W> {
    /// Room for a body of so many links that may touch the ground at so many points: a step allocates nothing.
    pub fn new(width: W, links: usize, points: usize) -> Self {
        Self {
            grip: width.single(0.0),
            motors: Vec::with_capacity(links),
            contacts: Vec::with_capacity(points),
            motor_entries: Vec::with_capacity(links * links),
            contact_entries: Vec::with_capacity(points * links),
            hinges: vec![width.single(0.0); links],
        }
    }

    /// Forgets all constraints.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.motors.clear();
        self.contacts.clear();
        self.motor_entries.clear();
        self.contact_entries.clear();
    }

    /// Adds the motor of a hinge that is loose in some worlds, where it would turn too fast by a speed, with the
    /// impulse to begin with.
    #[inline(always)]
    pub fn add_motor(
        &mut self,
        link: usize,
        is_loose: Mask<W>,
        excess_rad_s: Real<W>,
        impulse_nms: Single<W>,
        bound_nms: Real<W>,
        factor: &Factor<W>,
    ) {
        let entries = &mut self.motor_entries;
        let motor =
            MotorRow::new(link, is_loose, excess_rad_s, impulse_nms, bound_nms, factor, entries);
        self.motors.push(motor);
    }

    /// Adds a contact of a link that would move by a velocity, with the impulse to begin with.
    #[inline(always)]
    pub fn add_contact<F: Facing<W>>(
        &mut self,
        touch: &Touch<F, W>,
        free: &Spatial<W>,
        impulse_ns: [Single<W>; 3],
        step_s: Real<W>,
        factor: &Factor<W>,
    ) {
        let entries = &mut self.contact_entries;
        self.contacts.push(Contact::new(touch, free, impulse_ns, step_s, factor, entries));
    }

    /// Finds the impulses in some worlds, and adds what they change to whitened velocities. A world whose impulses are
    /// found waits for the others.
    #[inline(always)]
    pub fn solve(&mut self, worlds: Mask<W>, velocities: &mut Whitened<W>) {
        let mut root = self.begin();
        let mut improves = worlds;
        let enough = self.grip.width.single(TOLERANCE * TOLERANCE);
        for _ in 0..SWEEPS_MAX {
            let worst = self.sweep(improves, &mut root);
            improves = improves & !worst.is_less(enough);
            if !improves.any() {
                break;
            }
        }
        for (velocity, change) in velocities.root.iter_mut().zip(root) {
            *velocity += change.double();
        }
        for (velocity, change) in velocities.hinges.iter_mut().zip(&self.hinges) {
            *velocity += change.double();
        }
    }

    /// What the impulses to begin with change: at the hinges, and, returned, at the root.
    #[inline(always)]
    fn begin(&mut self) -> Root<W> {
        let none = self.grip.width.single(0.0);
        self.hinges.fill(none);
        let mut change = Change { root: [none; 6], hinges: &mut self.hinges };
        for motor in &self.motors {
            motor.push(motor.impulse_nms, &mut change, &self.motor_entries);
        }
        for contact in &self.contacts {
            contact.push(contact.impulse_ns, &mut change, &self.contact_entries);
        }
        change.root
    }

    /// Corrects every impulse of some worlds once, and returns the largest square of a velocity that was wrong.
    #[inline(always)]
    fn sweep(&mut self, improves: Mask<W>, root: &mut Root<W>) -> Single<W> {
        // The root is copied so that it stays in registers from row to row.
        let mut change = Change { root: *root, hinges: &mut self.hinges };
        let mut worst = self.grip.width.single(0.0);
        for motor in &mut self.motors {
            worst = motor.improve(improves, &mut change, &self.motor_entries).max(worst);
        }
        for contact in &mut self.contacts {
            let entries = &self.contact_entries;
            worst = contact.improve(improves, &mut change, entries, self.grip).max(worst);
        }
        *root = change.root;
        worst
    }
}
