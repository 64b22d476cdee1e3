//! Encodings: how genes become a body and a brain.
//!
//! Each is a folder that implements [`Encoding`], and all are listed once, in [`EncodingName`]. The one that there is
//! so far is the [`course`]'s: 17 numbers a gene.

pub mod course;
pub mod encoding;

pub use course::Course;
pub use encoding::{Encoding, ExpressionError};

use crate::choice;
use serde::{Deserialize, Serialize};

/// Every encoding, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EncodingName {
    /// 17 numbers a gene, which is a link, its joint and its motor: [`Course`].
    #[default]
    Course,
}

impl EncodingName {
    /// Every encoding.
    pub const ALL: [EncodingName; 1] = [EncodingName::Course];
}

impl std::fmt::Display for EncodingName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            EncodingName::Course => "course",
        })
    }
}

impl std::str::FromStr for EncodingName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        choice::named("encoding", &EncodingName::ALL, text)
    }
}
