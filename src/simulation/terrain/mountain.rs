//! The mountain of the course: a hill in an arena.

use super::Terrain;
use crate::rng::{Purpose, Source};
use rand::RngExt;
use std::sync::{Arc, LazyLock};

/// Points of the grid, each way: 20 m.
const POINTS: usize = 41;
/// How far they are apart, in metres.
const STEP_M: f64 = 0.5;
/// The height of the hill without rocks, in metres.
const HEIGHT_M: f64 = 5.0;
/// Twice the square of its width, in m².
const WIDTH_M2: f64 = 18.0;
/// The greatest height of a rock on it, in metres.
const ROCK_M: f64 = 0.1;
/// There are rocks of all sizes where the hill is so high, in metres, and the smaller the less it is: its foot is
/// smooth.
const ROCKY_M: f64 = 1.0;
/// The seed of its rocks: it is the same mountain in every run.
const SEED: u64 = 20;

/// The arena of task `climb`: 20 m × 20 m with a hill of height 5·exp(−(x² + y²)/18) in its middle and rocks on it. A
/// body begins at its foot.
pub fn mountain() -> Arc<Terrain> {
    static MOUNTAIN: LazyLock<Arc<Terrain>> = LazyLock::new(|| Arc::new(build()));
    Arc::clone(&MOUNTAIN)
}

fn build() -> Terrain {
    let mut rocks = Source { seed: SEED, island: 0 }.stream(0, 0, Purpose::Terrain);
    let middle = (POINTS - 1) as f64 / 2.0;
    let heights_m = (0..POINTS * POINTS).map(|i| {
        let [x_m, y_m] = [i % POINTS, i / POINTS].map(|at| (at as f64 - middle) * STEP_M);
        let hill_m = hill_m(x_m, y_m);
        hill_m + ROCK_M * rocks.random::<f64>() * (hill_m / ROCKY_M).min(1.0)
    });
    let points = [POINTS; 2];
    let start_m = Terrain::usual_start_m(points, STEP_M);
    Terrain::new(points, STEP_M, heights_m.collect(), start_m).expect("it is gentle")
}

/// The hill without rocks.
pub(super) fn hill_m(x_m: f64, y_m: f64) -> f64 {
    HEIGHT_M * libm::exp(-(x_m * x_m + y_m * y_m) / WIDTH_M2)
}
