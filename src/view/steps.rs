//! Where a champion touches the ground, and the prints that it leaves there.

use super::extent::every;
use super::take::Take;
use super::{ViewError, palette};
use crate::creature::Shape;
use crate::simulation::trajectory::Pose;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, vector};
use rerun::{Cylinders3D, FillMode, RecordingStream};

/// Looks at the feet a second.
const STEP_RATE: f64 = 30.0;
/// Who is so near to the ground touches it, in metres: bodies neither sink in nor hover by more.
const TOUCH_M: f32 = 0.012;
/// Who was in the air for less than this has not made a step, in seconds.
const AIR_S: f64 = 0.12;
/// The prints that are seen at a time.
const PRINTS: usize = 24;

/// Writes what a clip's feet do.
pub(super) fn show(rec: &RecordingStream, take: &Take<'_>) -> Result<(), ViewError> {
    let picks = every(&take.times_s(), STEP_RATE, f64::INFINITY);
    let frames: Vec<usize> = picks.into_iter().map(|pick| take.frames[pick]).collect();
    let touches: Vec<Vec<Touch>> = frames.iter().map(|&frame| touches(take, frame)).collect();
    let reach = take.reach_m;

    let here = touches.iter().map(|touches| touches.iter().map(|touch| touch.at).collect());
    let rows: Vec<(usize, Vec<[f32; 3]>)> = frames.iter().copied().zip(here).collect();
    let color = palette::opaque(palette::TOUCH);
    discs(rec, take, "contacts", &rows, [0.05 * reach, 0.008 * reach], color)?;

    let color =
        palette::opaque(palette::mix(palette::island(take.clip().hue), palette::BACKDROP, 0.35));
    discs(
        rec,
        take,
        "prints",
        &prints(take, &frames, &touches),
        [0.035 * reach, 0.004 * reach],
        color,
    )
}

/// A link that touches the ground.
#[derive(Clone, Copy)]
struct Touch {
    link: usize,
    /// Where, in the lane.
    at: [f32; 3],
}

fn touches(take: &Take<'_>, frame: usize) -> Vec<Touch> {
    let trajectory = take.trajectory();
    let links = trajectory.first_body(frame).iter().zip(&trajectory.shapes).enumerate();
    let lowest = links.map(|(link, (pose, shape))| {
        let [x, y, _] = pose.position_m.map(f64::from);
        let up = trajectory.ground.normal(x, y);
        let [x, y, z] = lowest_point(shape, pose, &up);
        let floor_m = trajectory.ground.height_m(f64::from(x), f64::from(y)) as f32;
        let [lane_x, lane_y] = take.heading.turn([x, y]);
        (Touch { link, at: [lane_x, lane_y, floor_m] }, (z - floor_m) * up.z as f32)
    });
    lowest.filter(|(_, height_m)| *height_m < TOUCH_M).map(|(touch, _)| touch).collect()
}

/// The point of a solid that is lowest over a ground that faces a way; of a face or an edge that lies flat, its middle.
fn lowest_point(shape: &Shape, pose: &Pose, up: &Vector3<f64>) -> [f32; 3] {
    let [i, j, k, w] = pose.rotation_xyzw.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    let down = rotation.inverse_transform_vector(&-up);
    let half = shape.half_extents_m();
    let side = |along: f64| if along.abs() < 0.04 { 0.0 } else { along.signum() };
    let local = match *shape {
        Shape::Cuboid { .. } => down.map(side).component_mul(&half),
        Shape::Cylinder { radius_m, .. } => {
            let round = libm::hypot(down.x, down.y);
            let share = if round < 0.04 { 0.0 } else { radius_m / round };
            vector![share * down.x, share * down.y, side(down.z) * half.z]
        }
        Shape::Sphere { radius_m } => radius_m * down,
        Shape::Capsule { radius_m, length_m } => {
            radius_m * down + vector![0.0, 0.0, side(down.z) * length_m / 2.0]
        }
    };
    let offset = rotation * local;
    let [x, y, z] = pose.position_m;
    [x + offset.x as f32, y + offset.y as f32, z + offset.z as f32]
}

/// A row whenever there is a new print: it and those before it. The first row has none, and settling leaves none.
fn prints(
    take: &Take<'_>,
    frames: &[usize],
    touches: &[Vec<Touch>],
) -> Vec<(usize, Vec<[f32; 3]>)> {
    let times_s = &take.trajectory().times_s;
    let mut last_s = vec![f64::NEG_INFINITY; take.trajectory().shapes.len()];
    let mut all: Vec<[f32; 3]> = Vec::new();
    let mut rows = vec![(frames[0], Vec::new())];
    for (&frame, touches) in frames.iter().zip(touches) {
        let (now_s, before) = (times_s[frame], all.len());
        for touch in touches {
            if now_s >= take.trajectory().scoring_from_s && now_s - last_s[touch.link] > AIR_S {
                all.push(touch.at);
            }
            last_s[touch.link] = now_s;
        }
        if all.len() > before && frame != frames[0] {
            rows.push((frame, all[all.len().saturating_sub(PRINTS)..].to_vec()));
        }
    }
    rows
}

/// Flat discs on the ground, others in each row.
fn discs(
    rec: &RecordingStream,
    take: &Take<'_>,
    name: &str,
    rows: &[(usize, Vec<[f32; 3]>)],
    [radius, thickness]: [f32; 2],
    color: rerun::Color,
) -> Result<(), ViewError> {
    let path = take.path(name);
    let style = Cylinders3D::update_fields().with_colors([color]).with_fill_mode(FillMode::Solid);
    rec.log(path.as_str(), &style)?;
    let all = || rows.iter().flat_map(|(_, points)| points);
    let counts = rows.iter().map(|(_, points)| points.len());
    let columns = Cylinders3D::update_fields()
        .with_lengths(all().map(|_| thickness))
        .with_radii(all().map(|_| radius))
        .with_centers(all().map(|&[x, y, floor_m]| [x, y, floor_m + thickness / 2.0]))
        .columns(counts)?;
    let frames: Vec<usize> = rows.iter().map(|&(frame, _)| frame).collect();
    take.send(rec, path, &frames, columns)
}
