//! How a trial fails.

/// Why a trial came to no measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum Failure {
    /// A position or a speed stopped being a number.
    #[error("not finite")]
    NotFinite,
    /// A part moved faster than anything healthy does.
    #[error("too fast")]
    TooFast,
    /// The body left the ground by more than a jump explains, or its terrain.
    #[error("launched")]
    Launched,
    /// The body gained more momentum than gravity and friction can give.
    #[error("momentum out of nothing")]
    Unphysical,
}
