//! What stands still: floors, lanes, the start line, the graph of who sends to whom, the run card.

use super::card::{Program, RunCard};
use super::ruler::Ruler;
use super::track::{DIGIT_M, Track};
use super::{ViewError, figures, landscape, palette, state};
use crate::simulation::{Ground, Terrain};
use libm::{cosf, hypotf, sinf};
use rerun::components::InterpolationMode;
use rerun::{
    GraphEdges, GraphNodes, Mesh3D, RecordingStream, SeriesLines, TextDocument, Transform3D,
    ViewCoordinates,
};
use std::f32::consts::TAU;

/// How far a lane reaches behind its start, in metres.
const LANE_BEHIND_M: i32 = 2;
/// How far a lane reaches ahead, in metres; in its second half it fades.
pub const LANE_AHEAD_M: i32 = 16;
/// How far the floor below a champion reaches, in metres; from half of it on it fades.
const FLOOR_M: i32 = 18;

/// The colour of a terrain that all share: that of no island of the first few.
const COMMON_HUE: u32 = 7;

/// Writes everything that stands still.
pub fn build(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    rec.log_static("run", &TextDocument::from_markdown(card.description_markdown.as_str()))?;
    if card.has_stage {
        stages(rec, card)?;
    }
    match card.program {
        Program::Race | Program::Line => figures::configure(rec, card),
        Program::Run => {
            card.lanes().try_for_each(|(island, _)| series(rec, island))?;
            state::configure(rec, card)?;
            topology(rec, card)
        }
    }
}

/// The places of all champions.
fn stages(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    for root in ["islands", "race", "line"] {
        rec.log_static(root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    }
    let track = card.track();
    match &card.ground {
        Ground::Plane => {
            card.lanes().try_for_each(|(index, lane)| stage(rec, track, index, lane.hue))?;
            marks(rec, track)
        }
        Ground::Terrain(terrain) => {
            card.lanes().try_for_each(|(index, lane)| arena(rec, terrain, index, lane.hue))?;
            land(rec, terrain, "race/lanes/0", COMMON_HUE)
        }
    }
}

/// The place of a champion, alone and in the view of all.
fn stage(rec: &RecordingStream, track: Track, index: u32, hue: u32) -> Result<(), ViewError> {
    let path = format!("islands/{index}");
    let offset = Transform3D::from_translation([0.0, track.lane_y(index), 0.0]);
    rec.log_static(path.as_str(), &offset)?;

    let round = |x: f32, y: f32| {
        let far = hypotf(x, y) / FLOOR_M as f32;
        1.0 - ((far - 0.4) / 0.6).clamp(0.0, 1.0)
    };
    let floor = checker(hue, -FLOOR_M..FLOOR_M, -(FLOOR_M as f32), 2 * FLOOR_M, round);
    rec.log_static(format!("{path}/ground"), &floor)?;

    let ahead = |x: f32, _| {
        let past = (x - LANE_AHEAD_M as f32 / 2.0) / (LANE_AHEAD_M as f32 / 2.0);
        1.0 - past.clamp(0.0, 1.0)
    };
    let path = format!("race/lanes/{index}");
    rec.log_static(path.as_str(), &offset)?;
    let (right, rows) = (-track.lane_m / 2.0, track.lane_m as i32);
    let lane = checker(hue, -LANE_BEHIND_M..LANE_AHEAD_M, right, rows, ahead);
    Ok(rec.log_static(path, &lane)?)
}

/// The terrain of a champion alone.
fn arena(rec: &RecordingStream, terrain: &Terrain, index: u32, hue: u32) -> Result<(), ViewError> {
    let path = format!("islands/{index}");
    rec.log_static(path.as_str(), &Transform3D::from_translation([0.0; 3]))?;
    land(rec, terrain, &format!("{path}/ground"), hue)
}

fn land(rec: &RecordingStream, terrain: &Terrain, path: &str, hue: u32) -> Result<(), ViewError> {
    rec.log_static(path, &landscape::ground(terrain, hue))?;
    Ok(rec.log_static(format!("{path}/fence"), &landscape::fence(terrain))?)
}

/// A floor of tiles of a metre in the two colours of an island, so many rows of them from `right` on; `light` says
/// how bright a corner is.
fn checker(
    hue: u32,
    xs: std::ops::Range<i32>,
    right: f32,
    rows: i32,
    light: impl Fn(f32, f32) -> f32,
) -> Mesh3D {
    let (mut positions, mut colors, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (x, row) in xs.flat_map(|x| (0..rows).map(move |row| (x, row))) {
        let tile = palette::floor(hue)[((x + row) & 1) as usize];
        let first = positions.len() as u32;
        let (x, y) = (x as f32, right + row as f32);
        for (x, y) in [(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)] {
            positions.push([x, y, 0.0]);
            colors.push(palette::opaque(palette::mix(palette::BACKDROP, tile, light(x, y))));
        }
        triangles.push([first, first + 1, first + 2]);
        triangles.push([first, first + 2, first + 3]);
    }
    // Without normals the viewer does not shade: the floor keeps its colours from every side.
    Mesh3D::new(positions).with_vertex_colors(colors).with_triangle_indices(triangles)
}

/// The start line and a line at each metre, across all lanes.
fn marks(rec: &RecordingStream, track: Track) -> Result<(), ViewError> {
    let size = track.digit_m() / DIGIT_M;
    let edge = track.lane_m / 2.0;
    let ruler = Ruler {
        metres: LANE_AHEAD_M as u32 * 3 / 4,
        left_m: track.lane_y(0) + edge,
        right_m: track.lane_y(track.lanes.saturating_sub(1)) - edge,
        digit_m: track.digit_m(),
        line_m: 0.014 * size,
        every: if size > 1.2 { 2 } else { 1 },
    };
    Ok(rec.log_static("race/ruler", &ruler.paint(palette::opaque(palette::MARKS)))?)
}

/// The look of an island's curves.
fn series(rec: &RecordingStream, island: u32) -> Result<(), ViewError> {
    // The best of a population jumps; drawn as steps, no plot shows what never was.
    let looks = [
        ("fitness/best", 2.0, InterpolationMode::StepAfter),
        ("fitness/mean", 1.5, InterpolationMode::Linear),
        ("diversity", 1.5, InterpolationMode::Linear),
    ];
    for (metric, width, interpolation) in looks {
        let line = SeriesLines::new()
            .with_colors([palette::opaque(palette::island(island))])
            .with_names([format!("island {island}")])
            .with_widths([width])
            .with_interpolation_mode(interpolation);
        rec.log_static(format!("{metric}/{island}"), &line)?;
    }
    Ok(())
}

/// The islands on a circle, an arrow for every way that migrants take.
fn topology(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    let islands = 0..card.lane_count();
    let name = |island: u32| format!("island {island}");
    let place = |island: u32| {
        let angle = TAU * island as f32 / card.lane_count() as f32;
        // Wider than high, as its place on the screen, and with room for the names.
        let size = (card.lane_count() as f32 / 8.0).max(1.0);
        [105.0 * size * sinf(angle), -75.0 * size * cosf(angle)]
    };
    let nodes = GraphNodes::new(islands.clone().map(name))
        .with_positions(islands.clone().map(place))
        .with_labels(islands.clone().map(name))
        .with_colors(islands.map(|island| palette::opaque(palette::island(island))));
    rec.log_static("topology", &nodes)?;
    let edges = card.topology_edges.iter().map(|&(from, to)| (name(from), name(to)));
    Ok(rec.log_static("topology", &GraphEdges::new(edges).with_directed_edges())?)
}
