//! Our own stepper, for what creatures are: a tree of hinges over a plane, without contacts among links.
//!
//! All dynamics are in reduced coordinates, by articulated-body recursions (R. Featherstone, *Rigid Body Dynamics
//! Algorithms*, Springer 2008; chapter and section numbers here are this book's), in double precision.

mod contact;
mod factor;
mod kinematics;
mod model;
mod solver;
mod spatial;
#[cfg(test)]
mod tests;

use super::assembly::Assembly;
use super::trial::Trial;
use super::world::World;
use crate::evolution::Outcome;
use contact::{POINTS_PER_SOLID, Stance, Touch};
use factor::{Factor, Whitened};
use kinematics::{Configuration, Place};
use model::Model;
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use solver::Solver;
use spatial::Spatial;

/// A body in our own world.
pub struct FeatherstoneWorld {
    model: Model,
    step_s: f64,
    gravity_m_s2: f64,
    configuration: Configuration,
    places: Vec<Place>,
    /// The velocity of each link.
    velocities: Vec<Spatial>,
    /// The momentum of each link.
    momenta: Vec<Spatial>,
    /// The rate of each hinge, in rad/s.
    rates_rad_s: Vec<f64>,
    /// What each motor aims at, in rad/s.
    targets_rad_s: Vec<f64>,
    /// Whether each motor holds its hinge to its target.
    is_held: Vec<bool>,
    /// What the motion of each hinge's axis adds to its generalised impulse.
    axis_impulses: Vec<f64>,
    /// The momentum that each link would have after the step without constraints.
    impulses: Vec<Spatial>,
    /// The impulse that each hinge transmits to its link, of all that hangs on it.
    transmitted: Vec<Spatial>,
    factor: Factor,
    whitened: Whitened,
    touches: Vec<Touch>,
    solver: Solver,
    /// The impulses of every point of the body in the last step.
    contact_impulses_ns: Vec<[f32; 3]>,
    motor_impulses_nms: Vec<f32>,
}

/// After so many attempts all motors of a step may slip.
const ATTEMPTS_MAX: usize = 4;

impl FeatherstoneWorld {
    /// Puts a body into a fresh world.
    pub fn new(assembly: &Assembly, trial: &Trial) -> Self {
        let model = Model::new(assembly);
        let links = model.links.len();
        let root = assembly.parts[0].world_from_part;
        let mut world = Self {
            step_s: trial.time_s(1),
            gravity_m_s2: trial.gravity_m_s2,
            configuration: Configuration::new(root.translation.vector, root.rotation, links),
            places: vec![Place::nowhere(); links],
            velocities: vec![Spatial::ZERO; links],
            momenta: vec![Spatial::ZERO; links],
            rates_rad_s: vec![0.0; links],
            targets_rad_s: vec![0.0; links],
            is_held: model.links.iter().map(|link| link.torque_nm_max > 0.0).collect(),
            axis_impulses: vec![0.0; links],
            impulses: vec![Spatial::ZERO; links],
            transmitted: vec![Spatial::ZERO; links],
            factor: Factor::new(&model),
            whitened: Whitened { root: [0.0; 6], hinges: vec![0.0; links] },
            touches: Vec::new(),
            solver: Solver::new(links),
            contact_impulses_ns: vec![[0.0; 3]; model.solids.len() * POINTS_PER_SOLID],
            motor_impulses_nms: vec![0.0; links],
            model,
        };
        world.configuration.place(&world.model, &mut world.places);
        world
    }

    fn find_contacts(&mut self) {
        let stance = Stance {
            places: &self.places,
            velocities: &self.velocities,
            height_m: self.configuration.reference_m.z,
            step_s: self.step_s,
        };
        contact::find(&self.model.solids, stance, &mut self.touches);
    }

    /// What momentum the links have, and gravity gives them.
    fn add_gravity(&mut self) {
        let links = self.model.links.iter().zip(&self.places);
        for ((impulse, momentum), (link, place)) in
            self.impulses.iter_mut().zip(&self.momenta).zip(links)
        {
            let weight_ns = Vector3::z() * (-self.gravity_m_s2 * link.mass_kg * self.step_s);
            *impulse = *momentum + Spatial::of_force_at(&weight_ns, &place.centre_m);
        }
    }

    /// Solves for the velocities, given which hinges are held.
    fn attempt(&mut self) {
        for (index, rate) in self.rates_rad_s.iter_mut().enumerate() {
            if self.is_held[index] {
                *rate = self.targets_rad_s[index];
            }
        }
        self.factor.factorise(&self.places, &self.is_held);
        self.factor.whiten(
            &self.impulses,
            &self.axis_impulses,
            &self.rates_rad_s,
            &mut self.whitened,
        );
        self.factor.unwhiten(&self.whitened, &mut self.rates_rad_s, &mut self.velocities);
        self.constrain();
        self.solver.solve(&mut self.whitened);
        self.factor.unwhiten(&self.whitened, &mut self.rates_rad_s, &mut self.velocities);
    }

