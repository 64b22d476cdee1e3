//! The solids that bodies are made of.

use nalgebra::{UnitQuaternion, Vector3, vector};
use std::f64::consts::PI;

/// The solid of a link, centred on the link's frame. Genes make cylinders and boxes; bodies that come from
/// elsewhere also have the others.
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
    /// A sphere.
    Sphere {
        /// Radius in metres.
        radius_m: f64,
    },
    /// A cylinder along the link's z axis with half a sphere at either end.
    Capsule {
        /// Radius in metres, of the half spheres too.
        radius_m: f64,
        /// Length without the half spheres, in metres.
        length_m: f64,
    },
}

impl Shape {
    /// What people call it: `cylinder`, `box`, `sphere` or `capsule`, as URDF does.
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Cylinder { .. } => "cylinder",
            Shape::Cuboid { .. } => "box",
            Shape::Sphere { .. } => "sphere",
            Shape::Capsule { .. } => "capsule",
        }
    }

    /// Volume in cubic metres.
    pub fn volume_m3(&self) -> f64 {
        match *self {
            Shape::Cylinder { length_m, .. } => self.cross_section_m2() * length_m,
            Shape::Cuboid { half_extents_m } => self.cross_section_m2() * 2.0 * half_extents_m.z,
            Shape::Sphere { radius_m } => ball_m3(radius_m),
            Shape::Capsule { radius_m, length_m } => {
                self.cross_section_m2() * length_m + ball_m3(radius_m)
            }
        }
    }

    /// Area of the cut across the link's z axis, in square metres.
    pub fn cross_section_m2(&self) -> f64 {
        match self {
            Shape::Cylinder { radius_m, .. }
            | Shape::Sphere { radius_m }
            | Shape::Capsule { radius_m, .. } => PI * (radius_m * radius_m),
            Shape::Cuboid { half_extents_m } => 4.0 * half_extents_m.x * half_extents_m.y,
        }
    }

    /// Moments of inertia about the link's axes, for a mass spread evenly over the solid, in kg·m².
    pub fn inertia_kg_m2(&self, mass_kg: f64) -> Vector3<f64> {
        match *self {
            Shape::Cylinder { radius_m, length_m } => {
                let about_z = radius_m * radius_m / 2.0;
                let across = about_z / 2.0 + length_m * length_m / 12.0;
                mass_kg * vector![across, across, about_z]
            }
            Shape::Cuboid { half_extents_m } => {
                let square = half_extents_m.component_mul(&half_extents_m) / 3.0;
                mass_kg * vector![square.y + square.z, square.x + square.z, square.x + square.y]
            }
            Shape::Sphere { radius_m } => mass_kg * Vector3::repeat(0.4 * radius_m * radius_m),
            Shape::Capsule { radius_m, length_m } => {
                let tube = Shape::Cylinder { radius_m, length_m };
                let of_ends = mass_kg * (ball_m3(radius_m) / self.volume_m3());
                // The half spheres' own, moved from their centres of mass to the capsule's.
                let arm = length_m * length_m / 4.0 + 0.375 * length_m * radius_m;
                let ends = Shape::Sphere { radius_m }.inertia_kg_m2(of_ends);
                tube.inertia_kg_m2(mass_kg - of_ends) + ends + of_ends * vector![arm, arm, 0.0]
            }
        }
    }

    /// Half the size of the smallest box around the solid, along the link's axes, in metres.
    pub fn half_extents_m(&self) -> Vector3<f64> {
        match *self {
            Shape::Cylinder { radius_m, length_m } => vector![radius_m, radius_m, length_m / 2.0],
            Shape::Cuboid { half_extents_m } => half_extents_m,
            Shape::Sphere { radius_m } => Vector3::repeat(radius_m),
            Shape::Capsule { radius_m, length_m } => {
                vector![radius_m, radius_m, length_m / 2.0 + radius_m]
            }
        }
    }

    /// How far the solid reaches from its centre along a world direction, given its rotation, in metres.
    pub fn reach_m(&self, rotation: &UnitQuaternion<f64>, direction: &Vector3<f64>) -> f64 {
        let local = rotation.inverse_transform_vector(direction);
        let half = self.half_extents_m();
        match *self {
            Shape::Cylinder { radius_m, .. } => {
                radius_m * libm::hypot(local.x, local.y) + half.z * local.z.abs()
            }
            Shape::Cuboid { .. } => half.dot(&local.abs()),
            Shape::Sphere { radius_m } => radius_m * local.norm(),
            Shape::Capsule { radius_m, length_m } => {
                radius_m * local.norm() + length_m / 2.0 * local.z.abs()
            }
        }
    }

    /// The distance of the solid's farthest point from its centre, in metres.
    pub fn farthest_m(&self) -> f64 {
        match *self {
            Shape::Cylinder { radius_m, length_m } => libm::hypot(radius_m, length_m / 2.0),
            Shape::Cuboid { half_extents_m } => half_extents_m.norm(),
            Shape::Sphere { radius_m } => radius_m,
            Shape::Capsule { radius_m, length_m } => radius_m + length_m / 2.0,
        }
    }

    /// Where a ray from the centre leaves the solid, in metres, where `direction` is measured in half
    /// extents; for a direction of zero the end of the z axis.
    pub fn surface_m(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let longest = direction.amax();
        let cube = if longest > 0.0 { direction / longest } else { Vector3::z() };
        let unit = match *self {
            Shape::Cuboid { .. } => cube,
            // Squeezes the square cross-section of the cube into the circle of the cylinder.
            Shape::Cylinder { .. } => match libm::hypot(cube.x, cube.y) {
                0.0 => cube,
                round => {
                    let square = cube.x.abs().max(cube.y.abs());
                    vector![cube.x * square / round, cube.y * square / round, cube.z]
                }
            },
            Shape::Sphere { .. } => cube.normalize(),
            Shape::Capsule { radius_m, length_m } => {
                let ray = cube.component_mul(&self.half_extents_m());
                return ray * leaves_capsule_at(&ray, radius_m, length_m / 2.0);
            }
        };
        unit.component_mul(&self.half_extents_m())
    }
}

