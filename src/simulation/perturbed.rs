//! Trials with their perturbations.

use super::perturbation::Perturbation;
use super::terrain::Ground;
use super::trial::Trial;

/// Steps a second are a multiple of this, so that motor updates and positions on the track, which are tenths of a
/// second apart, are so with all of them.
const RATE_UNIT: f64 = 10.0;

impl Trial {
    /// The same trial with its `index`-th perturbation, and at other steps.
    pub fn perturbed(&self, index: u32) -> Self {
        let (drawn, rate_share) = Perturbation::draw(index);
        let perturbation = match &self.ground {
            Ground::Plane => drawn,
            Ground::Terrain(_) => drawn.facing_ahead(),
        };
        let rate = f64::from(self.steps_per_s) * rate_share;
        let steps_per_s = ((rate / RATE_UNIT).round() * RATE_UNIT) as u32;
        Self { steps_per_s, perturbation, ..self.clone() }
    }

    /// The same trial without a push, for scores that one would be a free gain of.
    pub fn unpushed(&self) -> Self {
        let none = Perturbation::NONE;
        let Perturbation { push_m_s, push_share, .. } = none;
        let perturbation = Perturbation { push_m_s, push_share, ..self.perturbation };
        Self { perturbation, ..self.clone() }
    }

    /// After how many scored steps the body is pushed: when a position of the track was taken, so that the track shows
    /// the velocities of before and after it apart.
    pub(super) fn push_step(&self) -> u32 {
        let sample = (self.perturbation.push_share * self.samples() as f64).round() as u32;
        sample * self.sample_steps()
    }
}

#[cfg(test)]
mod tests {
    use super::super::medium::Medium;
    use super::super::start::Start;
    use super::super::terrain::mountain;
    use super::super::trial::Guards;
    use super::*;
    use nalgebra::Vector3;
    use std::f64::consts::TAU;

    const TRIAL: Trial = Trial {
        steps_per_s: 240,
        perturbation: Perturbation::NONE,
        gravity_m_s2: 9.81,
        ground: Ground::Plane,
        medium: Medium::Void,
        start: Start::LowestAt(0.0),
        settle_s: 0.5,
        scored_s: 8.0,
        guards: Guards::ALL,
        others: Vec::new(),
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
