//! Meshes in Wavefront's OBJ: the highest surface over each point of a grid, z up, in metres.
//!
//! Only vertices and faces count. Faces with more than three corners are fans of triangles; which way they face does
//! not matter. Where there is no surface, the ground is as low as the lowest.

use super::{Grid, Sizing, TerrainFileError};
use crate::simulation::Terrain;
use crate::simulation::terrain::HEIGHT_M_MAX;
use nalgebra::{Vector2, Vector3};

/// The most vertices, and the most triangles.
pub const ITEMS_MAX: usize = 1_000_000;
/// The most corners of a face.
const CORNERS_MAX: usize = 1_000;
/// The most characters of a word that are shown when it is wrong.
const SHOWN_MAX: usize = 40;
/// The cells of the grid along the longer side: with the course's arena, a quarter of a metre each.
const CELLS: usize = 80;
/// The most points that are looked at in all, for all triangles together.
const LOOKS_MAX: usize = 200_000_000;
/// No coordinate may be greater: what is larger cannot be a terrain in metres.
const PLACE_MAX: f64 = 1e6;
/// A point on the edge of a triangle is in it, whatever rounding says: a share of the triangle.
const EDGE_SHARE: f64 = 1e-9;

/// Reads a mesh.
pub fn read(text: &str, sizing: &Sizing) -> Result<Terrain, TerrainFileError> {
    let mesh = Mesh::parse(text)?.widened(sizing)?;
    raised(mesh.sample()?, sizing).terrain(sizing)
}

/// Triangles.
#[derive(Default)]
struct Mesh {
    vertices: Vec<Vector3<f64>>,
    triangles: Vec<[usize; 3]>,
}

impl Mesh {
    fn parse(text: &str) -> Result<Self, TerrainFileError> {
        let mut mesh = Self::default();
        for (line, text) in (1..).zip(text.lines()) {
            let wrong = |reason: String| TerrainFileError::Line { line, reason };
            let mut words = text.split_whitespace();
            match words.next() {
                Some("v") => mesh.vertices.push(vertex(words).map_err(wrong)?),
                Some("f") => mesh.face(words).map_err(wrong)?,
                // Comments, normals, materials, names, lines.
                _ => {}
            }
            if mesh.vertices.len() > ITEMS_MAX {
                return Err(TerrainFileError::Many { what: "vertices" });
            }
            if mesh.triangles.len() > ITEMS_MAX {
                return Err(TerrainFileError::Many { what: "triangles" });
            }
        }
        if mesh.triangles.is_empty() { Err(TerrainFileError::NoFaces) } else { Ok(mesh) }
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let corners = words.take(CORNERS_MAX + 1).map(|word| self.corner(word));
        let corners = corners.collect::<Result<Vec<_>, _>>()?;
        if corners.len() > CORNERS_MAX {
            return Err(format!("a face has more than {CORNERS_MAX} corners: split it"));
        }
        if corners.len() < 3 {
            return Err(format!(
                "a face has {} corners; it must have three or more",
                corners.len()
            ));
        }
        let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
        self.triangles.extend(fan);
        Ok(())
    }

    /// The vertex of a corner such as 3, 3/1/2 or -1, which is the one before.
    fn corner(&self, word: &str) -> Result<usize, String> {
        let number = word.split('/').next().unwrap_or_default();
        let number: i64 =
            number.parse().map_err(|_| format!("{} is no vertex's number", shown(word)))?;
        let count = self.vertices.len() as i64;
        let index = if number < 0 { count.checked_add(number) } else { number.checked_sub(1) };
        match index {
            Some(index) if (0..count).contains(&index) => Ok(index as usize),
            _ => Err(format!("there is no vertex {number}; so far there are {count}")),
        }
    }

    fn corners_m(&self) -> impl Iterator<Item = Vector3<f64>> {
        self.triangles.iter().flatten().map(|&index| self.vertices[index])
    }

