//! One world of several that go side by side: what can be seen of it and done to it.

use super::contact::Footing;
use super::kinematics;
use super::spatial::Spatial;
use super::worlds::FeatherstoneWorld;
use crate::simulation::assembly::Member;
use crate::simulation::failure::Failure;
use crate::simulation::lanes::Everywhere;
use crate::simulation::lanes::width::{Alone, Width};
use crate::simulation::world::{Stepper, World};
use nalgebra::{Isometry3, Translation3, Vector3};

impl<G: Footing<W>, W: Width> FeatherstoneWorld<G, W> {
    /// One of the worlds.
    pub fn lane(&mut self, lane: usize) -> Lane<'_, G, W> {
        Lane { worlds: self, lane }
    }

    fn check(&self, lane: usize) -> Result<(), Failure> {
        let rates: f64 = self.rates_rad_s.iter().map(|rate| rate.get(lane)).sum();
        let root: f64 = self.velocities[0].0.iter().map(|number| number.get(lane)).sum();
        let position_m = self.configuration.position_m.lane(lane).alone().sum();
        let is_finite = (rates + root + position_m).is_finite();
        if is_finite { Ok(()) } else { Err(Failure::NotFinite) }
    }

    fn push_one(&mut self, lane: usize, velocity_m_s: Vector3<f64>) {
        let velocity_m_s = Alone.vector(&velocity_m_s);
        let push = Spatial::new(Alone.vector(&Vector3::zeros()), velocity_m_s);
        let ahead_m = velocity_m_s * (0.5 * self.step_s.get(lane));
        let position_m = self.midway.position_m.lane(lane) + ahead_m;
        self.midway.position_m.set_lane(lane, position_m);
        for (index, place) in self.places.iter().enumerate() {
            let (velocity, momentum) = (&mut self.velocities[index], &mut self.momenta[index]);
            velocity.set_lane(lane, velocity.lane(lane) + push);
            momentum.set_lane(lane, momentum.lane(lane) + place.inertia.lane(lane).times(&push));
        }
    }

    fn pose(&self, lane: usize, part: usize) -> Isometry3<f64> {
        let (rotation, origin_m) = self.configuration.world_from_link(lane, &self.model, part);
        let translation = Translation3::from(origin_m.alone());
        let world_from_link = Isometry3::from_parts(translation, kinematics::quaternion(&rotation));
        world_from_link * self.model.links[part].link_from_part
    }

    fn position(&self, lane: usize, part: usize) -> Vector3<f64> {
        let at_m = &self.model.links[part].link_from_part.translation.vector;
        self.configuration.world_point_m(lane, &self.model, part, at_m).alone()
    }

    fn velocity(&self, lane: usize, part: usize) -> Vector3<f64> {
        let centre_m = self.places[part].inertia.centre_m.lane(lane);
        self.velocities[part].lane(lane).velocity_at(&centre_m).alone()
    }

    fn turn(&self, lane: usize, part: usize) -> Vector3<f64> {
        self.velocities[part].lane(lane).angular().alone()
    }

    /// Impulses act half a step before the places that momenta are evaluated at, as weights do.
    fn apply_one(
        &mut self,
        lane: usize,
        part: usize,
        force_n: Vector3<f64>,
        torque_nm: Vector3<f64>,
    ) {
        let step_s = self.step_s.get(lane);
        let centre_m = self.places[part].inertia.centre_m.lane(lane);
        let ahead_m = self.velocities[part].lane(lane).velocity_at(&centre_m) * (0.5 * step_s);
        let force_ns = Alone.vector(&(force_n * step_s));
        let torque =
            Spatial::new(Alone.vector(&(torque_nm * step_s)), Alone.vector(&Vector3::zeros()));
        let impulse = Spatial::of_force_at(&force_ns, &(centre_m - ahead_m)) + torque;
        let momentum = &mut self.momenta[part];
        momentum.set_lane(lane, momentum.lane(lane) + impulse);
    }

    fn is_pushed(&self, lane: usize, part: usize) -> bool {
        self.remembered.iter().any(|name| {
            let surface = &self.model.solids[name / G::TOUCHES_PER_SOLID];
            surface.link == part && self.contact_impulses_ns[*name][2].get(lane) > 0.0
        })
    }

    #[cfg(test)]
    fn kick_one(&mut self, lane: usize, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        let rigid = Spatial::new(Alone.vector(&turn_rad_s), Alone.vector(&velocity_m_s));
        self.stop(lane);
        let mut midway = kinematics::Configuration::new(self.width, self.places.len());
        midway.follow(&self.configuration);
        let rates_rad_s = vec![self.width.real(0.0); self.places.len()];
        let all = Spatial(rigid.0.map(|number| self.width.real(number.get(0))));
        midway.advance(&all, &rates_rad_s, self.step_s * 0.5);
        self.midway.copy_lane(lane, &midway);
        self.midway.place(&self.model, &mut self.places);
        for (index, place) in self.places.iter().enumerate() {
            self.velocities[index].set_lane(lane, rigid);
            self.momenta[index].set_lane(lane, place.inertia.lane(lane).times(&rigid));
        }
    }
}

