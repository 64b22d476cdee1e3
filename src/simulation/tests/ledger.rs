//! The ledger of momentum, kept of bodies that an engine moves.

use super::super::Engine;
use super::super::stability::Ledger;
use super::TRIAL;
use super::bodies::Body;
use super::lab::Lab;
use crate::simulation::failure::Failure;
use nalgebra::Vector3;

/// Pushes a box that lies on the ground, every half a second, and enters what it does in the ledger of one that begins
/// with a speed.
fn pushed(engine: Engine, begins_m_s: f64, pushes_m_s: &[f64]) -> Result<(), Failure> {
    let mut lab = Lab::new(engine, &Body::of([0.5, 0.3, 0.3], 90.0).build(), TRIAL);
    let mut ledger = Ledger::new(&TRIAL, 24, lab.centre_of_mass(), Vector3::x() * begins_m_s);
    for &push_m_s in pushes_m_s {
        if push_m_s > 0.0 {
            lab.world.kick(Vector3::x() * push_m_s, Vector3::zeros());
        }
        for _ in 0..5 {
            lab.run(0.1);
            ledger.enter(lab.centre_of_mass())?;
        }
    }
    Ok(())
}

#[test]
fn a_body_that_slides_to_a_halt_has_accounted_for_its_momentum() {
    for engine in Engine::ALL {
        assert_eq!(pushed(engine, 3.0, &[3.0, 0.0, 0.0, 0.0]), Ok(()), "{engine}");
    }
}

#[test]
fn a_push_from_nowhere_is_found_at_the_very_beginning_too() {
    for engine in Engine::ALL {
        for (begins_m_s, pushes_m_s) in [(3.0, &[3.0, 0.0, 0.0, 0.7, 0.0][..]), (0.0, &[0.7])] {
            let found = pushed(engine, begins_m_s, pushes_m_s);
            assert_eq!(found, Err(Failure::Unphysical), "{engine}: {pushes_m_s:?}");
        }
    }
}
