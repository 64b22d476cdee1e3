//! How evaluations of creatures end: what physics calls a failure is one that evolution counts.

use crate::evolution::{Failure, Outcome};
use crate::simulation;

/// A part moved faster than anything healthy does.
pub const TOO_FAST: Outcome = Outcome::Failed(Failure::new(3, "too fast"));
/// The body left the ground by more than a jump explains, or its terrain.
pub const LAUNCHED: Outcome = Outcome::Failed(Failure::new(4, "launched"));
/// The body gained more momentum than gravity and friction can give.
pub const UNPHYSICAL: Outcome = Outcome::Failed(Failure::new(5, "momentum out of nothing"));

/// Every outcome of a creature's evaluation, in the order in which they are printed.
pub const ALL: [Outcome; 7] = [
    Outcome::Scored,
    Outcome::TooLarge,
    Outcome::NotFinite,
    TOO_FAST,
    LAUNCHED,
    UNPHYSICAL,
    Outcome::Panicked,
];

impl From<simulation::Failure> for Outcome {
    fn from(failure: simulation::Failure) -> Self {
        match failure {
            simulation::Failure::NotFinite => Outcome::NotFinite,
            simulation::Failure::TooFast => TOO_FAST,
            simulation::Failure::Launched => LAUNCHED,
            simulation::Failure::Unphysical => UNPHYSICAL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_called_the_same_in_physics_and_in_evolution() {
        use simulation::Failure::{Launched, NotFinite, TooFast, Unphysical};
        for failure in [NotFinite, TooFast, Launched, Unphysical] {
            assert_eq!(Outcome::from(failure).to_string(), failure.to_string());
        }
    }
}
