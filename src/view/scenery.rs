//! What stands still: floors, lanes, the start line, the graph of who sends to whom, the run card.

use super::card::RunCard;
use super::{ViewError, palette};
use rerun::components::InterpolationMode;
use rerun::{
    GraphEdges, GraphNodes, LineStrips3D, Mesh3D, Points3D, Radius, RecordingStream, SeriesLines,
    TextDocument, Transform3D, ViewCoordinates,
};
use std::f32::consts::TAU;

/// The distance of two islands' lanes, in metres. Even, so that lanes share the tiling.
pub const LANE_M: f32 = 4.0;
/// How far a lane reaches behind its start, in metres.
const LANE_BEHIND_M: i32 = 2;
/// How far a lane reaches ahead, in metres.
pub const LANE_AHEAD_M: i32 = 20;
/// How far the floor below a champion reaches, in metres; from half of it on it fades.
const FLOOR_M: i32 = 18;

/// Writes everything that stands still.
pub fn build(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    rec.log_static("run", &TextDocument::from_markdown(card.description_markdown.as_str()))?;
    rec.log_static("islands", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    rec.log_static("race", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    for island in 0..card.islands {
        stage(rec, island)?;
        series(rec, island)?;
    }
    marks(rec, card.islands)?;
    topology(rec, card)
}

/// The place of an island in the view of all.
fn stage(rec: &RecordingStream, island: u32) -> Result<(), ViewError> {
    let path = format!("islands/{island}");
    let offset = [0.0, lane_y(island), 0.0];
    rec.log_static(path.as_str(), &Transform3D::from_translation(offset))?;

    let round = |x: i32, y: i32| {
        let far = (x as f32).hypot(y as f32) / FLOOR_M as f32;
        1.0 - ((far - 0.4) / 0.6).clamp(0.0, 1.0)
    };
    let floor = checker(island, -FLOOR_M..FLOOR_M, -FLOOR_M..FLOOR_M, round);
    rec.log_static(format!("{path}/ground"), &floor)?;

    let ahead = |x: i32, _| {
        let past = (x - LANE_AHEAD_M / 2) as f32 / (LANE_AHEAD_M as f32 / 2.0);
        1.0 - past.clamp(0.0, 1.0)
    };
    let half = LANE_M as i32 / 2;
    let lane = checker(island, -LANE_BEHIND_M..LANE_AHEAD_M, -half..half, ahead);
    Ok(rec.log_static(format!("{path}/lane"), &lane)?)
}

/// The middle of an island's lane: island 0 is the leftmost for who looks along them.
fn lane_y(island: u32) -> f32 {
    -LANE_M * island as f32
}

/// The middle of all lanes.
pub fn middle_y(islands: u32) -> f32 {
    lane_y(islands.saturating_sub(1)) / 2.0
}

/// A floor of tiles of a metre in the two colours of an island; `light` says how bright a corner is.
fn checker(
    island: u32,
    xs: std::ops::Range<i32>,
    ys: std::ops::Range<i32>,
    light: impl Fn(i32, i32) -> f32,
) -> Mesh3D {
    let (mut positions, mut colors, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (x, y) in xs.flat_map(|x| ys.clone().map(move |y| (x, y))) {
        let tile = palette::floor(island)[((x + y) & 1) as usize];
        let first = positions.len() as u32;
        for (x, y) in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
            positions.push([x as f32, y as f32, 0.0]);
            colors.push(palette::opaque(palette::mix(palette::BACKDROP, tile, light(x, y))));
        }
        triangles.push([first, first + 1, first + 2]);
        triangles.push([first, first + 2, first + 3]);
    }
    // Without normals the viewer does not shade: the floor keeps its colours from every side.
    Mesh3D::new(positions).with_vertex_colors(colors).with_triangle_indices(triangles)
}

/// The start line and marks at every fifth metre.
fn marks(rec: &RecordingStream, islands: u32) -> Result<(), ViewError> {
    let left = lane_y(0) + LANE_M / 2.0;
    let right = lane_y(islands.saturating_sub(1)) - LANE_M / 2.0;
    let metres: Vec<i32> = (0..=LANE_AHEAD_M / 2).step_by(5).collect();
    let lines = metres.iter().map(|&m| [[m as f32, left, 0.01], [m as f32, right, 0.01]]);
    let radii = metres.iter().map(|&m| if m == 0 { 0.04 } else { 0.012 });
    let strips =
        LineStrips3D::new(lines).with_radii(radii).with_colors([palette::opaque(palette::MARKS)]);
    rec.log_static("race/lines", &strips)?;

    let labels = metres.iter().map(|&m| if m == 0 { "start".into() } else { format!("{m} m") });
    let points = Points3D::new(metres.iter().map(|&m| [m as f32, left + 0.7, 0.3]))
        .with_radii([Radius::new_ui_points(0.5)])
        .with_colors([palette::opaque(palette::MARKS)])
        .with_labels(labels)
        .with_show_labels(true);
    Ok(rec.log_static("race/marks", &points)?)
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
    let islands = 0..card.islands;
    let name = |island: u32| format!("island {island}");
    let place = |island: u32| {
        let angle = TAU * island as f32 / card.islands as f32;
        // Wider than high, as its place on the screen, and with room for the names.
        let size = (card.islands as f32 / 8.0).max(1.0);
        [120.0 * size * angle.sin(), -75.0 * size * angle.cos()]
    };
    let nodes = GraphNodes::new(islands.clone().map(name))
        .with_positions(islands.clone().map(place))
        .with_labels(islands.clone().map(name))
        .with_colors(islands.map(|island| palette::opaque(palette::island(island))));
    rec.log_static("topology", &nodes)?;
    let edges = card.topology_edges.iter().map(|&(from, to)| (name(from), name(to)));
    Ok(rec.log_static("topology", &GraphEdges::new(edges).with_directed_edges())?)
}
