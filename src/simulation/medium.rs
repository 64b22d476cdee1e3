//! What is around a body, and pushes it.

use super::assembly::Assembly;
use super::world::World;
#[cfg(test)]
use nalgebra::Vector3;

/// What is around a body. A further one is a line here and a file with what it does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Medium {
    /// Nothing that a body would feel.
    #[default]
    Void,
    /// For tests alone: it accelerates every part alike, in m/s².
    #[cfg(test)]
    Stream(Vector3<f64>),
}

impl Medium {
    /// Pushes every part as long as the next step takes.
    pub fn act(self, world: &mut impl World, assembly: &Assembly) {
        match self {
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
}
