//! The curves of a replay: how far and how fast each creature is.

use super::card::{Program, RunCard};
use super::extent::every;
use super::film::Screening;
use super::take::Take;
use super::{ViewError, palette};
use libm::hypotf;
use rerun::{RecordingStream, Scalars, SeriesLines};

/// Points per second of a curve.
const RATE: f64 = 10.0;
/// Speeds are means over so many points: a gait has steps, and its speed is that of all of them.
const SPAN: usize = 10;

/// The look of the curves.
pub(super) fn configure(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    for (index, lane) in card.lanes() {
        let line = SeriesLines::new()
            .with_colors([palette::opaque(palette::island(lane.hue))])
            .with_names([lane.title.as_str()])
            .with_widths([2.0]);
        for figure in ["distance", "speed"] {
            rec.log_static(format!("{figure}/{index}"), &line)?;
        }
    }
    if card.program == Program::Line {
        let line = SeriesLines::new()
            .with_colors([palette::opaque(palette::MARKS)])
            .with_names(["fitness"])
            .with_widths([2.0])
            .with_interpolation_mode(rerun::components::InterpolationMode::StepAfter);
        rec.log_static("fitness/line", &line)?;
    }
    Ok(())
}

/// Writes the curves of a clip: how far the centre of mass is from where scoring began, and its speed.
pub(super) fn show(
    rec: &RecordingStream,
    screening: Screening<'_>,
    slot_s: f64,
) -> Result<(), ViewError> {
    if screening.clip.trajectory.poses.is_empty() {
        return Ok(());
    }
    let take = Take::new(screening, slot_s);
    let (times_s, from_s) = (take.times_s(), take.trajectory().scoring_from_s);
    let picks: Vec<usize> = every(&times_s, RATE, f64::INFINITY);
    let picks: Vec<usize> = picks.into_iter().filter(|&pick| times_s[pick] >= from_s).collect();
    let way = |a: usize, b: usize| {
        let ([x, y], [u, v]) = (take.centres[a], take.centres[b]);
        f64::from(hypotf(u - x, v - y))
    };
    let [from_x, from_y] = take.heading.begins();
    let distances = picks.iter().map(|&pick| {
        let [x, y] = take.centres[pick];
        f64::from(hypotf(x - from_x, y - from_y))
    });
    let speeds = (0..picks.len()).map(|i| {
        let (a, b) =
            (picks[i.saturating_sub(SPAN / 2)], picks[(i + SPAN / 2).min(picks.len() - 1)]);
        if a == b { 0.0 } else { way(a, b) / (times_s[b] - times_s[a]) }
    });
    let frames: Vec<usize> = picks.iter().map(|&pick| take.frames[pick]).collect();
    let lane = screening.clip.lane;
    let rows = |values: Vec<f64>| Scalars::new(values).columns_of_unit_batches();
    take.send(rec, format!("distance/{lane}"), &frames, rows(distances.collect())?)?;
    take.send(rec, format!("speed/{lane}"), &frames, rows(speeds.collect())?)
}
