//! The bodies of the fuzz targets: those of the suite.

#[path = "../hostile/bodies.rs"]
pub mod bodies;
#[path = "../hostile/pieces.rs"]
pub mod pieces;
#[path = "../hostile/wire.rs"]
pub mod wire;
