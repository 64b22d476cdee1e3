//! The program as people use it: its commands, what it shows, and its own house rules.

mod circles;
mod cleaning;
mod cli;
mod experiment;
#[cfg(feature = "view")]
mod kept_film;
mod problems;
mod readme;
#[cfg(feature = "view")]
mod recording;
#[cfg(feature = "view")]
mod replay;
mod run;
mod search;
mod tidy;
#[cfg(feature = "view")]
mod watching;
