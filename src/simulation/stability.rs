//! Guards against what no body does: a solver that blows up must not pass for an athlete.

use super::assembly::{Assembly, Member};
use super::terrain::Ground;
use super::trial::{Guards, Trial};
use super::world::{self, World};
use crate::creature::Creature;
use crate::simulation::failure::Failure;
use nalgebra::{Vector2, Vector3};

/// A link may rise above where it began by this many body lengths…
const RISE_MAX_EXTENTS: f64 = 2.0;
/// … and this much, in metres.
const RISE_MAX_M: f64 = 1.0;

/// The bounds of one body in a trial. Heights are above the ground: the highest that is no farther away than the body
/// reaches, so that who walks over a cliff was not launched.
pub struct Guard {
    guards: Guards,
    height_max_m: f64,
    ground: Ground,
    extent_m: f64,
}

impl Guard {
    /// The bounds of a body that was just put together.
    pub fn new(assembly: &Assembly, body: &Member, creature: &Creature, trial: &Trial) -> Self {
        let Trial { ground, guards, .. } = trial.clone();
        let extent_m = creature.morphology.extent_m();
        let parts = assembly.parts[body.parts.clone()].iter();
        let positions_m = parts.map(|part| part.world_from_part.translation.vector);
        // Over the ground below: over a cliff beside it, it may be far below zero, and higher as soon as it walks off.
        let heights = positions_m.map(|at_m| at_m.z - ground.height_m(at_m.x, at_m.y));
        let start_m = heights.fold(f64::NEG_INFINITY, f64::max);
        let rise_m = RISE_MAX_EXTENTS * extent_m + RISE_MAX_M;
        Self { guards, height_max_m: start_m + rise_m, ground, extent_m }
    }

    fn height_m(&self, position_m: &Vector3<f64>) -> f64 {
        match &self.ground {
            Ground::Plane => position_m.z,
            Ground::Terrain(terrain) => {
                let far = Vector2::repeat(self.extent_m);
                position_m.z - terrain.highest_m(position_m.xy() - far, position_m.xy() + far)
            }
        }
    }

    /// Looks at where the centre of mass is.
    ///
    /// # Errors
    /// If the body has left its terrain, over its walls or through its ground. The momentum of what has fallen through
    /// a mesh, and of what hangs on the far side of a wall, is nobody's merit.
    fn check_place(&self, centre_m: &Vector3<f64>) -> Result<(), Failure> {
        let Ground::Terrain(terrain) = &self.ground else { return Ok(()) };
        let depth_m = terrain.height_m(centre_m.x, centre_m.y) - centre_m.z;
        let is_there = terrain.holds(centre_m.x, centre_m.y) && depth_m < self.extent_m;
        if is_there { Ok(()) } else { Err(Failure::Launched) }
    }

    /// Looks at every part of a body, and where on a terrain it is.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn check(
        &self,
        world: &impl World,
        assembly: &Assembly,
        body: &Member,
    ) -> Result<(), Failure> {
        self.check_parts(world, body)?;
        match &self.ground {
            Ground::Plane => Ok(()),
            Ground::Terrain(_) => self.check_place(&world::centre_of_mass(world, assembly, body)),
        }
    }

    fn check_parts(&self, world: &impl World, body: &Member) -> Result<(), Failure> {
        for part in body.parts.clone() {
            let position_m = world.position_m(part);
            let speed_m_s = world.velocity_m_s(part).norm();
            if !(position_m.sum().is_finite() && speed_m_s.is_finite()) {
                return Err(Failure::NotFinite);
            }
            if speed_m_s > self.guards.speed_m_s_max {
                return Err(Failure::TooFast);
            }
            let refuses_launches = self.guards.refuses_launches;
            if refuses_launches && self.height_m(&position_m) > self.height_max_m {
                return Err(Failure::Launched);
            }
        }
        Ok(())
    }
}

/// Speed that a body may gain out of nothing in a trial, in m/s. At 240 Hz 1,000 random bodies gained at most 0.024
/// (99 % of them 0.008) and three evolved champions 0.035. Bodies that turn about another point than their centre of
/// mass, the worst fault found so far, gained up to 23, every tenth body more than 0.6.
const EXCESS_MAX_M_S: f64 = 0.1;

/// The ledger of a body's momentum.
///
/// Gravity and Coulomb friction are all that acts on a body from outside, so at any moment the acceleration of
/// its centre of mass obeys |a_h| ≤ µ (a_z + g), whatever its motors do. An average over time keeps this true.
/// The change of the mean velocity from one period of length T to the next is such an average, so it needs
/// nothing but the positions that the score is made of: |Δv_h| ≤ µ (Δv_z + g T). What is above is the solver's.
///
/// On a terrain there is no such bound: the ground pushes along its slope, a wall along the level as hard as a body
/// pushes it, and a mean over a tenth of a second does not tell which of them it touched. [`Guards::keeps_ledger`] is
/// off there.
///
/// No ledger of energy is kept. Native motors may do a kilowatt each (126 N·m at 8 rad/s), so that the bound would be
/// some hundred joules a tenth of a second, more than a solver's error ever gives a body unless this ledger or the
/// guard refuses it; a body that is only pushed up out of the ground comes down where it was.
#[derive(Debug, Clone)]
pub struct Ledger {
    period_s: f64,
    gravity_m_s2: f64,
    grip: f64,
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    /// The share of a period's gravity that the next change of mean velocity has seen.
    share: f64,
    excess_m_s: f64,
}