    /// The box around all faces.
    fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let none = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        self.corners_m().fold(none, |(low, high), corner| (low.inf(&corner), high.sup(&corner)))
    }

    /// The mesh in the width that the user wants.
    fn widened(mut self, sizing: &Sizing) -> Result<Self, TerrainFileError> {
        let (low, high) = self.bounds();
        let size = high - low;
        if !(size.x > 0.0 && size.y > 0.0) {
            return Err(TerrainFileError::NoFaces);
        }
        let flat = sizing.width_m.map_or(1.0, |width_m| width_m / size.x);
        let scale = Vector3::new(flat, flat, 1.0);
        self.vertices.iter_mut().for_each(|vertex| *vertex = vertex.component_mul(&scale));
        Ok(self)
    }

    /// The highest surface over each point of a grid.
    fn sample(&self) -> Result<Grid, TerrainFileError> {
        let (low, high) = self.bounds();
        let size = (high - low).xy();
        let step_m = size.max() / CELLS as f64;
        let cells = |size: f64| ((size / step_m + 1e-6) as usize).clamp(1, CELLS);
        let points = [cells(size.x) + 1, cells(size.y) + 1];
        let mut heights_m = vec![f64::NEG_INFINITY; points[0] * points[1]];
        let mut looks = 0_usize;
        for triangle in &self.triangles {
            let corners = triangle.map(|index| {
                let [x, y, z] = (self.vertices[index] - Vector3::new(low.x, low.y, 0.0)).into();
                Vector3::new(x / step_m, y / step_m, z)
            });
            looks += raise(&corners, points, &mut heights_m);
            if looks > LOOKS_MAX {
                return Err(TerrainFileError::Layers);
            }
        }
        let lowest_m = heights_m.iter().copied().filter(|it| it.is_finite()).reduce(f64::min);
        let lowest_m = lowest_m.ok_or(TerrainFileError::NoFaces)?;
        heights_m.iter_mut().filter(|it| !it.is_finite()).for_each(|it| *it = lowest_m);
        Ok(Grid { points, step_m, heights_m })
    }
}

/// The surface in the height that the user wants, its lowest point where it is. What a mesh has below its surface
/// counts for nothing.
fn raised(mut grid: Grid, sizing: &Sizing) -> Grid {
    let heights_m = grid.heights_m.iter().copied();
    let lowest_m = heights_m.clone().fold(f64::INFINITY, f64::min);
    let own_m = heights_m.fold(f64::NEG_INFINITY, f64::max) - lowest_m;
    if let Some(height_m) = sizing.height_m.filter(|_| own_m > 0.0) {
        let up = height_m / own_m;
        grid.heights_m.iter_mut().for_each(|it| *it = lowest_m + up * (*it - lowest_m));
    }
    grid
}

/// Raises the points below a triangle, whose places are measured in cells, and returns how many were looked at.
fn raise(corners: &[Vector3<f64>; 3], points: [usize; 2], heights_m: &mut [f64]) -> usize {
    let range = |axis: usize| {
        let at = corners.map(|corner| corner[axis]);
        let low = at.into_iter().fold(f64::INFINITY, f64::min) - EDGE_SHARE * CELLS as f64;
        let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max) + EDGE_SHARE * CELLS as f64;
        low.ceil().max(0.0) as usize..((high.floor() + 1.0).max(0.0) as usize).min(points[axis])
    };
    let (columns, rows) = (range(0), range(1));
    for row in rows.clone() {
        for column in columns.clone() {
            if let Some(height_m) = height_over(corners, Vector2::new(column as f64, row as f64)) {
                let point = &mut heights_m[row * points[0] + column];
                *point = point.max(height_m);
            }
        }
    }
    1 + columns.len() * rows.len()
}

/// The height of a triangle over a place, if it is over it.
fn height_over([a, b, c]: &[Vector3<f64>; 3], place: Vector2<f64>) -> Option<f64> {
    let (ab, ac, ap) = ((b - a).xy(), (c - a).xy(), place - a.xy());
    let area = ab.perp(&ac);
    let (v, w) = (ap.perp(&ac) / area, ab.perp(&ap) / area);
    // What stands upright has no area, and is over nothing.
    let is_within = v >= -EDGE_SHARE && w >= -EDGE_SHARE && v + w <= 1.0 + EDGE_SHARE;
    is_within.then(|| a.z + v * (b.z - a.z) + w * (c.z - a.z))
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vector3<f64>, String> {
    let mut numbers = [0.0; 3];
    let mut words = words.fuse();
    for (number, most) in numbers.iter_mut().zip([PLACE_MAX, PLACE_MAX, HEIGHT_M_MAX]) {
        let word = words.next().ok_or("a vertex has three numbers: x, y and, upwards, z")?;
        let place: f64 = word.parse().map_err(|_| format!("{} is no number", shown(word)))?;
        if !(-most..=most).contains(&place) {
            let place = shown(word);
            return Err(format!("{place} is no place: it must be from -{most} to {most}"));
        }
        *number = place;
    }
    Ok(numbers.into())
}

/// The beginning of a word of a file, which may be of any length.
fn shown(word: &str) -> String {
    let mut characters = word.chars();
    let beginning: String = characters.by_ref().take(SHOWN_MAX).collect();
    let more = if characters.next().is_some() { "…" } else { "" };
    format!("{beginning:?}{more}")
}
