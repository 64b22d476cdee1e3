//! Our own stepper, for what creatures are: a tree of hinges on the ground, without contacts among its links.
//!
//! All dynamics are in reduced coordinates, by recursions over articulated bodies (R. Featherstone, *Rigid Body
//! Dynamics Algorithms*, Springer 2008; numbers of chapters, sections and equations here are this book's), in double
//! precision. From where the body is to where it is one step later:
//!
//! - [`contact`] finds the points that may touch the ground, on a terrain [`relief`];
//! - [`factor`] takes the mass matrix apart and turns momenta into velocities, as if nothing held the body;
//! - [`constraint`] and [`solver`] find the impulses of motors and contacts, which change them;
//! - [`kinematics`] moves the body by them. [`model`] is what stays the same, [`spatial`] the algebra.
//!
//! # How time is stepped
//!
//! What goes over from one step to the next is not velocity but each link's momentum, in the world's axes: it stays
//! unless something pushes, so that no Coriolis or gyroscopic force has to be computed, and all links' momentum
//! together is kept to the last digits. The next velocities are those of the body that have this momentum along
//! every direction in which it can move: sᵀ Σ(h⁺ − h − impulses) = 0 for each axis s, d'Alembert's principle over
//! a step. As in leapfrog, velocities belong to the middle of the way between two configurations, and are evaluated
//! there: half a step ahead of where the body is. The axes of that equation belong between two such middles;
//! [`FeatherstoneWorld::swing`] makes up for that half a step. An undriven chain keeps its energy to 1 in 1,000 over
//! ten seconds this way; with axes or places that are off by half a step some gain a third or lose a tenth.
//!
//! Forces act between two such middles, too, which is where the body is when a step begins: weights at the links'
//! centres ([`FeatherstoneWorld::fall`]), the ground at the points that it touches ([`contact::Touch::acts_m`]). Both
//! must: a weight half a step ahead damps what swings, a ground half a step ahead of the weight brakes what rolls. The
//! lowest point of what is round goes along with its centre, and a corner that sticks stays where it is.
//!
//! # Motors that hold
//!
//! Most motors are strong enough at most moments. Their hinges then turn exactly as they should, and need neither a
//! degree of freedom nor a constraint: they are held, and what they transmit is checked afterwards. A motor that
//! would have had to give more than it can lets go, the step is solved again with its hinge loose, and it takes hold
//! again when it is at ease.

mod constraint;
mod contact;
mod factor;
mod kinematics;
mod model;
mod relief;
mod solver;
mod spatial;
#[cfg(test)]
mod tests;

use super::assembly::Assembly;
use super::trial::Trial;
use super::world::World;
use crate::evolution::Outcome;
use contact::{Footing, Plane, Stance, Touch};
use factor::{Factor, Whitened};
use kinematics::{Configuration, Place};
use model::Model;
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
pub use relief::Relief;
use solver::Solver;
use spatial::Spatial;

/// The last of so many attempts at a step lets all motors slip.
const ATTEMPTS_MAX: usize = 4;

/// The motion of an axis may change its hinge's rate by this share of its parent's angular speed in a step. What
/// hinges transmit is known from the step before, and a blow that a light link took then must not be turned into a
/// spin.
const SWING_SHARE_MAX: f64 = 0.1;

