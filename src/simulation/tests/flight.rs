//! What nothing acts on from outside keeps its momentum and its spin.

use super::super::start::Start;
use super::super::trial::{Guards, Trial};
use super::super::{Engine, simulate};
use super::SPACE;
use super::bodies::limbs;
use super::lab::Lab;
use crate::creature::encodings::course::PARAMETER_COUNT;
use crate::creature::{Gene, Profile, express};
use nalgebra::Vector3;

/// Moves every limb to and fro for two seconds, and watches.
fn flail(lab: &mut Lab, mut watch: impl FnMut(&mut Lab)) {
    for tick in 0..20 {
        for part in 1..4 {
            let direction = if (tick / 5 + part) % 2 == 0 { 1.0 } else { -1.0 };
            lab.world.drive(part, direction * 2.0);
        }
        lab.run(0.1);
        watch(lab);
    }
}

/// An engine that turns axes by where they were when a step began loses a percent or two in two seconds; with a
/// sixteenth of the step it must be far less.
#[test]
fn limbs_that_flail_in_empty_space_change_neither_momentum_nor_spin() {
    let (push_m_s, turn_rad_s) = (Vector3::new(0.5, -0.3, 0.2), Vector3::new(1.0, 2.0, -1.5));
    for engine in Engine::ALL {
        for (steps_per_s, tolerance) in [(240, 0.02), (3840, 0.004)] {
            let space = || Trial { steps_per_s, ..SPACE };
            let kicked = |factor: f64| {
                let mut lab = Lab::new(engine, &limbs(0.3), space());
                lab.world.kick(push_m_s * factor, turn_rad_s * factor);
                lab
            };
            let whole = kicked(1.0).motion();
            for factor in [0.0, 1.0] {
                let mut lab = kicked(factor);
                let start = lab.motion();
                flail(&mut lab, |lab| {
                    let motion = lab.motion();
                    let pushed = (motion.momentum - start.momentum).norm() / whole.momentum.norm();
                    let turned = (motion.spin - start.spin).norm() / whole.spin.norm();
                    assert!(pushed < tolerance / 2.0, "{engine}: {pushed} at {steps_per_s} Hz");
                    assert!(turned < tolerance, "{engine}: {turned} at {steps_per_s} Hz");
                });
            }
        }
    }
}

#[test]
fn nothing_that_a_body_does_in_empty_space_moves_its_centre_of_mass() {
    let (root, mut fixed, mut limb) =
        (Gene([0.5; PARAMETER_COUNT]), Gene([0.7; PARAMETER_COUNT]), Gene([0.3; PARAMETER_COUNT]));
    (fixed.0[5], fixed.0[6]) = (0.9, 0.0);
    (limb.0[5], limb.0[6], limb.0[15]) = (0.1, 0.0, 0.9);
    let creature = express(&[root, fixed, limb], Profile::Native, 8).unwrap();
    let trial = Trial { start: Start::RootAt(10.0), scored_s: 4.0, guards: Guards::ALL, ..SPACE };
    for engine in Engine::ALL {
        let measured = simulate(&creature, &trial, engine).unwrap();
        let root_m = (measured.root_last_m - measured.root_first_m).norm();
        let centre_m = (measured.centre_last_m - measured.centre_first_m).norm();
        assert!(root_m > 0.005 && centre_m < 0.003, "{engine}: {measured:?}");
    }
}