impl Ledger {
    /// A ledger of positions that many steps apart, for a body that has this position and velocity at its beginning.
    ///
    /// From that velocity to the mean one of the first period T it is (1/T) ∫ (T - t) a dt, in which gravity counts
    /// half.
    pub fn new(
        trial: &Trial,
        steps: u32,
        position_m: Vector3<f64>,
        velocity_m_s: Vector3<f64>,
    ) -> Self {
        Self {
            period_s: trial.time_s(steps),
            gravity_m_s2: trial.gravity_m_s2,
            grip: trial.grip(),
            position_m,
            velocity_m_s,
            share: 0.5,
            excess_m_s: 0.0,
        }
    }

    /// Enters the next position of the centre of mass.
    pub fn enter(&mut self, position_m: Vector3<f64>) -> Result<(), Failure> {
        let velocity_m_s = (position_m - self.position_m) / self.period_s;
        let change_m_s = velocity_m_s - self.velocity_m_s;
        let support_m_s = change_m_s.z + self.share * self.gravity_m_s2 * self.period_s;
        let grip_m_s = self.grip * support_m_s;
        self.excess_m_s += (change_m_s.xy().norm() - grip_m_s).max(0.0);
        (self.position_m, self.velocity_m_s, self.share) = (position_m, velocity_m_s, 1.0);
        if self.excess_m_s > EXCESS_MAX_M_S { Err(Failure::Unphysical) } else { Ok(()) }
    }

    /// Enters a velocity that the body got from outside at the moment of the last position, in m/s.
    pub fn enter_push(&mut self, velocity_m_s: Vector3<f64>) {
        self.velocity_m_s += velocity_m_s;
    }

    /// Speed that the body has gained out of nothing so far, in m/s.
    pub fn excess_m_s(&self) -> f64 {
        self.excess_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::super::medium::Medium;
    use super::super::perturbation::Perturbation;
    use super::super::start::Start;
    use super::*;

    fn trial() -> Trial {
        Trial {
            steps_per_s: 240,
            perturbation: Perturbation::NONE,
            gravity_m_s2: 9.81,
            ground: Ground::Plane,
            medium: Medium::Void,
            start: Start::LowestAt(0.0),
            settle_s: 0.0,
            scored_s: 2.0,
            guards: Guards::ALL,
            others: Vec::new(),
        }
    }

    #[test]
    fn a_jump_that_takes_its_grip_from_the_ground_is_no_push() {
        let mut ledger = Ledger::new(&trial(), 24, Vector3::zeros(), Vector3::zeros());
        let (fall_m, hop_m) = (-9.81 * 0.01, 0.05);
        ledger.enter(Vector3::zeros()).unwrap();
        assert_eq!(ledger.enter(Vector3::new(0.03, 0.0, hop_m)), Ok(()));
        let falling = Vector3::new(0.06, 0.0, 2.0 * hop_m + fall_m);
        assert_eq!(ledger.clone().enter(falling), Ok(()));
        assert_eq!(ledger.enter(falling + Vector3::x() * 0.02), Err(Failure::Unphysical));
    }

    #[test]
    fn what_rubber_may_do_is_a_push_on_ice() {
        let enter = |friction| {
            let perturbation = Perturbation { friction, ..Perturbation::NONE };
            let trial = Trial { perturbation, ..trial() };
            let mut ledger = Ledger::new(&trial, 24, Vector3::zeros(), Vector3::zeros());
            ledger.enter(Vector3::zeros())?;
            // Twice 0.27 m/s more than before; of each, usual friction allows 0.245, and 0.1 in all is passed over.
            ledger.enter(Vector3::x() * 0.027)?;
            ledger.enter(Vector3::x() * 0.081)
        };
        assert_eq!(enter(1.25), Ok(()));
        assert_eq!(enter(0.75), Err(Failure::Unphysical));
    }

    #[test]
    fn a_push_that_is_entered_is_no_excess_and_must_be_what_was_entered() {
        let enter = |push_m_s: f64| {
            let mut ledger = Ledger::new(&trial(), 24, Vector3::zeros(), Vector3::zeros());
            ledger.enter(Vector3::zeros())?;
            ledger.enter_push(Vector3::x() * push_m_s);
            ledger.enter(Vector3::x() * 0.06)?;
            ledger.enter(Vector3::x() * 0.12)
        };
        assert_eq!(enter(0.6), Ok(()));
        assert_eq!(enter(0.0), Err(Failure::Unphysical));
        assert_eq!(enter(-0.6), Err(Failure::Unphysical));
    }
}
