//! A clip in its place of the film.

use super::film::Screening;
use super::take::Take;
use super::track::Track;
use super::{ViewError, limbs, steps};
use rerun::{RecordingStream, Transform3D};

/// Writes a clip into its place in the film, and returns how far along its lane something of it is ever seen, in
/// metres.
pub fn show(
    rec: &RecordingStream,
    screening: Screening<'_>,
    slot_s: f64,
) -> Result<f32, ViewError> {
    if screening.clip.trajectory.poses.is_empty() {
        return Ok(0.0);
    }
    let take = Take::new(screening, slot_s);
    take.stamp(rec);
    limbs::show(rec, &take)?;
    steps::show(rec, &take)?;
    take.camera(rec)?;
    take.ruler(rec)?;
    take.trail(rec)?;
    Ok(take.farthest_m() + 0.5 * take.reach_m)
}

/// Makes the view of a line follow a clip.
pub fn follow(
    rec: &RecordingStream,
    screening: Screening<'_>,
    slot_s: f64,
    track: Track,
) -> Result<(), ViewError> {
    if screening.clip.trajectory.poses.is_empty() {
        return Ok(());
    }
    let take = Take::new(screening, slot_s);
    take.stamp(rec);
    let path = "line/follow";
    rec.log(path, &Transform3D::from_scale(take.reach_m))?;
    let lane_y = track.lane_y(screening.clip.lane);
    let here = take.follow.iter().map(|&[x, y]| [x, y + lane_y, take.middle_m([x, y])]);
    let places = Transform3D::update_fields().with_many_translation(here);
    take.send(rec, path.to_owned(), &take.frames, places.columns_of_unit_batches()?)
}
