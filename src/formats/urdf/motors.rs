//! What only our own files say, read: the motors, and poses to the last bit.

use super::error::{UrdfError, shortened};
use super::read::{ExactPose, MotorElement, Robot};
use crate::creature::{Controller, Joint, Morphology, Motor};
use nalgebra::{Isometry3, UnitQuaternion};
use std::collections::BTreeMap;

/// The motors do not move what has none, so any period will do.
const PERIOD_S: f64 = 0.1;

/// Poses that differ by no more than this, in metres and radians, are the same but for rounding.
const ROUNDING: f64 = 1e-9;

/// The motors of a body; `joints` are the elements of its links' joints.
///
/// # Errors
/// If a motor drives no joint.
pub fn controller(robot: &Robot, joints: &[Option<usize>]) -> Result<Controller, UrdfError> {
    let mut driven = vec![None; joints.len()];
    let Some(extension) = &robot.extension else {
        return Ok(Controller::of_waves(PERIOD_S, driven));
    };
    let links = links(robot, joints);
    for MotorElement { joint, line, wave } in &extension.motors {
        let unknown = || {
            let (line, what) = (*line, "joint");
            UrdfError::Unknown { line, what, name: shortened(joint) }
        };
        let &(link, element) = links.get(joint.as_str()).ok_or_else(unknown)?;
        let motor = Motor { torque_nm_max: robot.joints[element].effort_nm };
        driven[link] = Some((motor, *wave));
    }
    Ok(Controller::of_waves(extension.period_s, driven))
}

/// Sets the poses to the bits that the file was written from, unless its standard elements say another thing
/// because somebody changed them.
pub fn set_exactly(morphology: &mut Morphology, robot: &Robot, joints: &[Option<usize>]) {
    let Some(extension) = &robot.extension else { return };
    if let Some(exact) = extension.root_rotation {
        set_rotation(&mut morphology.root_rotation, exact);
    }
    let links = links(robot, joints);
    for ExactPose { joint, parent_from_joint, joint_from_link } in &extension.poses {
        let Some(&(link, _)) = links.get(joint.as_str()) else { continue };
        let Some(Joint { parent_from_joint: outer, joint_from_link: inner, .. }) =
            &mut morphology.links[link].joint
        else {
            continue;
        };
        if is_near(outer, parent_from_joint) && is_near(inner, joint_from_link) {
            (*outer, *inner) = (*parent_from_joint, *joint_from_link);
        }
    }
}

fn set_rotation(rotation: &mut UnitQuaternion<f64>, exact: UnitQuaternion<f64>) {
    if rotation.angle_to(&exact) <= ROUNDING {
        *rotation = exact;
    }
}

fn is_near(a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
    let off = (a.translation.vector - b.translation.vector).norm();
    off <= ROUNDING && a.rotation.angle_to(&b.rotation) <= ROUNDING
}

/// The link and the element of each joint that has both, by name.
fn links<'a>(robot: &'a Robot, joints: &[Option<usize>]) -> BTreeMap<&'a str, (usize, usize)> {
    let both = joints.iter().enumerate().filter_map(|(link, element)| Some((link, (*element)?)));
    both.map(|(link, element)| (robot.joints[element].name.as_str(), (link, element))).collect()
}
