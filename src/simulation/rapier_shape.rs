//! What rapier makes of a terrain, kept with it. Terrains and rapier both know this file, and so need not know each other.

use rapier3d::prelude::SharedShape;
use std::sync::OnceLock;

/// The shape of a terrain, built when it is first needed: every trial stands on the same one.
#[derive(Clone, Default)]
pub struct GroundShape(pub OnceLock<SharedShape>);

impl PartialEq for GroundShape {
    /// It follows from the heights.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

// Nothing ever changes the shape once it is there.
impl std::panic::RefUnwindSafe for GroundShape {}
