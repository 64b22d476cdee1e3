//! What the program promises: the same bits, whatever dies, and claims that hold.

mod asynchrony;
mod chaos;
pub mod determinism;
mod faults;
mod resume;
mod robustness;
mod survival;
mod validation;
mod verify;
