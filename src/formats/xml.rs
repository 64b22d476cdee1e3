//! What the formats in XML share: numbers and text as attributes hold them.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use std::fmt::{self, Display, Formatter};

/// Three numbers.
pub struct Triple<'a>(pub &'a Vector3<f64>);

impl Display for Triple<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (x, y, z) = (self.0.x, self.0.y, self.0.z);
        write!(f, "{x} {y} {z}")
    }
}

/// A rotation: x, y, z and w of a quaternion.
pub struct Quaternion<'a>(pub &'a UnitQuaternion<f64>);

impl Display for Quaternion<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let c = &self.0.coords;
        write!(f, "{} {} {} {}", c.x, c.y, c.z, c.w)
    }
}

/// A pose: a translation, then a rotation.
pub struct Pose<'a>(pub &'a Isometry3<f64>);

impl Display for Pose<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", Triple(&self.0.translation.vector), Quaternion(&self.0.rotation))
    }
}

/// Text within an attribute of XML.
pub struct Escaped<'a>(pub &'a str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c {
            '&' => f.write_str("&amp;"),
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            '"' => f.write_str("&quot;"),
            // XML has no words for other control characters.
            c if c.is_control() => f.write_str(" "),
            c => write!(f, "{c}"),
        })
    }
}
