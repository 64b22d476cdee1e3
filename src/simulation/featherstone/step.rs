//! A step of every world.

use super::contact::{Facing, Footing, Stance};
use super::factor::Swing;
use super::spatial::Spatial;
use super::worlds::FeatherstoneWorld;
use crate::simulation::lanes::width::{Width, Work};
use crate::simulation::lanes::{Everywhere, Real, Vec3};

/// The last of so many attempts at a step lets all motors slip.
const ATTEMPTS_MAX: usize = 4;

/// The motion of an axis may change its hinge's rate by this share of its parent's angular speed in a step. What
/// hinges transmit is known from the step before, and a blow that a light link took then must not be turned into a
/// spin.
const SWING_SHARE_MAX: f64 = 0.1;

/// A step of every world, to be compiled where the processor's instructions can be used.
struct Step<'a, G: Footing<W>, W: Width>(&'a mut FeatherstoneWorld<G, W>);

impl<G: Footing<W>, W: Width> Work for Step<'_, G, W> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.step_side_by_side();
    }
}

impl<G: Footing<W>, W: Width> FeatherstoneWorld<G, W> {
    /// Advances every world by one step of its own.
    pub fn step_all(&mut self) {
        self.width.with(Step(self));
    }

    #[inline(always)]
    fn step_side_by_side(&mut self) {
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
    }

    #[inline(always)]
    pub(super) fn find_contacts(&mut self) {
        let stance = Stance {
            places: &self.places,
            velocities: &self.velocities,
            reference_m: self.midway.position_m,
            step_s: self.step_s,
            worlds: self.worlds,
        };
        self.footing.find(&self.model.solids, stance, &mut self.touches);
    }

    /// Adds to the links' momenta what gravity does. Like all impulses of a step it acts half a step before the places
    /// that it is evaluated at.
    #[inline(always)]
    pub(super) fn fall(&mut self) {
        let none = self.width.real(0.0);
        let links = self.momenta.iter().zip(&self.velocities).zip(&self.places);
        for (free, ((momentum, velocity), place)) in self.free_momenta.iter_mut().zip(links) {
            let inertia = &place.inertia;
            let fall_ns = self.step_s * (-self.gravity_m_s2 * inertia.mass_kg);
            let ahead_m = velocity.velocity_at(&inertia.centre_m).times(self.step_s * 0.5);
            let acts_m = inertia.centre_m - ahead_m;
            let weight_ns = Vec3([none, none, fall_ns]);
            *free = *momentum + Spatial::of_force_at(&weight_ns, &acts_m);
        }
    }

    /// Finds the velocities, given which hinges are held.
    #[inline(always)]
    pub(super) fn attempt(&mut self) {
        self.factor.factorise(&self.places, &self.is_held);
        self.move_freely();
        self.constrain();
        self.solver.solve(self.worlds, &mut self.whitened);
        self.factor.unwhiten(&self.whitened, &mut self.rates_rad_s, &mut self.velocities);
    }

