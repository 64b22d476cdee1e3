//! Where on a terrain a body begins.

use super::super::start::Start;
use super::Terrain;
use crate::creature::Morphology;
use nalgebra::{Vector2, Vector3};

/// Bodies begin with so much room to the walls, in metres.
const ROOM_M: f64 = 0.05;

impl Terrain {
    /// Where the root of a body begins, in metres: above [`Terrain::start_m`] or so far from it, unless a wall is
    /// nearer to that than the body reaches, and so high that every link is as high over the highest ground below it
    /// as the start says.
    pub fn root_start_m(
        &self,
        morphology: &Morphology,
        start: Start,
        offset_m: Vector3<f64>,
    ) -> Vector3<f64> {
        let boxes = boxes(morphology);
        let [x_m, y_m] = self.start_m();
        let wish_m = Vector2::new(x_m, y_m) + offset_m.xy();
        let at_m = Vector2::from_fn(|axis, _| {
            let edges = boxes.iter().map(|it| (it.low_m[axis], it.high_m[axis]));
            let (low_m, high_m) =
                edges.fold((0.0_f64, 0.0_f64), |all, it| (all.0.min(it.0), all.1.max(it.1)));
            let half_m = self.half_m()[axis] - ROOM_M;
            // What is wider than the arena stands in its middle.
            let (least_m, most_m) = (-half_m - low_m, half_m - high_m);
            if least_m < most_m { wish_m[axis].clamp(least_m, most_m) } else { 0.0 }
        });
        let height_m = match start {
            Start::RootAt(height_m) => self.height_m(at_m.x, at_m.y) + height_m,
            Start::LowestAt(height_m) | Start::LeaningAt(height_m) => {
                let lift_m = |it: &Box| {
                    self.highest_m(at_m + it.low_m.xy(), at_m + it.high_m.xy()) - it.low_m.z
                };
                boxes.iter().map(lift_m).fold(f64::NEG_INFINITY, f64::max) + height_m
            }
        };
        Vector3::new(at_m.x, at_m.y, height_m + offset_m.z)
    }
}

/// The box around a link at rest, from the root, in metres.
struct Box {
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
}

fn boxes(morphology: &Morphology) -> Vec<Box> {
    let links = morphology.links.iter().zip(morphology.rest_poses());
    let around = links.map(|(link, pose)| {
        let reach_m = |axis, _| link.shape.reach_m(&pose.rotation, &Vector3::ith(axis, 1.0));
        let half_m = Vector3::from_fn(reach_m);
        let centre_m = pose.translation.vector;
        Box { low_m: centre_m - half_m, high_m: centre_m + half_m }
    });
    around.collect()
}
