//! How many voxels go side by side changes no bit.

use super::super::{Breadth, Lattice, Surroundings};
use super::motley;

#[test]
fn every_width_moves_every_body_to_the_same_bits() {
    for (index, size) in
        [[6, 6, 6], [1, 2, 9], [5, 3, 4], [2, 7, 3], [9, 1, 2]].into_iter().enumerate()
    {
        let bits = |lanes: usize| -> Vec<u64> {
            let body = motley(size, index as u32);
            let breadth = Breadth::AtMost(lanes);
            let mut lattice = Lattice::with(breadth, body, Surroundings::GROUND, 1.0);
            (0..600).for_each(|_| lattice.step());
            let numbers = (0..lattice.len()).flat_map(|voxel| {
                let corner = lattice.corner(voxel);
                let [x, y, z] = corner.axes.map(|axis| axis.sum());
                [corner.position_m.x, corner.position_m.y, corner.position_m.z, x, y, z]
            });
            let energy = lattice.energy();
            let sums = [energy.kinetic_j, energy.elastic_j, energy.work_j];
            numbers.chain(sums).map(f64::to_bits).collect()
        };
        let alone = bits(1);
        assert_eq!(bits(2), alone, "{size:?}");
        assert_eq!(bits(4), alone, "{size:?}");
    }
}
