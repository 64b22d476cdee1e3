//! The monitor's process: films what the islands write down, and serves it live. It only looks: a run without
//! it loses nothing but the film, and a monitor that dies loses nothing at all, since another one makes the
//! same film anew. `logs` reads what the islands wrote, `film_recorder` films it, `news` is what it tells, `ancestry` says
//! whose family is seen, and `show` when.

use crate::app::args::cli::MonitorArgs;
use crate::runs::Failure;

#[cfg(feature = "view")]
mod ancestry;
#[cfg(feature = "view")]
mod film_recorder;
#[cfg(feature = "view")]
mod logs;
#[cfg(feature = "view")]
mod news;
#[cfg(feature = "view")]
mod show;

/// Records and serves the run in a folder: one that is over, to its end; one that is under way, until it ends
/// or the launcher or the user stops it.
///
/// # Errors
/// If there is no run or nothing to film, another monitor is at it, or the recording cannot be written.
#[cfg(feature = "view")]
pub fn run(args: &MonitorArgs) -> Result<(), Failure> {
    show::run(args)
}

/// Says that this program cannot.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &MonitorArgs) -> Result<(), Failure> {
    Err(Failure::usage("this program was built without the feature “view”, and cannot record"))
}
