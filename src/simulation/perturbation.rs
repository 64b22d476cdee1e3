//! What may differ from one trial of a body to the next: whoever depends on it has not learnt to walk.
//!
//! A gait that is tried in one world fits that world: its friction, the way its bodies begin, the errors of its solver.
//! Robots that were evolved in simulators without noise fail outside of them for that reason (Jakobi, Husbands and
//! Harvey 1995). So the same body is tried in worlds that differ by more than what is known of them.
//!
//! The `index`-th perturbation is the same for all bodies, wherever and whenever they are tried: it is drawn from an
//! address that holds nothing but its index.

use super::terrain::Ground;
use super::trial::Trial;
use crate::rng::{Purpose, Source, Stream};
use nalgebra::Vector3;
use rand::RngExt;
use std::f64::consts::{PI, TAU};

/// Friction of the ground differs by at most this share.
const FRICTION_SHARE: f64 = 0.25;
/// The strength of motors differs by at most this share, all of a body alike.
const TORQUE_SHARE: f64 = 0.2;
/// On a terrain a body is turned by at most this angle, in radians: there the ways differ, and who faces the hill in
/// one trial and turns its back on it in the next cannot know where to go.
const TERRAIN_YAW_RAD: f64 = 0.2;
/// The greatest push, in m/s.
const PUSH_M_S_MAX: f64 = 0.3;
/// The shares of the scored time between which a push comes. In its second half, since what is pushed and rolls on for
/// less than half of the time gains nothing by it: a score is at most twice what is left without its best half.
const PUSH_SHARES: [f64; 2] = [0.5, 0.9];
/// The shares of the usual number of steps a second between which it is: an error of a solver that pays is another one
/// with other steps.
const RATE_SHARES: [f64; 2] = [5.0 / 6.0, 5.0 / 4.0];
/// Steps a second are a multiple of this, so that motor updates and positions on the track, which are tenths of a
/// second apart, are so with all of them.
const RATE_UNIT: f64 = 10.0;

/// What differs from the trial as it is defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    /// Friction between ground and body, times what it usually is.
    pub friction: f64,
    /// The greatest torque of every motor, times its own.
    pub torque: f64,
    /// The body is turned about the vertical by this angle before it leans, in radians: so it leans to another side.
    pub yaw_rad: f64,
    /// The whole body gets this velocity on top of its own at a moment of the scored time, in m/s.
    pub push_m_s: Vector3<f64>,
    /// That moment, as a share of the scored time.
    pub push_share: f64,
}

impl Perturbation {
    /// Nothing differs.
    pub const NONE: Self = Self {
        friction: 1.0,
        torque: 1.0,
        yaw_rad: 0.0,
        push_m_s: Vector3::new(0.0, 0.0, 0.0),
        push_share: 0.0,
    };

    fn draw(rng: &mut Stream) -> Self {
        let friction = 1.0 + between([-FRICTION_SHARE, FRICTION_SHARE], rng);
        let torque = 1.0 + between([-TORQUE_SHARE, TORQUE_SHARE], rng);
        let yaw_rad = between([0.0, TAU], rng);
        let direction_rad = between([0.0, TAU], rng);
        let speed_m_s = between([0.0, PUSH_M_S_MAX], rng);
        let push_share = between(PUSH_SHARES, rng);
        let (sin, cos) = libm::sincos(direction_rad);
        let push_m_s = Vector3::new(cos, sin, 0.0) * speed_m_s;
        Self { friction, torque, yaw_rad, push_m_s, push_share }
    }

    /// The same, but the circle of yaws is that of [`TERRAIN_YAW_RAD`] to either side.
    fn facing_ahead(self) -> Self {
        Self { yaw_rad: (self.yaw_rad / PI - 1.0) * TERRAIN_YAW_RAD, ..self }
    }
}

impl Trial {
    /// The same trial with its `index`-th perturbation, and at other steps.
    pub fn perturbed(&self, index: u32) -> Self {
        let mut rng = Source { seed: 0, island: 0 }.stream(0, index, Purpose::Perturbation);
        let drawn = Perturbation::draw(&mut rng);
        let perturbation = match self.ground {
            Ground::Plane => drawn,
            Ground::Terrain(_) => drawn.facing_ahead(),
        };
        let rate = f64::from(self.steps_per_s) * between(RATE_SHARES, &mut rng);
        let steps_per_s = ((rate / RATE_UNIT).round() * RATE_UNIT) as u32;
        Self { steps_per_s, perturbation, ..*self }
    }

