//! What is around a body, and pushes it.

#[cfg(test)]
use nalgebra::Vector3;

/// What is around a body. A further one is a line here, and a file for what it does to parts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Medium {
    /// Nothing that a body would feel.
    #[default]
    Void,
    /// For tests alone: it accelerates every part alike, in m/s².
    #[cfg(test)]
    Stream(Vector3<f64>),
}
