//! Bodies as URDF, the Unified Robot Description Format of ROS, for and from other simulators.
//!
//! Links and joints are called `link_0`, `joint_1` and so on by their place in the body, so that names are unique.
//! URDF wants a link's frame to be its joint's, so the solids have an origin of their own within it; the
//! root's is turned as the body stands at the start. A motor's strength and top speed are the limit of its
//! joint. For what URDF has no words there is an element `islands`, which other readers pass over: the motors'
//! waves, and the poses to the last bit. Friction, and that links of one body do not collide, are left out.
//!
//! [`read()`] takes other programs' files too, as long as they are made of boxes, cylinders, spheres and capsules.

mod body;
mod error;
mod motors;
mod read;
#[cfg(test)]
mod tests;
mod tree;
mod write;

pub use body::ReadBody;
pub use error::UrdfError;
pub use write::write;

/// The element that other readers pass over.
const EXTENSION: &str = "islands";

/// The largest file, in bytes; a body of ours with 512 links has less than a tenth.
pub const BYTES_MAX: usize = 4 << 20;
/// The most links of a body.
pub const LINKS_MAX: usize = 512;
/// The most attributes of an element: the parser compares each with all before it.
const ATTRIBUTES_MAX: usize = 256;

/// Reads a body.
///
/// # Errors
/// One sentence that says what is wrong with the file, or what of it is not supported.
pub fn read(text: &str) -> Result<ReadBody, UrdfError> {
    require_few_attributes(text)?;
    let options = roxmltree::ParsingOptions { nodes_limit: 1 << 18, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text, options)?;
    body::build(&read::robot(&document)?)
}

/// Refuses an element with more attributes than any has. Each has two quotation marks, and what is in an element or after
/// it goes on to the next `<`.
fn require_few_attributes(text: &str) -> Result<(), UrdfError> {
    let mut line = 1;
    for piece in text.split('<') {
        let quotes = piece.bytes().filter(|byte| b"\"'".contains(byte)).count();
        // Comments and instructions have none.
        if quotes > 2 * ATTRIBUTES_MAX && !piece.starts_with(['!', '?']) {
            return Err(UrdfError::ManyAttributes { line });
        }
        line += piece.bytes().filter(|&byte| byte == b'\n').count() as u32;
    }
    Ok(())
}
