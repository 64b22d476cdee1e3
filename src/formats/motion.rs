//! How a body moved, as CSV: a row a link and frame.

use crate::simulation::{Pose, Trajectory};
use std::io::{self, Write};

/// The columns: time in seconds, link from 0, the centre of its solid in metres, its rotation as a unit quaternion.
pub const HEADER: &str = "time_s,link,x_m,y_m,z_m,qx,qy,qz,qw";

/// Writes every frame of a film.
///
/// # Errors
/// If the output cannot be written.
pub fn write(film: &Trajectory, mut output: impl Write) -> io::Result<()> {
    writeln!(output, "{HEADER}")?;
    for (time_s, poses) in film.times_s.iter().zip(&film.poses) {
        for (link, pose) in poses.iter().enumerate() {
            let Pose { position_m: [x, y, z], rotation_xyzw: [i, j, k, w] } = pose;
            writeln!(output, "{time_s},{link},{x},{y},{z},{i},{j},{k},{w}")?;
        }
    }
    Ok(())
}
