//! Closed forms, laws of conservation, and the same bits at every width.

mod beams;
mod floor;
mod laws;
mod widths;

use super::{Body, Lattice, Surroundings, Voxel};
use crate::rng::{Purpose, Source, Stream};
use rand::RngExt;

const SOFT: Voxel = Voxel { young_pa: 1e4, rest: 1.0, amplitude: 0.0, phase_rad: 0.0 };
const BONE: Voxel = Voxel { young_pa: 5e4, ..SOFT };
const MUSCLE: Voxel = Voxel { amplitude: 0.14, ..SOFT };
const ANTIPHASE: Voxel = Voxel { phase_rad: std::f64::consts::PI, ..MUSCLE };

/// A grid filled with one material.
fn block(size: [usize; 3], voxel: Voxel) -> Body {
    Body {
        size,
        voxels: vec![Some(voxel); size.iter().product()],
        edge_m: 0.01,
        density_kg_m3: 1_000.0,
        frequency_hz: 4.0,
        link_damping: super::LINK_DAMPING,
    }
}

fn stream(index: u32) -> Stream {
    Source { seed: 5, island: 0 }.stream(0, index, Purpose::Genesis)
}

/// A grid with holes and all materials, in one piece or not.
fn motley(size: [usize; 3], index: u32) -> Body {
    let mut rng = stream(index);
    let mut body = block(size, SOFT);
    for voxel in &mut body.voxels {
        *voxel = [None, Some(SOFT), Some(BONE), Some(MUSCLE), Some(ANTIPHASE)]
            [rng.random_range(0..5_usize)];
    }
    body
}

fn run(lattice: &mut Lattice, seconds: f64) {
    while lattice.time_s() < seconds {
        lattice.step();
    }
}

fn vacuum(body: Body) -> Lattice {
    Lattice::new(body, Surroundings::VACUUM, 1.0)
}
