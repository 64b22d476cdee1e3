//! Bodies in both engines: laws, terrains, and bodies that try to cheat.

pub mod bodies;
mod climbing;
mod exploits;
mod laws;
mod together;