    /// Finds the velocities that the body would have without loose motors and the ground.
    #[inline(always)]
    fn move_freely(&mut self) {
        let rates = self.rates_rad_s.iter_mut().zip(&self.targets_rad_s);
        for ((rate, target), is_held) in rates.zip(&self.is_held) {
            *rate = target.where_or(*is_held, *rate);
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
    #[inline(always)]
    fn constrain(&mut self) {
        self.solver.clear();
        for (index, link) in self.model.links.iter().enumerate() {
            let is_loose = !self.is_held[index] & self.worlds;
            if link.has_motor && is_loose.any() {
                let excess_rad_s = self.rates_rad_s[index] - self.targets_rad_s[index];
                let impulse_nms = self.motor_impulses_nms[index];
                let bound_nms = self.torques_nm_max[index] * self.step_s;
                let (solver, factor) = (&mut self.solver, &self.factor);
                solver.add_motor(index, is_loose, excess_rad_s, impulse_nms, bound_nms, factor);
            }
        }
        for touch in &self.touches {
            let free = &self.velocities[touch.link];
            let impulse_ns = self.contact_impulses_ns[touch.name];
            self.solver.add_contact(touch, free, impulse_ns, self.step_s, &self.factor);
        }
    }

    /// Finds the links' momenta, and what each hinge transmits so that they have them: inverse dynamics, the inward
    /// half of the recursive Newton–Euler algorithm (section 5.3).
    #[inline(always)]
    pub(super) fn transmit(&mut self) {
        for (index, place) in self.places.iter().enumerate() {
            self.momenta[index] = place.inertia.times(&self.velocities[index]);
            self.transmitted[index] = self.momenta[index] - self.free_momenta[index];
        }
        for (contact, touch) in self.solver.contacts.iter().zip(&self.touches) {
            let [x, y, z] = contact.impulse_ns;
            let impulse_ns = Vec3([x.double(), y.double(), z.double()]);
            let impulse_ns = touch.facing.world(impulse_ns);
            let wrench = Spatial::of_force_at(&impulse_ns, &touch.acts_m);
            self.transmitted[touch.link] -= wrench;
        }
        for index in (1..self.transmitted.len()).rev() {
            let transmitted = self.transmitted[index];
            self.transmitted[self.model.links[index].parent] += transmitted;
        }
    }

    /// The impulse that a hinge's motor gives, in newton metre seconds.
    #[inline(always)]
    pub(super) fn motor_impulse_nms(&self, index: usize) -> Real<W> {
        self.places[index].axis.dot(&self.transmitted[index]) - self.swings[index].impulse_nms
    }

    /// Lets go the hinges whose motors gave more than they can, and in the end all of that world; whether there were
    /// any. What a world finds a second time is what it found at first.
    #[inline(always)]
    pub(super) fn release(&mut self, is_last_attempt: bool) -> bool {
        let mut any = self.width.mask(false);
        for index in 1..self.places.len() {
            let held = self.is_held[index] & self.worlds;
            if held.any() {
                let impulse_nms = self.motor_impulse_nms(index);
                let bound_nms = self.torques_nm_max[index] * self.step_s;
                let remembered = &mut self.motor_impulses_nms[index];
                *remembered = impulse_nms.single().where_or(held, *remembered);
                let is_enough = impulse_nms.abs().is_at_most(bound_nms);
                self.is_held[index] = self.is_held[index] & (is_enough | !held);
                any = any | (held & !is_enough);
            }
        }
        if any.any() && is_last_attempt {
            for is_held in &mut self.is_held {
                *is_held = *is_held & !any;
            }
        }
        any.any()
    }

    /// Remembers what the next step begins with.
    #[inline(always)]
    pub(super) fn remember(&mut self) {
        for name in self.remembered.drain(..) {
            self.contact_impulses_ns[name] = [self.width.single(0.0); 3];
        }
        for (contact, touch) in self.solver.contacts.iter().zip(&self.touches) {
            self.contact_impulses_ns[touch.name] = contact.impulse_ns;
            self.remembered.push(touch.name);
        }
        for motor in &self.solver.motors {
            let (link, is_loose) = (motor.link, motor.is_loose);
            let remembered = &mut self.motor_impulses_nms[link];
            *remembered = motor.impulse_nms.where_or(is_loose, *remembered);
            self.is_held[link] = self.is_held[link] | (is_loose & motor.is_at_ease());
        }
        self.swing();
    }

    /// Finds what the motion of the axes does. A step's impulses act along the axes half a step before the places
    /// that it is evaluated at: s − ṡ·dt/2 instead of s.
    #[inline(always)]
    fn swing(&mut self) {
        for (index, link) in self.model.links.iter().enumerate().skip(1) {
            let parent = &self.velocities[link.parent];
            let motion = self.places[index].axis.carried_by(parent);
            self.swings[index] = Swing {
                impulse_nms: self.step_s * 0.5 * motion.dot(&self.transmitted[index]),
                change_rad_s_max: parent.angular().norm() * SWING_SHARE_MAX,
            };
        }
    }

    /// Moves the body by its velocities, and all dynamics to half a step ahead of it. Momenta stay where they act;
    /// velocities go with the links, which find the ground by them.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        let before_m = self.midway.position_m;
        let (root, half_s) = (self.velocities[0], self.step_s * 0.5);
        self.configuration.advance(&root, &self.rates_rad_s, self.step_s);
        self.midway.follow(&self.configuration);
        self.midway.advance(&root, &self.rates_rad_s, half_s);
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
}
