//! Why a URDF cannot be read.

/// Why a URDF cannot be read. Names from the file are shortened.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UrdfError {
    /// It is no XML.
    #[error("it is no XML: {0}")]
    Xml(String),
    /// It is XML of another kind.
    #[error("its root element is <{0}>: give a URDF, whose root element is <robot>")]
    Root(String),
    /// An element lacks what it must have.
    #[error("line {line}: <{element}> has no {what}")]
    Missing {
        /// The line, from 1.
        line: u32,
        /// The element.
        element: String,
        /// The element or attribute that is not there.
        what: &'static str,
    },
    /// An attribute does not say what it should.
    #[error("line {line}: {attribute}={value:?} is wrong: write {expected}")]
    Attribute {
        /// The line, from 1.
        line: u32,
        /// The attribute.
        attribute: String,
        /// The beginning of what it says.
        value: String,
        /// What it should say.
        expected: &'static str,
    },
    /// URDF has it, but these bodies do not.
    #[error("line {line}: {what} is not supported: {advice}")]
    Unsupported {
        /// The line, from 1.
        line: u32,
        /// What it is.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// Two things have one name.
    #[error("line {line}: there are two {what}s called {name:?}")]
    Duplicate {
        /// The line of the second one, from 1.
        line: u32,
        /// `link` or `joint`.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// Something is named that there is not.
    #[error("line {line}: there is no {what} called {name:?}")]
    Unknown {
        /// The line, from 1.
        line: u32,
        /// `link` or `joint`.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// The joints do not make a tree of the links.
    #[error("the links do not make one tree: {0}")]
    NoTree(String),
    /// A part that moves by itself has no mass.
    #[error("link {0:?} moves by itself but has no mass: give it an <inertial> with one")]
    Massless(String),
    /// A part that moves by itself has nothing to touch or see.
    #[error(
        "link {0:?} has no <collision> or <visual> that it could be made of: give it one, or fix it to its parent"
    )]
    Shapeless(String),
    /// An element has more attributes than any has.
    #[error("line {line}: an element has more than {} attributes", super::ATTRIBUTES_MAX)]
    ManyAttributes {
        /// The line that the element begins in, from 1.
        line: u32,
    },
    /// It is larger than any body.
    #[error("it has more than {} links: give a body with fewer", super::LINKS_MAX)]
    TooLarge,
}

impl From<roxmltree::Error> for UrdfError {
    fn from(error: roxmltree::Error) -> Self {
        Self::Xml(shortened(&error.to_string()))
    }
}

/// The most characters of a file's text that a message shows.
const SHOWN: usize = 60;

/// Text from a file as a message may show it.
pub fn shortened(text: &str) -> String {
    text.chars().take(SHOWN).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}
