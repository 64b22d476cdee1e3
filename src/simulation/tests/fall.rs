//! Free fall.

use super::super::Engine;
use super::super::start::Start;
use super::super::trial::Trial;
use super::bodies::{Body, limbs};
use super::lab::Lab;
use super::{GRAVITY_M_S2, TRIAL};
use nalgebra::Vector3;

#[test]
fn whatever_falls_freely_falls_by_half_g_t_squared() {
    for engine in Engine::ALL {
        for creature in [Body::of([0.1, 0.2, 0.3], 2.0).build(), limbs(3.0)] {
            let mut lab =
                Lab::new(engine, &creature, Trial { start: Start::RootAt(10.0), ..TRIAL });
            let start_m = lab.centre_of_mass();
            lab.run(1.0);
            let moved_m = lab.centre_of_mass() - start_m;
            // Over a step an engine moves by the velocity at its end: half a step ahead.
            let fallen_m = 0.5 * GRAVITY_M_S2 * (1.0 + lab.step_s());
            let error_m = (moved_m + Vector3::z() * fallen_m).norm();
            assert!(error_m < 1e-4, "{engine}: {moved_m:?}");
        }
    }
}
