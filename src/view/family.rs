//! Where somebody comes from, as a graph.

use super::{ViewError, palette};
use rerun::{GraphEdges, GraphNodes, RecordingStream};

/// The line of somebody's ancestors, oldest first, and who else had a part in it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Family {
    /// Everybody in the line.
    pub line: Vec<Generation>,
}

/// Somebody in the line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Generation {
    /// Who.
    pub member: Member,
    /// The other parent, if there is one.
    pub other_parent: Option<Member>,
    /// What lies between the one before and this one, such as a journey.
    pub way: Option<String>,
}

/// A node of the graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// What stands there.
    pub label: String,
    /// The island that it was born on, whose colour it has.
    pub island: u32,
}

/// The distances of rows and of the other parents from the line, in points.
const STEP: [f32; 2] = [300.0, 84.0];

/// Writes a family in the place of the one before; its time is that of the stream.
pub(super) fn show(rec: &RecordingStream, family: &Family) -> Result<(), ViewError> {
    let mut graph = Graph::default();
    for (row, generation) in family.line.iter().enumerate() {
        let y = STEP[1] * row as f32;
        let me = format!("{row}");
        let color = |member: &Member| palette::island(member.island);
        graph.node(&me, &generation.member.label, color(&generation.member), [0.0, y]);
        if let Some(other) = &generation.other_parent {
            // Left and right in turns, above their offspring.
            let x = if row % 2 == 0 { -STEP[0] } else { STEP[0] };
            let name = format!("{row} other");
            graph.node(&name, &other.label, color(other), [x, y - 0.5 * STEP[1]]);
            graph.edge(&name, &me);
        }
        let Some(before) = row.checked_sub(1).map(|before| before.to_string()) else { continue };
        match &generation.way {
            None => graph.edge(&before, &me),
            Some(way) => {
                let name = format!("{row} way");
                graph.node(&name, way, palette::MARKS, [0.0, y - 0.5 * STEP[1]]);
                graph.edge(&before, &name);
                graph.edge(&name, &me);
            }
        }
    }
    graph.log(rec)
}

#[derive(Default)]
struct Graph {
    names: Vec<String>,
    labels: Vec<String>,
    colors: Vec<rerun::Color>,
    places: Vec<[f32; 2]>,
    edges: Vec<(String, String)>,
}

impl Graph {
    fn node(&mut self, name: &str, label: &str, color: [u8; 3], place: [f32; 2]) {
        self.names.push(name.to_owned());
        self.labels.push(label.to_owned());
        self.colors.push(palette::opaque(color));
        self.places.push(place);
    }

    fn edge(&mut self, from: &str, to: &str) {
        self.edges.push((from.to_owned(), to.to_owned()));
    }

    fn log(self, rec: &RecordingStream) -> Result<(), ViewError> {
        let nodes = GraphNodes::new(self.names)
            .with_positions(self.places)
            .with_labels(self.labels)
            .with_colors(self.colors);
        rec.log("family", &nodes)?;
        Ok(rec.log("family", &GraphEdges::new(self.edges).with_directed_edges())?)
    }
}
