//! What a body feels, in any engine: the senses of its brain.

use super::assembly::{Assembly, Hinge, Member};
use super::world::{self, World};
use crate::creature::brain::{JointSense, Senses};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// What a body feels now.
pub fn senses(world: &(impl World + ?Sized), assembly: &Assembly, body: &Member) -> Senses {
    let mut senses = Senses {
        joints: vec![JointSense::default(); body.links.len()],
        touches: Vec::with_capacity(body.links.len()),
        world_from_links: Vec::with_capacity(body.links.len()),
    };
    let mut next_part = body.parts.start;
    for (index, link) in body.links.clone().enumerate() {
        let part = assembly.places[link].part;
        senses.touches.push(world.touches(part));
        senses.world_from_links.push(world::link_pose(world, assembly, link));
        // The first link of a part is the one that hangs on its hinge.
        if part == next_part {
            next_part += 1;
            if let Some(hinge) = &assembly.parts[part].hinge {
                senses.joints[index] = joint(world, part, hinge);
            }
        }
    }
    senses
}

/// What a hinge feels: it turns about the x axis of its frame.
fn joint(world: &(impl World + ?Sized), part: usize, hinge: &Hinge) -> JointSense {
    let rest = world.world_from_part(hinge.parent).rotation * hinge.parent_from_hinge.rotation;
    let turned = world.world_from_part(part).rotation * hinge.part_from_hinge.rotation;
    let turn = rest.inverse() * turned;
    let angle_rad = 2.0 * libm::atan2(turn.i, turn.w);
    let rate_rad_s = world.turn_rad_s(part) - world.turn_rad_s(hinge.parent);
    JointSense {
        angle_rad: if angle_rad > PI {
            angle_rad - TAU
        } else if angle_rad < -PI {
            angle_rad + TAU
        } else {
            angle_rad
        },
        rate_rad_s: rate_rad_s.dot(&(rest * Vector3::x())),
    }
}
