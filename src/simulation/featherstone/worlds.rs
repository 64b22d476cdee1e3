//! A body in several worlds side by side: what is kept of it from one step to the next.

use super::contact::{Footing, Plane, Touch};
use super::factor::{Factor, Swing, Whitened};
use super::kinematics::{Configuration, Place};
use super::model::Model;
use super::solver::Solver;
use super::spatial::Spatial;
use crate::simulation::assembly::Assembly;
use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::lanes::{Everywhere, Mask, Real, Single};
use crate::simulation::trial::Trial;

/// A body in several worlds of our own. Spatial vectors are about the root's centre of mass half a step ahead, along the
/// world's axes; all lists are by link.
pub struct FeatherstoneWorld<G: Footing<W> = Plane, W: Width = Alone> {
    pub(super) width: W,
    pub(super) footing: G,
    pub(super) model: Model,
    /// Which of the worlds are in use.
    pub(super) worlds: Mask<W>,
    pub(super) step_s: Real<W>,
    pub(super) gravity_m_s2: f64,
    /// Where the body is.
    pub(super) configuration: Configuration<W>,
    /// Where it is half a step later: all dynamics are evaluated there.
    pub(super) midway: Configuration<W>,
    /// Where the links are midway.
    pub(super) places: Vec<Place<W>>,
    pub(super) velocities: Vec<Spatial<W>>,
    pub(super) momenta: Vec<Spatial<W>>,
    /// The momentum that each link would have after the step if nothing held it.
    pub(super) free_momenta: Vec<Spatial<W>>,
    /// The impulse that each hinge transmits to its link and all that hangs on it.
    pub(super) transmitted: Vec<Spatial<W>>,
    /// The impulse at each hinge by the motion of its axis, and what it is bounded by for each unit of inertia.
    pub(super) swings: Vec<Swing<W>>,
    pub(super) rates_rad_s: Vec<Real<W>>,
    pub(super) targets_rad_s: Vec<Real<W>>,
    /// The largest torque of each hinge's motor.
    pub(super) torques_nm_max: Vec<Real<W>>,
    /// Whether each motor holds its hinge.
    pub(super) is_held: Vec<Mask<W>>,
    pub(super) motor_impulses_nms: Vec<Single<W>>,
    /// By the point's name.
    pub(super) contact_impulses_ns: Vec<[Single<W>; 3]>,
    /// The names of the points that have one.
    pub(super) remembered: Vec<usize>,
    pub(super) touches: Vec<Touch<G::Facing, W>>,
    pub(super) factor: Factor<W>,
    pub(super) whitened: Whitened<W>,
    pub(super) solver: Solver<W>,
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

    /// Takes all speed from the body of one world.
    pub(super) fn stop(&mut self, lane: usize) {
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
}
