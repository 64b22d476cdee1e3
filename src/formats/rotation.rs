//! Rotations as URDF says them.

use nalgebra::UnitQuaternion;

/// Roll, pitch and yaw about fixed axes, in radians.
///
/// Exact at a pitch of a quarter turn too, where nalgebra's arcsine is only good to 1e-8: the roll is what is
/// left after yaw and pitch are taken away, whatever yaw the rounding made up there.
pub fn roll_pitch_yaw_rad(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let m = rotation.to_rotation_matrix();
    let yaw = libm::atan2(m[(1, 0)], m[(0, 0)]);
    let pitch = libm::atan2(-m[(2, 0)], libm::hypot(m[(0, 0)], m[(1, 0)]));
    let (sin, cos) = libm::sincos(yaw);
    let roll = libm::atan2(sin * m[(0, 2)] - cos * m[(1, 2)], cos * m[(1, 1)] - sin * m[(0, 1)]);
    // Adding zero turns -0 into 0.
    [roll + 0.0, pitch + 0.0, yaw + 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_angles_give_back_the_rotation_even_at_a_pitch_of_a_quarter_turn() {
        let pitches = [0.0, 0.7, FRAC_PI_2, FRAC_PI_2 - 1e-9, 1e-7 - FRAC_PI_2, -FRAC_PI_2];
        for pitch in pitches {
            for roll in [-3.0, -1.0, 0.0, 2.0] {
                for yaw in [-2.5, 0.0, 0.4, 3.1] {
                    let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
                    let [r, p, y] = roll_pitch_yaw_rad(&rotation);
                    let again = UnitQuaternion::from_euler_angles(r, p, y);
                    let off = (rotation.inverse() * again).vector().norm();
                    assert!(off < 1e-14, "{roll} {pitch} {yaw}: off by {off}");
                }
            }
        }
    }
}
