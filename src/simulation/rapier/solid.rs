//! The colliders of a body's solids.

use super::convert::to_rapier;
use super::surface;
use crate::creature::{Inertia, Shape};
use crate::simulation::assembly::Solid;
use nalgebra::{Isometry3, Vector3};
use rapier3d::prelude as rapier;
use std::f64::consts::FRAC_PI_2;

/// The collider of a solid that belongs to the body of a number.
pub fn collider(solid: &Solid, groups: rapier::InteractionGroups) -> rapier::ColliderBuilder {
    let (builder, solid_from_collider) = match solid.shape {
        Shape::Cylinder { radius_m, length_m } => (
            rapier::ColliderBuilder::cylinder((length_m / 2.0) as f32, radius_m as f32),
            // rapier's cylinders run along y, ours along z.
            Isometry3::rotation(Vector3::x() * FRAC_PI_2),
        ),
        Shape::Cuboid { half_extents_m: half } => (
            rapier::ColliderBuilder::cuboid(half.x as f32, half.y as f32, half.z as f32),
            Isometry3::identity(),
        ),
        Shape::Sphere { radius_m } => {
            (rapier::ColliderBuilder::ball(radius_m as f32), Isometry3::identity())
        }
        Shape::Capsule { radius_m, length_m } => (
            rapier::ColliderBuilder::capsule_z((length_m / 2.0) as f32, radius_m as f32),
            Isometry3::identity(),
        ),
    };
    let pose = to_rapier(&(solid.part_from_solid * solid_from_collider));
    let collider = surface::collider(builder, groups).position(pose);
    match &solid.inertia {
        None => collider.mass(solid.mass_kg as f32),
        Some(inertia) => {
            collider.mass_properties(mass_properties(solid.mass_kg, inertia, &solid_from_collider))
        }
    }
}

fn mass_properties(
    mass_kg: f64,
    inertia: &Inertia,
    solid_from_collider: &Isometry3<f64>,
) -> rapier::MassProperties {
    let centre_m = solid_from_collider.inverse_transform_point(&inertia.centre_m.into());
    let axes = solid_from_collider.rotation.to_rotation_matrix();
    let moments = axes.transpose() * inertia.about_centre_kg_m2 * axes;
    let column = |i| {
        let column = moments.column(i).into_owned().cast::<f32>();
        rapier::Vector::new(column.x, column.y, column.z)
    };
    rapier::MassProperties::with_inertia_matrix(
        rapier::Vector::new(centre_m.x as f32, centre_m.y as f32, centre_m.z as f32),
        mass_kg as f32,
        rapier::Matrix::from_cols(column(0), column(1), column(2)),
    )
}
