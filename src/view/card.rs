//! What a film says of its run.

use super::film::Pace;
use super::track::Track;
use crate::simulation::Ground;

/// What a recording says of its run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunCard {
    /// What kind of film it is.
    pub program: Program,
    /// The lanes that champions are shown in: in a run one an island, in their order.
    pub lanes: Vec<Lane>,
    /// The unit of fitness, such as "m".
    pub unit: String,
    /// A page on the run, in Markdown.
    pub description_markdown: String,
    /// Who sends to whom.
    pub topology_edges: Vec<(u32, u32)>,
    /// Whether there are bodies to show.
    pub has_stage: bool,
    /// Whether there is a family to show.
    pub has_family: bool,
    /// How fast generations pass in the film.
    pub pace: Pace,
    /// What the creatures stand on.
    pub ground: Ground,
}

/// What kind of film it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// A run: each island's champions in its lane, generation by generation.
    Run,
    /// Creatures that start at the same time, each in a lane of its own.
    Race,
    /// Creatures that go one after another, each in a lane of its own: the film follows who is on its way.
    Line,
}

/// A lane.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lane {
    /// What its view and its curves are called.
    pub title: String,
    /// Whose colour it has: an island's.
    pub hue: u32,
}

impl RunCard {
    /// The number of lanes.
    pub fn lane_count(&self) -> u32 {
        self.lanes.len() as u32
    }

    /// The lanes side by side; on a terrain all in the same place.
    pub fn track(&self) -> Track {
        match &self.ground {
            Ground::Plane => Track::of(self.lane_count()),
            Ground::Terrain(_) => Track::shared(self.lane_count()),
        }
    }

    /// The lanes and their numbers.
    pub fn lanes(&self) -> impl Iterator<Item = (u32, &Lane)> {
        (0..).zip(&self.lanes)
    }
}

impl Lane {
    /// The lanes of a run of so many islands.
    pub fn of_islands(islands: u32) -> Vec<Self> {
        (0..islands).map(|hue| Self { title: format!("Island {hue}"), hue }).collect()
    }
}