/// A body in our own world. Spatial vectors are about the root's centre of mass half a step ahead, along the world's
/// axes; all lists are by link.
pub struct FeatherstoneWorld<G: Footing = Plane> {
    footing: G,
    model: Model,
    step_s: f64,
    gravity_m_s2: f64,
    /// Where the body is.
    configuration: Configuration,
    /// Where it is half a step later: all dynamics are evaluated there.
    midway: Configuration,
    /// Where the links are midway.
    places: Vec<Place>,
    velocities: Vec<Spatial>,
    momenta: Vec<Spatial>,
    /// The momentum that each link would have after the step if nothing held it.
    free_momenta: Vec<Spatial>,
    /// The impulse that each hinge transmits to its link and all that hangs on it.
    transmitted: Vec<Spatial>,
    /// The impulse at each hinge by the motion of its axis, and what it is bounded by for each unit of inertia.
    swings: Vec<Swing>,
    rates_rad_s: Vec<f64>,
    targets_rad_s: Vec<f64>,
    /// Whether each motor holds its hinge.
    is_held: Vec<bool>,
    motor_impulses_nms: Vec<f32>,
    /// By the point's name.
    contact_impulses_ns: Vec<[f32; 3]>,
    touches: Vec<Touch<G::Facing>>,
    factor: Factor,
    whitened: Whitened,
    solver: Solver<G::Facing>,
}

/// What the motion of a hinge's axis does to the hinge.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Swing {
    /// The impulse, in newton metre seconds.
    pub impulse_nms: f64,
    /// The most that it may change the hinge's rate by, in rad/s.
    pub change_rad_s_max: f64,
}

impl FeatherstoneWorld {
    /// Puts a body into a fresh world whose ground is a plane.
    pub fn new(assembly: &Assembly, trial: &Trial) -> Self {
        Self::on(Plane, assembly, trial)
    }
}

impl<G: Footing> FeatherstoneWorld<G> {
    /// Puts a body into a fresh world with a ground.
    pub fn on(footing: G, assembly: &Assembly, trial: &Trial) -> Self {
        let model = Model::new(assembly);
        let touches = model.solids.len() * G::TOUCHES_PER_SOLID;
        let links = model.links.len();
        let root = assembly.parts[0].world_from_part;
        let configuration = Configuration::new(root.translation.vector, root.rotation, links);
        let mut places = vec![Place::nowhere(); links];
        configuration.place(&model, &mut places);
        Self {
            footing,
            step_s: trial.time_s(1),
            gravity_m_s2: trial.gravity_m_s2,
            midway: configuration.clone(),
            configuration,
            places,
            velocities: vec![Spatial::ZERO; links],
            momenta: vec![Spatial::ZERO; links],
            free_momenta: vec![Spatial::ZERO; links],
            transmitted: vec![Spatial::ZERO; links],
            swings: vec![Swing::default(); links],
            rates_rad_s: vec![0.0; links],
            targets_rad_s: vec![0.0; links],
            is_held: model.links.iter().map(|link| link.has_motor()).collect(),
            motor_impulses_nms: vec![0.0; links],
            contact_impulses_ns: vec![[0.0; 3]; touches],
            touches: Vec::with_capacity(touches),
            factor: Factor::new(&model),
            whitened: Whitened { root: [0.0; 6], hinges: vec![0.0; links] },
            solver: Solver::new(links, touches, trial.grip()),
            model,
        }
    }

    fn find_contacts(&mut self) {
        let stance = Stance {
            places: &self.places,
            velocities: &self.velocities,
            reference_m: self.midway.position_m,
            step_s: self.step_s,
        };
        self.footing.find(&self.model.solids, stance, &mut self.touches);
    }

    /// Adds to the links' momenta what gravity does. Like all impulses of a step it acts half a step before the places
    /// that it is evaluated at.
    fn fall(&mut self) {
        let links = self.momenta.iter().zip(&self.velocities).zip(&self.places);
        for (free, ((momentum, velocity), place)) in self.free_momenta.iter_mut().zip(links) {
            let inertia = &place.inertia;
            let fall_ns = -self.gravity_m_s2 * inertia.mass_kg * self.step_s;
            let ahead_m = velocity.velocity_at(&inertia.centre_m) * (0.5 * self.step_s);
            let acts_m = inertia.centre_m - ahead_m;
            *free = *momentum + Spatial::of_force_at(&(Vector3::z() * fall_ns), &acts_m);
        }
    }

