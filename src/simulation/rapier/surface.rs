//! What touches what, and how it rubs.

use crate::simulation::trial::FRICTION;
use rapier3d::prelude::*;

/// The ground belongs to this group and touches all bodies. Each body has a group of its own: its links never touch each
/// other, since most overlap their neighbours at birth.
const GROUND: Group = Group::GROUP_1;

/// The groups of the ground.
pub fn of_ground() -> InteractionGroups {
    groups(GROUND, GROUND.complement())
}

/// The groups of a body, by its number: beyond the 31st, bodies share them, and pass through each other.
pub fn of_body(number: usize, collides: bool) -> InteractionGroups {
    let own = Group::from_bits_truncate(GROUND.bits() << (1 + number % 31));
    groups(own, if collides { own.complement() } else { GROUND })
}

fn groups(of: Group, touches: Group) -> InteractionGroups {
    InteractionGroups::new(of, touches, InteractionTestMode::And)
}

/// A collider with the usual surface.
pub fn collider(builder: ColliderBuilder, groups: InteractionGroups) -> ColliderBuilder {
    builder
        .friction(FRICTION as f32)
        .friction_combine_rule(CoefficientCombineRule::Multiply)
        .collision_groups(groups)
}