fn ball_m3(radius_m: f64) -> f64 {
    4.0 / 3.0 * PI * (radius_m * radius_m * radius_m)
}

/// By how much a ray from the centre must be stretched to end on a capsule whose half spheres are centred
/// `half_m` above and below.
fn leaves_capsule_at(ray: &Vector3<f64>, radius_m: f64, half_m: f64) -> f64 {
    let across = libm::hypot(ray.x, ray.y);
    if across > 0.0 && (ray.z * radius_m / across).abs() <= half_m {
        return radius_m / across;
    }
    // The larger root of |t·ray - (0, 0, ±half)| = radius.
    let (squared, along) = (ray.norm_squared(), ray.z.abs() * half_m);
    (along + (along * along - squared * (half_m * half_m - radius_m * radius_m)).sqrt()) / squared
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_ray_from_the_centre_ends_on_the_solid() {
        let cylinder = Shape::Cylinder { radius_m: 0.5, length_m: 4.0 };
        let on_wall = cylinder.surface_m(&vector![1.0, 1.0, 0.0]);
        assert!((libm::hypot(on_wall.x, on_wall.y) - 0.5).abs() < 1e-12);
        assert_eq!(cylinder.surface_m(&vector![0.0, 0.0, -0.3]), vector![0.0, 0.0, -2.0]);
        assert_eq!(cylinder.surface_m(&Vector3::zeros()), vector![0.0, 0.0, 2.0]);
        let cuboid = Shape::Cuboid { half_extents_m: vector![1.0, 2.0, 3.0] };
        assert_eq!(cuboid.surface_m(&vector![0.1, 0.2, -0.05]), vector![0.5, 2.0, -0.75]);
        let sphere = Shape::Sphere { radius_m: 2.0 };
        assert!((sphere.surface_m(&vector![1.0, -2.0, 0.5]).norm() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_ray_leaves_a_capsule_at_a_radius_from_its_middle_line() {
        let capsule = Shape::Capsule { radius_m: 0.5, length_m: 2.0 };
        assert_eq!(capsule.surface_m(&Vector3::zeros()), vector![0.0, 0.0, 1.5]);
        for direction in [vector![1.0, 0.0, 0.0], vector![0.3, -0.4, 0.9], vector![1.0, 1.0, 0.5]] {
            let point = capsule.surface_m(&direction);
            let nearest = vector![0.0, 0.0, point.z.clamp(-1.0, 1.0)];
            assert!(((point - nearest).norm() - 0.5).abs() < 1e-12, "{direction}: {point}");
        }
    }

    #[test]
    fn a_solid_resists_turning_as_one_of_its_mass_does() {
        let cylinder = Shape::Cylinder { radius_m: 2.0, length_m: 6.0 };
        assert_eq!(cylinder.inertia_kg_m2(3.0), vector![12.0, 12.0, 6.0]);
        let cuboid = Shape::Cuboid { half_extents_m: vector![3.0, 3.0, 6.0] };
        assert_eq!(cuboid.inertia_kg_m2(2.0), vector![30.0, 30.0, 12.0]);
        let sphere = Shape::Sphere { radius_m: 0.5 };
        assert_eq!(sphere.inertia_kg_m2(2.0), Vector3::repeat(0.2));
    }

    /// Sums over small cubes what a solid that takes in `is_inside` weighs and resists.
    fn summed(half: Vector3<f64>, is_inside: impl Fn(&Vector3<f64>) -> bool) -> Vector3<f64> {
        const CUBES: i32 = 60;
        let (mut count, mut sum) = (0.0, Vector3::zeros());
        let at = |i: i32, half: f64| ((f64::from(i) + 0.5) / f64::from(CUBES) * 2.0 - 1.0) * half;
        for (x, y, z) in (0..CUBES.pow(3)).map(|i| (i % 60, i / 60 % 60, i / 3600)) {
            let p = vector![at(x, half.x), at(y, half.y), at(z, half.z)];
            if is_inside(&p) {
                let square = p.component_mul(&p);
                count += 1.0;
                sum += vector![square.y + square.z, square.x + square.z, square.x + square.y];
            }
        }
        sum / count
    }

    #[test]
    fn a_capsule_weighs_and_resists_as_the_sum_of_its_grains() {
        let capsule = Shape::Capsule { radius_m: 0.5, length_m: 1.4 };
        let grains = summed(capsule.half_extents_m(), |p| {
            (p - vector![0.0, 0.0, p.z.clamp(-0.7, 0.7)]).norm() <= 0.5
        });
        let found = capsule.inertia_kg_m2(1.0);
        assert!((found - grains).norm() < 0.003, "{found} {grains}");
        let long = Shape::Cylinder { radius_m: 0.5, length_m: 1.4 };
        let ball = Shape::Sphere { radius_m: 0.5 };
        assert!((capsule.volume_m3() - long.volume_m3() - ball.volume_m3()).abs() < 1e-12);
    }

    #[test]
    fn volume_and_reach_are_those_of_the_solid() {
        let cylinder = Shape::Cylinder { radius_m: 0.5, length_m: 2.0 };
        assert!((cylinder.volume_m3() - PI / 2.0).abs() < 1e-12);
        let lying = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
        assert!((cylinder.reach_m(&lying, &Vector3::z()) - 0.5).abs() < 1e-12);
        assert!((cylinder.reach_m(&lying, &Vector3::x()) - 1.0).abs() < 1e-12);
        let capsule = Shape::Capsule { radius_m: 0.5, length_m: 2.0 };
        assert!((capsule.reach_m(&lying, &Vector3::z()) - 0.5).abs() < 1e-12);
        assert!((capsule.reach_m(&lying, &Vector3::x()) - 1.5).abs() < 1e-12);
        let tilted = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.7);
        let sphere = Shape::Sphere { radius_m: 0.3 };
        assert!((sphere.reach_m(&tilted, &Vector3::z()) - 0.3).abs() < 1e-12);
    }
}
