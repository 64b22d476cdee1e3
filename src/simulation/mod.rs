//! Bodies in motion: a trial under an engine.
//!
//! A [`Trial`] says how a body is tried and [`assembly`] what physics sees of it, or of several. An [`Engine`] moves
//! it through the [`world`], [`Engine::Rapier`] or [`Engine::Featherstone`], on a [`terrain`] or a plane and through a
//! [`medium`]. Its brain gets what it [`feels`] and commands its motors; [`settling`] brings it to rest before it is
//! scored, [`stability`] ends what has blown up, [`trajectory`] is what can be seen of it, and [`measurement`] what a
//! task scores. [`perturbation`] says what may differ from one trial of a body to the next. An attempt is a trial
//! under way; [`simulate`] runs one, [`film_together`] one of several bodies, and several trials of one body go
//! abreast, which is faster and changes no bit.
//!
//! Architecture invariant: files import from one another in one direction, and nothing here knows what a trial is worth.

mod abreast;
pub mod assembly;
mod attempt;
pub mod engine;
pub mod failure;
mod featherstone;
pub mod feels;
mod lanes;
pub mod lattice;
pub mod measurement;
pub mod medium;
pub mod perturbation;
mod perturbed;
mod rapier;
mod rapier_shape;
mod run;
mod scored;
pub mod settling;
pub mod stability;
pub mod start;
mod surroundings;
pub mod terrain;
#[cfg(test)]
mod tests;
pub mod trajectory;
pub mod trial;
pub mod world;

pub use abreast::{Abreast, at_a_time, simulate_abreast, simulate_each};
pub use assembly::Entrant;
pub use engine::Engine;
pub use failure::Failure;
pub use measurement::{Measurement, Poses, TRACK_SAMPLE_S};
pub use medium::Medium;
pub use perturbation::Perturbation;
pub use run::{CannotCollide, Meeting, check, film, film_together, simulate};
pub use start::Start;
pub use terrain::{Ground, Terrain};
pub use trajectory::{Pose, Trajectory};
pub use trial::{Guards, Other, Trial};