    /// The same trial without a push, for scores that one would be a free gain of.
    pub fn unpushed(&self) -> Self {
        let none = Perturbation::NONE;
        let Perturbation { push_m_s, push_share, .. } = none;
        let perturbation = Perturbation { push_m_s, push_share, ..self.perturbation };
        Self { perturbation, ..*self }
    }

    /// After how many scored steps the body is pushed: when a position of the track was taken, so that the track shows
    /// the velocities of before and after it apart.
    pub(super) fn push_step(&self) -> u32 {
        let sample = (self.perturbation.push_share * self.samples() as f64).round() as u32;
        sample * self.sample_steps()
    }
}

fn between([from, to]: [f64; 2], rng: &mut Stream) -> f64 {
    from + (to - from) * rng.random::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::terrain::mountain;
    use super::super::trial::{Guards, Start};
    use super::*;

    const TRIAL: Trial = Trial {
        steps_per_s: 240,
        perturbation: Perturbation::NONE,
        gravity_m_s2: 9.81,
        ground: Ground::Plane,
        start: Start::LowestAt(0.0),
        settle_s: 0.5,
        scored_s: 8.0,
        guards: Guards::ALL,
    };

    #[test]
    fn a_perturbation_is_what_it_is_by_its_index_alone() {
        let all: Vec<Trial> = (0..100).map(|index| TRIAL.perturbed(index)).collect();
        let again: Vec<Trial> = (0..100).rev().map(|index| TRIAL.perturbed(index)).collect();
        assert!(all.iter().eq(again.iter().rev()));
        for (index, one) in all.iter().enumerate() {
            assert!(!all[..index].contains(one), "{index} has been there: {one:?}");
        }
        // A perturbation is not perturbed: who does so by mistake changes nothing but the steps.
        assert_eq!(all[3].perturbed(4).perturbation, all[4].perturbation);
    }

    #[test]
    fn perturbations_use_all_of_their_ranges_and_nothing_beyond() {
        let all: Vec<Trial> = (0..500).map(|index| TRIAL.perturbed(index)).collect();
        type Value = fn(&Trial) -> f64;
        let spans: [(&str, Value, f64, f64); 6] = [
            ("friction", |it| it.perturbation.friction, 0.75, 1.25),
            ("torque", |it| it.perturbation.torque, 0.8, 1.2),
            ("yaw", |it| it.perturbation.yaw_rad, 0.0, TAU),
            ("push", |it| it.perturbation.push_m_s.norm(), 0.0, 0.3),
            ("moment", |it| it.perturbation.push_share, 0.5, 0.9),
            ("steps", |it| f64::from(it.steps_per_s), 200.0, 300.0),
        ];
        for (name, value, least, most) in spans {
            let values = all.iter().map(value);
            let found =
                values.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
            let margin = 0.02 * (most - least);
            assert!((least..least + margin).contains(&found[0]), "{name}: {found:?}");
            assert!((most - margin..=most).contains(&found[1]), "{name}: {found:?}");
        }
        let directions = all.iter().map(|it| it.perturbation.push_m_s).sum::<Vector3<f64>>();
        assert!(directions.norm() < 0.3 * 500.0 / 10.0 && directions.z == 0.0, "{directions}");
    }

    #[test]
    fn on_a_terrain_bodies_face_nearly_the_same_way_and_all_else_is_as_on_a_plane() {
        let mut widest = [0.0_f64; 2];
        for index in 0..500 {
            let [plane, terrain] = [TRIAL, TRIAL.on(mountain())].map(|it| it.perturbed(index));
            let yaw_rad = terrain.perturbation.yaw_rad;
            widest = [widest[0].min(yaw_rad), widest[1].max(yaw_rad)];
            let same = Perturbation { yaw_rad, ..plane.perturbation };
            assert_eq!((terrain.perturbation, terrain.steps_per_s), (same, plane.steps_per_s));
        }
        assert!((-0.2..-0.19).contains(&widest[0]), "{widest:?}");
        assert!((0.19..=0.2).contains(&widest[1]), "{widest:?}");
    }

    #[test]
    fn a_tenth_of_a_second_is_a_whole_number_of_steps_in_every_perturbed_trial() {
        for index in 0..100 {
            let trial = TRIAL.perturbed(index);
            assert_eq!(trial.time_s(trial.sample_steps()), 0.1);
            assert_eq!(trial.samples(), 80);
            let push_s = trial.time_s(trial.push_step());
            assert!((4.0..=7.2).contains(&push_s), "{push_s} s");
        }
    }
}
