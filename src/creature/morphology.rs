//! A body: rigid links in a tree of joints.

use nalgebra::{Isometry3, Point3, UnitVector3, Vector3};
use std::f64::consts::PI;

/// The solid of a link, centred on the link's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A cylinder along the link's z axis.
    Cylinder {
        /// Radius in metres.
        radius_m: f64,
        /// Length in metres.
        length_m: f64,
    },
    /// A box.
    Cuboid {
        /// Half its size along the link's x, y and z axes, in metres.
        half_extents_m: Vector3<f64>,
    },
}
