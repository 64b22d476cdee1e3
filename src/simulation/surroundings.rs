//! What media do to bodies.

use super::assembly::Assembly;
use super::medium::Medium;
use super::world::World;
#[cfg(test)]
use nalgebra::Vector3;

/// Lets a medium push every part as long as the next step takes.
pub fn act(medium: Medium, world: &mut impl World, assembly: &Assembly) {
    match medium {
        Medium::Void => {
            let _ = (world, assembly);
        }
        #[cfg(test)]
        Medium::Stream(acceleration_m_s2) => {
            for (index, part) in assembly.parts.iter().enumerate() {
                world.apply(index, acceleration_m_s2 * part.mass_kg, Vector3::zeros());
            }
        }
    }
}
