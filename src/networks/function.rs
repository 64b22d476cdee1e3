//! What a neuron does with the sum of its inputs.

use crate::choice;
use serde::{Deserialize, Serialize};

/// A function of a neuron. The discriminants are part of every genome: never reorder.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::Display,
    strum::FromRepr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
#[repr(u32)]
pub enum Function {
    /// 1 / (1 + e^(−4.9 x)): NEAT's steepened sigmoid, from 0 to 1.
    Sigmoid = 0,
    /// 2 / (1 + e^(−4.9 x)) − 1, from −1 to 1.
    SignedSigmoid = 1,
    /// sin x.
    Sine = 2,
    /// cos x.
    Cosine = 3,
    /// e^(−x²), from 0 to 1.
    Gaussian = 4,
    /// x².
    Square = 5,
    /// √|x| with the sign of x.
    SignedRoot = 6,
    /// x, but at least −1 and at most 1.
    Clamped = 7,
}

/// The slope of NEAT's sigmoid.
const SLOPE: f64 = 4.9;
/// No neuron gives more than this, so that no sum of squares of squares leaves the numbers.
const VALUE_MAX: f64 = 1e6;

impl Function {
    /// What hidden neurons of a CPPN may do (Cheney et al. 2013, in their release).
    pub const CPPN: [Function; 7] = [
        Function::Sigmoid,
        Function::Sine,
        Function::Cosine,
        Function::Gaussian,
        Function::Square,
        Function::SignedRoot,
        Function::Clamped,
    ];

    /// The function with this discriminant.
    pub fn of_code(code: u32) -> Option<Self> {
        Self::from_repr(code)
    }

    /// Its value at `x`, finite for every finite `x`.
    pub fn at(self, x: f64) -> f64 {
        match self {
            Function::Sigmoid => 1.0 / (1.0 + libm::exp(-SLOPE * x)),
            Function::SignedSigmoid => 2.0 / (1.0 + libm::exp(-SLOPE * x)) - 1.0,
            Function::Sine => libm::sin(x),
            Function::Cosine => libm::cos(x),
            Function::Gaussian => libm::exp(-x * x),
            Function::Square => (x * x).min(VALUE_MAX),
            Function::SignedRoot => libm::sqrt(x.abs()).copysign(x),
            Function::Clamped => x.clamp(-1.0, 1.0),
        }
    }
}

choice::one_of!("function", Function);
choice::as_text!(Function);
