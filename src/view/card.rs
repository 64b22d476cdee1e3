//! What a film says of its run.

use super::film::Pace;

/// What a recording says of its run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunCard {
    /// The number of islands.
    pub islands: u32,
    /// The unit of fitness, such as "m".
    pub unit: String,
    /// A page on the run, in Markdown.
    pub description_markdown: String,
    /// Who sends to whom.
    pub topology_edges: Vec<(u32, u32)>,
    /// How fast generations pass in the film.
    pub pace: Pace,
}
