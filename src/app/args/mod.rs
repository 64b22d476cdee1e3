//! What can be said on the command line, as clap reads it: `cli` has the commands, `settings` the flags that follow from
//! the settings of a run, `body_args` and `terrain_args` what is said of bodies and of what they stand on.

pub mod body_args;
pub mod cli;
pub mod settings;
pub mod terrain_args;