    /// Finds the velocities, given which hinges are held.
    fn attempt(&mut self) {
        self.factor.factorise(&self.places, &self.is_held);
        self.move_freely();
        self.constrain();
        self.solver.solve(&mut self.whitened);
        self.factor.unwhiten(&self.whitened, &mut self.rates_rad_s, &mut self.velocities);
    }

    /// Finds the velocities that the body would have without loose motors and the ground.
    fn move_freely(&mut self) {
        let rates = self.rates_rad_s.iter_mut().zip(&self.targets_rad_s);
        for ((rate, target), _) in rates.zip(&self.is_held).filter(|(_, is_held)| **is_held) {
            *rate = *target;
        }
        self.factor.whiten(
            &self.free_momenta,
            &mut self.swings,
            &self.rates_rad_s,
            &mut self.whitened,
        );
        self.factor.unwhiten(&self.whitened, &mut self.rates_rad_s, &mut self.velocities);
    }

    /// Gathers the constraints: loose motors and contacts, with the last step's impulses.
    fn constrain(&mut self) {
        self.solver.clear();
        for (index, link) in self.model.links.iter().enumerate() {
            if link.has_motor() && !self.is_held[index] {
                let excess_rad_s = self.rates_rad_s[index] - self.targets_rad_s[index];
                let impulse_nms = self.motor_impulses_nms[index];
                let bound_nms = link.torque_nm_max * self.step_s;
                self.solver.add_motor(index, excess_rad_s, impulse_nms, bound_nms, &self.factor);
            }
        }
        for touch in &self.touches {
            let free = &self.velocities[touch.link];
            let impulse_ns = self.contact_impulses_ns[touch.name];
            self.solver.add_contact(*touch, free, impulse_ns, self.step_s, &self.factor);
        }
    }

    /// Finds the links' momenta, and what each hinge transmits so that they have them: inverse dynamics, the inward
    /// half of the recursive Newton–Euler algorithm (section 5.3).
    fn transmit(&mut self) {
        for (index, place) in self.places.iter().enumerate() {
            self.momenta[index] = place.inertia.times(&self.velocities[index]);
            self.transmitted[index] = self.momenta[index] - self.free_momenta[index];
        }
        for contact in &self.solver.contacts {
            let impulse_ns = contact.world_impulse_ns();
            let wrench = Spatial::of_force_at(&impulse_ns, &contact.touch.acts_m);
            self.transmitted[contact.touch.link] -= wrench;
        }
        for index in (1..self.transmitted.len()).rev() {
            let transmitted = self.transmitted[index];
            self.transmitted[self.model.links[index].parent] += transmitted;
        }
    }

    /// The impulse that a hinge's motor gives, in newton metre seconds.
    fn motor_impulse_nms(&self, index: usize) -> f64 {
        self.places[index].axis.dot(&self.transmitted[index]) - self.swings[index].impulse_nms
    }

    /// Lets go the hinges whose motors gave more than they can, and in the end all; whether there were any.
    fn release(&mut self, is_last_attempt: bool) -> bool {
        let mut any = false;
        for index in 1..self.places.len() {
            if self.is_held[index] {
                let impulse_nms = self.motor_impulse_nms(index);
                let bound_nms = self.model.links[index].torque_nm_max * self.step_s;
                self.motor_impulses_nms[index] = impulse_nms as f32;
                self.is_held[index] = impulse_nms.abs() <= bound_nms;
                any |= !self.is_held[index];
            }
        }
        if any && is_last_attempt {
            self.is_held.fill(false);
        }
        any
    }

    /// Remembers what the next step begins with.
    fn remember(&mut self) {
        self.contact_impulses_ns.fill([0.0; 3]);
        for contact in &self.solver.contacts {
            self.contact_impulses_ns[contact.touch.name] = contact.impulse_ns;
        }
        for motor in &self.solver.motors {
            self.motor_impulses_nms[motor.link] = motor.impulse_nms;
            self.is_held[motor.link] = motor.is_at_ease();
        }
        self.swing();
    }

