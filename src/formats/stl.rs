//! Bodies as STL, for people who print them: one closed surface a link, all in rest pose, in binary.
//!
//! STL knows no units; what prints reads millimetres.

use crate::creature::{Morphology, Shape};
use nalgebra::{Isometry3, Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::{self, Write};

/// Corners of a circle.
const CORNERS: usize = 64;
/// Bytes before the number of triangles; they must not begin with `solid`.
const HEADER: &[u8] = b"islands";
const HEADER_BYTES: usize = 80;

/// A closed surface: its corners, and triangles of them that are seen from outside counterclockwise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Corners.
    pub corners: Vec<Point3<f64>>,
    /// Three corners each.
    pub triangles: Vec<[usize; 3]>,
}

/// Writes a body in rest pose, its lowest point at height 0; `units_per_m` are 1000 for millimetres in full size.
///
/// # Errors
/// If the output cannot be written.
pub fn write(morphology: &Morphology, units_per_m: f64, output: impl Write) -> io::Result<()> {
    let lowest_m = morphology.lowest_m();
    let links = morphology.links.iter().zip(morphology.rest_poses());
    let meshes: Vec<Mesh> = links
        .map(|(link, mut pose)| {
            pose.translation.z -= lowest_m;
            Mesh::of(&link.shape).placed(&pose)
        })
        .collect();
    write_meshes(&meshes, units_per_m, output)
}

/// Writes the solid of one link by itself, standing on its end.
///
/// # Errors
/// If the output cannot be written.
pub fn write_link(shape: &Shape, units_per_m: f64, output: impl Write) -> io::Result<()> {
    let lift = Isometry3::translation(0.0, 0.0, shape.half_extents_m().z);
    write_meshes(&[Mesh::of(shape).placed(&lift)], units_per_m, output)
}

fn write_meshes(meshes: &[Mesh], units_per_m: f64, mut output: impl Write) -> io::Result<()> {
    let mut header = [b' '; HEADER_BYTES];
    header[..HEADER.len()].copy_from_slice(HEADER);
    output.write_all(&header)?;
    let count: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    output.write_all(&(count as u32).to_le_bytes())?;
    for mesh in meshes {
        let corners: Vec<Vector3<f32>> =
            mesh.corners.iter().map(|corner| (corner.coords * units_per_m).cast()).collect();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| corners[corner]);
            let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
            for number in [normal, a, b, c].iter().flat_map(|vector| vector.iter()) {
                output.write_all(&number.to_le_bytes())?;
            }
            output.write_all(&[0; 2])?;
        }
    }
    Ok(())
}

impl Mesh {
    /// The surface of a solid.
    pub fn of(shape: &Shape) -> Self {
        match *shape {
            Shape::Cuboid { half_extents_m } => Self::cuboid(&half_extents_m),
            Shape::Cylinder { radius_m, length_m } => {
                let half = length_m / 2.0;
                Self::turned(&[[0.0, -half], [radius_m, -half], [radius_m, half], [0.0, half]])
            }
            Shape::Sphere { radius_m } => Self::turned(&arc(radius_m, 0.0)),
            Shape::Capsule { radius_m, length_m } => Self::turned(&arc(radius_m, length_m / 2.0)),
        }
    }

    /// The same surface elsewhere.
    pub fn placed(mut self, pose: &Isometry3<f64>) -> Self {
        self.corners.iter_mut().for_each(|corner| *corner = pose * *corner);
        self
    }

