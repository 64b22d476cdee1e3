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
//!
//! # Several worlds at a time
//!
//! A world here is several side by side ([`lanes`](super::lanes)), as many as a [`Width`] has, all with the same body: the trials of
//! a body differ in their numbers alone. Where they part (a contact that one of them has, a hinge that is loose in
//! some) all do what any of them needs, and keep it to those that need it. That is what eight at a time lose: eight
//! random trials of a body have 2.4 times as many points in contact as one of them, and sweep twice as often.

mod constraint;
mod contact;
mod factor;
mod kinematics;
mod lane;
mod model;
mod relief;
mod solver;
mod spatial;
mod step;
#[cfg(test)]
mod tests;

use super::assembly::Assembly;
use super::lanes::width::{Alone, Width};
use super::lanes::{Everywhere, Mask, Real, Single};
use super::trial::Trial;
use contact::Touch;
pub use contact::{Footing, Plane};
use factor::{Factor, Swing, Whitened};
use kinematics::{Configuration, Place};
use lane::Lane;
use model::Model;
pub use relief::Relief;
use solver::Solver;
use spatial::Spatial;
use step::Step;

/// A body in several worlds of our own. Spatial vectors are about the root's centre of mass half a step ahead, along the
/// world's axes; all lists are by link.
pub struct FeatherstoneWorld<G: Footing<W> = Plane, W: Width = Alone> {
    width: W,
    footing: G,
    model: Model,
    /// Which of the worlds are in use.
    worlds: Mask<W>,
    step_s: Real<W>,
    gravity_m_s2: f64,
    /// Where the body is.
    configuration: Configuration<W>,
    /// Where it is half a step later: all dynamics are evaluated there.
    midway: Configuration<W>,
    /// Where the links are midway.
    places: Vec<Place<W>>,
    velocities: Vec<Spatial<W>>,
    momenta: Vec<Spatial<W>>,
    /// The momentum that each link would have after the step if nothing held it.
    free_momenta: Vec<Spatial<W>>,
    /// The impulse that each hinge transmits to its link and all that hangs on it.
    transmitted: Vec<Spatial<W>>,
    /// The impulse at each hinge by the motion of its axis, and what it is bounded by for each unit of inertia.
    swings: Vec<Swing<W>>,
    rates_rad_s: Vec<Real<W>>,
    targets_rad_s: Vec<Real<W>>,
    /// The largest torque of each hinge's motor.
    torques_nm_max: Vec<Real<W>>,
    /// Whether each motor holds its hinge.
    is_held: Vec<Mask<W>>,
    motor_impulses_nms: Vec<Single<W>>,
    /// By the point's name.
    contact_impulses_ns: Vec<[Single<W>; 3]>,
    /// The names of the points that have one.
    remembered: Vec<usize>,
    touches: Vec<Touch<G::Facing, W>>,
    factor: Factor<W>,
    whitened: Whitened<W>,
    solver: Solver<W>,
}

impl FeatherstoneWorld {
    /// Puts a body into a fresh world whose ground is a plane.
    pub fn new(assembly: &Assembly, trial: &Trial) -> Self {
        Self::on(Plane, assembly, trial)
    }
}

impl<G: Footing<Alone>> FeatherstoneWorld<G> {
    /// Puts a body into a fresh world with a ground.
    pub fn on(footing: G, assembly: &Assembly, trial: &Trial) -> Self {
        let mut world = Self::empty(Alone, footing, assembly, trial);
        world.put(0, assembly, trial);
        world
    }
}

impl<G: Footing<W>, W: Width> FeatherstoneWorld<G, W> {
    /// Worlds with a ground that are made for a body, in which there is none yet.
    pub fn empty(width: W, footing: G, assembly: &Assembly, trial: &Trial) -> Self {
        let model = Model::new(assembly);
        let touches = model.solids.len() * G::TOUCHES_PER_SOLID;
        let links = model.links.len();
        let (none, none_single) = (width.real(0.0), width.single(0.0));
        Self {
            width,
            footing,
            worlds: width.mask(false),
            step_s: width.real(trial.time_s(1)),
            gravity_m_s2: trial.gravity_m_s2,
            configuration: Configuration::new(width, links),
            midway: Configuration::new(width, links),
            places: vec![Place::nowhere(width); links],
            velocities: vec![Spatial::zero(width); links],
            momenta: vec![Spatial::zero(width); links],
            free_momenta: vec![Spatial::zero(width); links],
            transmitted: vec![Spatial::zero(width); links],
            swings: vec![Swing::none(width); links],
            rates_rad_s: vec![none; links],
            targets_rad_s: vec![none; links],
            torques_nm_max: vec![none; links],
            is_held: model.links.iter().map(|link| width.mask(link.has_motor)).collect(),
            motor_impulses_nms: vec![none_single; links],
            contact_impulses_ns: vec![[none_single; 3]; touches],
            remembered: Vec::with_capacity(touches),
            touches: Vec::with_capacity(touches),
            factor: Factor::new(width, &model),
            whitened: Whitened { root: [none; 6], hinges: vec![none; links] },
            solver: Solver::new(width, links, touches),
            model,
        }
    }

    /// Puts the body into one of the worlds for a trial, whatever was there.
    pub fn put(&mut self, lane: usize, assembly: &Assembly, trial: &Trial) {
        let root = assembly.parts[0].world_from_part;
        self.configuration.put(lane, &root.translation.vector, &root.rotation);
        self.worlds.put(lane, true);
        self.step_s.set(lane, trial.time_s(1));
        self.solver.grip.set(lane, trial.grip() as f32);
        for (index, part) in assembly.parts.iter().enumerate() {
            let torque_nm_max = part.hinge.map_or(0.0, |hinge| hinge.torque_nm_max);
            self.torques_nm_max[index].set(lane, torque_nm_max);
            self.targets_rad_s[index].set(lane, 0.0);
            self.is_held[index].put(lane, self.model.links[index].has_motor);
            self.motor_impulses_nms[index].set(lane, 0.0);
        }
        for impulse in self.contact_impulses_ns.as_flattened_mut() {
            impulse.set(lane, 0.0);
        }
        self.stop(lane);
    }

    /// Takes the body out of one of the worlds.
    pub fn take(&mut self, lane: usize) {
        self.worlds.put(lane, false);
    }

    /// One of the worlds.
    pub fn lane(&mut self, lane: usize) -> Lane<'_, G, W> {
        Lane { worlds: self, lane }
    }

    /// Takes all speed from the body of one world.
    fn stop(&mut self, lane: usize) {
        for index in 0..self.places.len() {
            self.velocities[index].set_lane(lane, Spatial::zero(Alone));
            self.momenta[index].set_lane(lane, Spatial::zero(Alone));
            self.rates_rad_s[index].set(lane, 0.0);
            self.swings[index].impulse_nms.set(lane, 0.0);
            self.swings[index].change_rad_s_max.set(lane, 0.0);
        }
        self.midway.copy_lane(lane, &self.configuration);
        self.midway.place(&self.model, &mut self.places);
    }

    /// Advances every world by one step of its own.
    pub fn step_all(&mut self) {
        self.width.with(Step(self));
    }
}
