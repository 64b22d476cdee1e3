//! Impulses of motors and contacts, by sweeps of projected Gauss–Seidel.
//!
//! Constraint by constraint, the impulse is corrected for what the others do to its velocity; a contact's three
//! components go together (block Gauss–Seidel of contact dynamics: Moreau 1999; Jourdan, Alart and Jean 1998). A
//! step begins with the impulses of the one before, which at rest are right already.

use super::constraint::{Change, Contact, Entry, MotorRow, Root};
use super::contact::{Facing, Level, Touch};
use super::factor::{Factor, Whitened};
use super::spatial::Spatial;

/// A sweep that corrects no velocity by more than this, in m/s or rad/s, is the last one: half a millimetre in a
/// second is nothing that a body does.
const TOLERANCE: f32 = 5e-4;

/// The most sweeps of a step. Bodies of the course take three on average; with ten at most, hand-made bodies move by
/// the same millimetres.
const SWEEPS_MAX: usize = 30;

/// The constraints of a step.
#[derive(Debug, Clone)]
pub struct Solver<F = Level> {
    /// The coefficient of friction between the ground and a link.
    grip: f32,
    /// The motors of loose hinges.
    pub motors: Vec<MotorRow>,
    /// The contacts.
    pub contacts: Vec<Contact<F>>,
    motor_entries: Vec<Entry<1>>,
    contact_entries: Vec<Entry<4>>,
    /// What impulses have changed at each link's hinge.
    hinges: Vec<f32>,
}

impl<F: Facing> Solver<F> {
    /// Room for a body of so many links that may touch the ground, with such a coefficient of friction, at so many
    /// points: a step allocates nothing.
    pub fn new(links: usize, points: usize, grip: f64) -> Self {
        Self {
            grip: grip as f32,
            motors: Vec::with_capacity(links),
            contacts: Vec::with_capacity(points),
            motor_entries: Vec::with_capacity(links * links),
            contact_entries: Vec::with_capacity(points * links),
            hinges: vec![0.0; links],
        }
    }

    /// Forgets all constraints.
    pub fn clear(&mut self) {
        self.motors.clear();
        self.contacts.clear();
        self.motor_entries.clear();
        self.contact_entries.clear();
    }

    /// Adds the motor of a loose hinge that would turn too fast by a speed, with the impulse to begin with.
    pub fn add_motor(
        &mut self,
        link: usize,
        excess_rad_s: f64,
        impulse_nms: f32,
        bound_nms: f64,
        factor: &Factor,
    ) {
        let entries = &mut self.motor_entries;
        let motor = MotorRow::new(link, excess_rad_s, impulse_nms, bound_nms, factor, entries);
        self.motors.push(motor);
    }

    /// Adds a contact of a link that would move by a velocity, with the impulse to begin with.
    pub fn add_contact(
        &mut self,
        touch: Touch<F>,
        free: &Spatial,
        impulse_ns: [f32; 3],
        step_s: f64,
        factor: &Factor,
    ) {
        let entries = &mut self.contact_entries;
        self.contacts.push(Contact::new(touch, free, impulse_ns, step_s, factor, entries));
    }

    /// Finds the impulses, and adds what they change to whitened velocities.
    pub fn solve(&mut self, velocities: &mut Whitened) {
        let mut root = self.begin();
        for _ in 0..SWEEPS_MAX {
            if self.sweep(&mut root) < TOLERANCE * TOLERANCE {
                break;
            }
        }
        for (velocity, change) in velocities.root.iter_mut().zip(root) {
            *velocity += f64::from(change);
        }
        for (velocity, change) in velocities.hinges.iter_mut().zip(&self.hinges) {
            *velocity += f64::from(*change);
        }
    }

    /// What the impulses to begin with change: at the hinges, and, returned, at the root.
    fn begin(&mut self) -> Root {
        self.hinges.fill(0.0);
        let mut change = Change { root: Root::default(), hinges: &mut self.hinges };
        for motor in &self.motors {
            motor.push(motor.impulse_nms, &mut change, &self.motor_entries);
        }
        for contact in &self.contacts {
            contact.push(contact.impulse_ns, &mut change, &self.contact_entries);
        }
        change.root
    }

    /// Corrects every impulse once, and returns the largest square of a velocity that was wrong.
    fn sweep(&mut self, root: &mut Root) -> f32 {
        // The root is copied so that it stays in registers from row to row.
        let mut change = Change { root: *root, hinges: &mut self.hinges };
        let mut worst = 0.0_f32;
        for motor in &mut self.motors {
            worst = worst.max(motor.improve(&mut change, &self.motor_entries));
        }
        for contact in &mut self.contacts {
            worst = worst.max(contact.improve(&mut change, &self.contact_entries, self.grip));
        }
        *root = change.root;
        worst
    }
}