/// One world of several that go side by side.
pub struct Lane<'a, G: Footing<W>, W: Width> {
    pub(super) worlds: &'a mut FeatherstoneWorld<G, W>,
    pub(super) lane: usize,
}

impl<G: Footing<W>, W: Width> Lane<'_, G, W> {
    /// Looks at the numbers of the last step.
    ///
    /// # Errors
    /// If one of them is none.
    pub fn check(&self) -> Result<(), Failure> {
        self.worlds.check(self.lane)
    }
}

impl<G: Footing<W>, W: Width> World for Lane<'_, G, W> {
    fn drive(&mut self, part: usize, target_rad_s: f64) {
        self.worlds.targets_rad_s[part].set(self.lane, target_rad_s);
    }

    fn halt(&mut self) {
        self.worlds.stop(self.lane);
    }

    fn push(&mut self, _: &Member, velocity_m_s: Vector3<f64>) {
        self.worlds.push_one(self.lane, velocity_m_s);
    }

    fn apply(&mut self, part: usize, force_n: Vector3<f64>, torque_nm: Vector3<f64>) {
        self.worlds.apply_one(self.lane, part, force_n, torque_nm);
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        self.worlds.pose(self.lane, part)
    }

    fn position_m(&self, part: usize) -> Vector3<f64> {
        self.worlds.position(self.lane, part)
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        self.worlds.velocity(self.lane, part)
    }

    fn turn_rad_s(&self, part: usize) -> Vector3<f64> {
        self.worlds.turn(self.lane, part)
    }

    fn touches(&self, part: usize) -> bool {
        self.worlds.is_pushed(self.lane, part)
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        self.worlds.kick_one(self.lane, velocity_m_s, turn_rad_s);
    }
}

impl<G: Footing<Alone>> World for FeatherstoneWorld<G> {
    fn drive(&mut self, part: usize, target_rad_s: f64) {
        self.lane(0).drive(part, target_rad_s);
    }

    fn halt(&mut self) {
        self.lane(0).halt();
    }

    fn push(&mut self, _: &Member, velocity_m_s: Vector3<f64>) {
        self.push_one(0, velocity_m_s);
    }

    fn apply(&mut self, part: usize, force_n: Vector3<f64>, torque_nm: Vector3<f64>) {
        self.apply_one(0, part, force_n, torque_nm);
    }

    fn world_from_part(&self, part: usize) -> Isometry3<f64> {
        self.pose(0, part)
    }

    fn position_m(&self, part: usize) -> Vector3<f64> {
        self.position(0, part)
    }

    fn velocity_m_s(&self, part: usize) -> Vector3<f64> {
        self.velocity(0, part)
    }

    fn turn_rad_s(&self, part: usize) -> Vector3<f64> {
        self.turn(0, part)
    }

    fn touches(&self, part: usize) -> bool {
        self.is_pushed(0, part)
    }

    #[cfg(test)]
    fn kick(&mut self, velocity_m_s: Vector3<f64>, turn_rad_s: Vector3<f64>) {
        self.lane(0).kick(velocity_m_s, turn_rad_s);
    }
}

impl<G: Footing<Alone>> Stepper for FeatherstoneWorld<G> {
    fn step(&mut self) -> Result<(), Failure> {
        self.step_all();
        self.check(0)
    }
}