    fn cuboid(half: &Vector3<f64>) -> Self {
        let side =
            |i: usize, axis: usize| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] };
        let corners = (0..8).map(|i| Point3::new(side(i, 0), side(i, 1), side(i, 2))).collect();
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Self { corners, triangles }
    }

    /// Turns a line of points (radius, height) about the z axis; it goes upwards and begins and ends on the axis.
    fn turned(line: &[[f64; 2]]) -> Self {
        let mut mesh = Self::default();
        let [first, rings @ .., last] = line else { return mesh };
        mesh.corners.push(Point3::new(0.0, 0.0, first[1]));
        for [radius, height] in rings {
            for corner in 0..CORNERS {
                let (sin, cos) = libm::sincos(TAU * corner as f64 / CORNERS as f64);
                mesh.corners.push(Point3::new(radius * cos, radius * sin, *height));
            }
        }
        mesh.corners.push(Point3::new(0.0, 0.0, last[1]));
        let at = |ring: usize, corner: usize| 1 + ring * CORNERS + corner % CORNERS;
        let (top, end) = (rings.len() - 1, mesh.corners.len() - 1);
        for corner in 0..CORNERS {
            mesh.triangles.push([0, at(0, corner + 1), at(0, corner)]);
            for ring in 0..top {
                let [a, b] = [at(ring, corner), at(ring, corner + 1)];
                let [c, d] = [at(ring + 1, corner + 1), at(ring + 1, corner)];
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
            mesh.triangles.push([at(top, corner), at(top, corner + 1), end]);
        }
        mesh
    }
}

/// Half a circle from its lowest to its highest point, pulled apart by `half_m` upwards and downwards.
fn arc(radius_m: f64, half_m: f64) -> Vec<[f64; 2]> {
    let steps = CORNERS / 4;
    let quarter = |sign: f64| {
        move |step: usize| {
            let angle = FRAC_PI_2 * step as f64 / steps as f64;
            let (sin, cos) = libm::sincos(angle);
            [radius_m * cos, sign * (half_m + radius_m * sin)]
        }
    };
    let pole = half_m + radius_m;
    let below = (0..steps).rev().map(quarter(-1.0));
    // Without a length the two quarters share their ring.
    let above = (usize::from(half_m == 0.0)..steps).map(quarter(1.0));
    let ends = [[0.0, -pole], [0.0, pole]];
    std::iter::once(ends[0]).chain(below).chain(above).chain([ends[1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn shapes() -> [Shape; 4] {
        [
            Shape::Cuboid { half_extents_m: Vector3::new(0.1, 0.2, 0.3) },
            Shape::Cylinder { radius_m: 0.2, length_m: 0.7 },
            Shape::Sphere { radius_m: 0.4 },
            Shape::Capsule { radius_m: 0.3, length_m: 0.5 },
        ]
    }

    #[test]
    fn every_edge_of_a_surface_is_met_by_two_triangles_in_opposite_directions() {
        for shape in shapes() {
            let mesh = Mesh::of(&shape);
            let mut edges: BTreeMap<(usize, usize), i32> = BTreeMap::new();
            for [a, b, c] in &mesh.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let edge = (*from.min(to), *from.max(to));
                    let sign = if from < to { 1 } else { -1 };
                    let sum = edges.entry(edge).or_insert(10);
                    *sum += sign + 10;
                }
            }
            assert!(edges.values().all(|&sum| sum == 30), "{shape:?}");
        }
    }

    #[test]
    fn a_surface_encloses_nearly_the_volume_of_its_solid_from_outside() {
        for shape in shapes() {
            let mesh = Mesh::of(&shape);
            let volume_m3: f64 = mesh
                .triangles
                .iter()
                .map(|t| t.map(|corner| mesh.corners[corner].coords))
                .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0)
                .sum();
            let share = volume_m3 / shape.volume_m3();
            assert!((0.99..1.0 + 1e-12).contains(&share), "{shape:?}: {share}");
        }
    }

    #[test]
    fn a_file_is_as_long_as_its_triangles_need() {
        let mut bytes = Vec::new();
        write_link(&shapes()[0], 1000.0, &mut bytes).unwrap();
        assert_eq!(bytes.len(), HEADER_BYTES + 4 + 12 * 50);
        let z = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let corners = (0..12).flat_map(|t| (1..4).map(move |c| 84 + t * 50 + c * 12 + 8));
        let heights: Vec<f32> = corners.map(z).collect();
        assert!(heights.iter().all(|&z| z == 0.0 || z == 600.0), "{heights:?}");
    }
}