    fn constrain(&mut self) {
        self.solver.clear();
        for (index, link) in self.model.links.iter().enumerate().skip(1) {
            if !self.is_held[index] && link.torque_nm_max > 0.0 {
                self.solver.add_motor(
                    index,
                    self.motor_impulses_nms[index],
                    link.torque_nm_max * self.step_s,
                    self.rates_rad_s[index] - self.targets_rad_s[index],
                    &self.factor,
                );
            }
        }
        for touch in &self.touches {
            let impulse = self.contact_impulses_ns[touch.name];
            let free = &self.velocities[touch.link];
            self.solver.add_contact(*touch, impulse, &self.factor, free, self.step_s);
        }
    }

    /// Keeps the links' momenta, and finds the wrench that each hinge transmitted: inverse dynamics (section 5.3).
    fn transmit(&mut self) {
        for (index, place) in self.places.iter().enumerate() {
            let momentum = place.inertia.times(&self.velocities[index]);
            self.momenta[index] = momentum;
            self.transmitted[index] = momentum - self.impulses[index];
        }
        for contact in &self.solver.contacts {
            let impulse_ns = Vector3::from(contact.impulse_ns.map(f64::from));
            self.transmitted[contact.touch.link] -=
                Spatial::of_force_at(&impulse_ns, &contact.touch.point_m);
        }
        for index in (1..self.transmitted.len()).rev() {
            let transmitted = self.transmitted[index];
            self.transmitted[self.model.links[index].parent] += transmitted;
        }
    }

    /// Lets go the hinges that their motors cannot hold; whether there were any.
    fn release(&mut self, attempt: usize) -> bool {
        let mut any = false;
        for (index, link) in self.model.links.iter().enumerate().skip(1) {
            if self.is_held[index] {
                let needed_nms = self.places[index].axis.dot(&self.transmitted[index])
                    - self.axis_impulses[index];
                self.motor_impulses_nms[index] = needed_nms as f32;
                if needed_nms.abs() > link.torque_nm_max * self.step_s {
                    self.is_held[index] = false;
                    any = true;
                }
            }
        }
        if any && attempt + 2 >= ATTEMPTS_MAX {
            for (index, link) in self.model.links.iter().enumerate() {
                self.is_held[index] &= link.torque_nm_max <= 0.0;
            }
        }
        any
    }

    /// Remembers impulses for the next step to begin with, and gives hinges back to motors that can hold them.
    fn remember(&mut self) {
        self.contact_impulses_ns.fill([0.0; 3]);
        for contact in &self.solver.contacts {
            self.contact_impulses_ns[contact.touch.name] = contact.impulse_ns;
        }
        for motor in &self.solver.motors {
            self.motor_impulses_nms[motor.link] = motor.impulse_nms;
            self.is_held[motor.link] = motor.is_at_ease();
        }
        for index in 1..self.places.len() {
            let swing = self.places[index].axis.carried_by(&self.velocities[index]);
            self.axis_impulses[index] = 0.5 * self.step_s * swing.dot(&self.transmitted[index]);
        }
    }

    /// Moves the body by its velocities, and the reference with its root.
    fn advance(&mut self) {
        let root = self.velocities[0];
        let shift_m = root.linear() * self.step_s;
        self.configuration.advance(&root, &self.rates_rad_s, self.step_s);
        self.configuration.place(&self.model, &mut self.places);
        for (velocity, momentum) in self.velocities.iter_mut().zip(&mut self.momenta) {
            *velocity = velocity.motion_about(&shift_m);
            *momentum = momentum.wrench_about(&shift_m);
        }
    }

    fn check(&self) -> Result<(), Outcome> {
        let rates: f64 = self.rates_rad_s.iter().sum();
        let root: f64 = self.velocities[0].0.iter().sum();
        if (rates + root + self.configuration.reference_m.sum()).is_finite() {
            Ok(())
        } else {
            Err(Outcome::NotFinite)
        }
    }
}

impl World for FeatherstoneWorld {
    fn step(&mut self) -> Result<(), Outcome> {
        self.find_contacts();
        self.add_gravity();
        for attempt in 0..ATTEMPTS_MAX {
            self.attempt();
            self.transmit();
            if !self.release(attempt) {
                break;
            }
        }
        self.remember();
        self.advance();
        self.check()
    }

    fn drive(&mut self, part: usize, target_rad_s: f64) {
        self.targets_rad_s[part] = target_rad_s;
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        let place = &self.places[part];
        let rotation = Rotation3::from_matrix_unchecked(place.rotation);
        let world_from_link = Isometry3::from_parts(
            Translation3::from(self.configuration.reference_m + place.origin_m),
            UnitQuaternion::from_rotation_matrix(&rotation),
        );
        world_from_link * self.model.links[part].link_from_part
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        self.velocities[part].velocity_at(&self.places[part].centre_m)
    }
}