    /// Finds what the motion of the axes does. A step's impulses act along the axes half a step before the places
    /// that it is evaluated at: s − ṡ·dt/2 instead of s.
    fn swing(&mut self) {
        for (index, link) in self.model.links.iter().enumerate().skip(1) {
            let parent = &self.velocities[link.parent];
            let motion = self.places[index].axis.carried_by(parent);
            self.swings[index] = Swing {
                impulse_nms: 0.5 * self.step_s * motion.dot(&self.transmitted[index]),
                change_rad_s_max: SWING_SHARE_MAX * parent.angular().norm(),
            };
        }
    }

    /// Moves the body by its velocities, and all dynamics to half a step ahead of it. Momenta stay where they act;
    /// velocities go with the links, which find the ground by them.
    fn advance(&mut self) {
        let before_m = self.midway.position_m;
        self.configuration.advance(&self.velocities[0], &self.rates_rad_s, self.step_s);
        self.midway.clone_from(&self.configuration);
        self.midway.advance(&self.velocities[0], &self.rates_rad_s, 0.5 * self.step_s);
        self.midway.place(&self.model, &mut self.places);
        let shift_m = self.midway.position_m - before_m;
        for momentum in &mut self.momenta {
            *momentum = momentum.wrench_about(&shift_m);
        }
        for (index, link) in self.model.links.iter().enumerate().skip(1) {
            let turn = self.places[index].axis * self.rates_rad_s[index];
            self.velocities[index] = self.velocities[link.parent] + turn;
        }
    }

    fn check(&self) -> Result<(), Outcome> {
        let rates: f64 = self.rates_rad_s.iter().sum();
        let root: f64 = self.velocities[0].0.iter().sum();
        let is_finite = (rates + root + self.configuration.position_m.sum()).is_finite();
        if is_finite { Ok(()) } else { Err(Outcome::NotFinite) }
    }
}

impl<G: Footing> World for FeatherstoneWorld<G> {
    fn step(&mut self) -> Result<(), Outcome> {
        self.find_contacts();
        self.fall();
        for attempt in 1..=ATTEMPTS_MAX {
            self.attempt();
            self.transmit();
            if !self.release(attempt + 1 >= ATTEMPTS_MAX) {
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

    fn halt(&mut self) {
        self.velocities.fill(Spatial::ZERO);
        self.momenta.fill(Spatial::ZERO);
        self.rates_rad_s.fill(0.0);
        self.swings.fill(Swing::default());
        self.midway.clone_from(&self.configuration);
        self.midway.place(&self.model, &mut self.places);
    }

    fn push(&mut self, velocity_m_s: Vector3<f64>) {
        let push = Spatial::new(Vector3::zeros(), velocity_m_s);
        self.midway.position_m += velocity_m_s * (0.5 * self.step_s);
        let links = self.velocities.iter_mut().zip(&mut self.momenta).zip(&self.places);
        for ((velocity, momentum), place) in links {
            *velocity += push;
            *momentum += place.inertia.times(&push);
        }
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        let (rotation, origin_m) = self.configuration.world_from_link(&self.model, part);
        let rotation = Rotation3::from_matrix_unchecked(rotation);
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        let world_from_link = Isometry3::from_parts(Translation3::from(origin_m), rotation);
        world_from_link * self.model.links[part].link_from_part
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        self.velocities[part].velocity_at(&self.places[part].inertia.centre_m)
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        let rigid = Spatial::new(turn_rad_s, velocity_m_s);
        self.rates_rad_s.fill(0.0);
        self.velocities.fill(rigid);
        self.midway.clone_from(&self.configuration);
        self.midway.advance(&rigid, &self.rates_rad_s, 0.5 * self.step_s);
        self.midway.place(&self.model, &mut self.places);
        for (momentum, place) in self.momenta.iter_mut().zip(&self.places) {
            *momentum = place.inertia.times(&rigid);
        }
    }
}
