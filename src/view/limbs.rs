//! The links of a champion and of whoever is in its world, and the pins of their driven joints.
//!
//! All of a body's links of one kind of solid are one entity: their sizes are one row at the start, their poses one
//! batch for the whole clip.

use super::extent::{along_z, every};
use super::take::Take;
use super::{ViewError, palette};
use crate::creature::{Creature, JointKind, Link, Shape, Wave};
use crate::simulation::trajectory::Pose;
use nalgebra::{Isometry3, Quaternion as Rotation, Translation3, UnitQuaternion, Vector3, vector};
use rerun::{Boxes3D, Capsules3D, Color, Cylinders3D, FillMode, Quaternion, RecordingStream};
use std::f64::consts::{PI, TAU};
use std::iter::{RepeatN, repeat_n};
use std::ops::Range;

/// Colours per second of a motor's pin.
const MOTOR_RATE: f64 = 15.0;
/// The length and the thickness of a pin, in radii of the link that it turns.
const PIN: [f64; 2] = [2.5, 0.3];

/// Writes the bodies of a clip.
pub(super) fn show(rec: &RecordingStream, take: &Take<'_>) -> Result<(), ViewError> {
    let (clip, mut links) = (take.clip(), take.trajectory().links());
    let (creature, path) = (&clip.creature, take.path("champion"));
    let color = |link| palette::link(clip.hue, link);
    Limbs { take, creature, links: links.next().unwrap_or_default(), path }.show(rec, color)?;
    for (number, (creature, links)) in (1..).zip(clip.others.iter().zip(links)) {
        let path = take.path(&format!("others/{number}"));
        Limbs { take, creature, links, path }.show(rec, palette::other)?;
    }
    Ok(())
}

/// The links of one body.
struct Limbs<'a> {
    take: &'a Take<'a>,
    creature: &'a Creature,
    /// Which of the film's links they are.
    links: Range<usize>,
    path: String,
}

impl Limbs<'_> {
    fn show(&self, rec: &RecordingStream, color: impl Fn(usize) -> Color) -> Result<(), ViewError> {
        rec.log(self.path.as_str(), &self.take.heading.transform())?;
        let mut boxes = Kind::default();
        let mut cylinders = Kind::default();
        let mut capsules = Kind::default();
        for (index, link) in self.links.clone().enumerate() {
            let color = color(index);
            match self.take.trajectory().shapes[link] {
                Shape::Cuboid { half_extents_m: h } => {
                    boxes.push(link, [h.x as f32, h.y as f32, h.z as f32], color);
                }
                Shape::Cylinder { radius_m, length_m } => {
                    cylinders.push(link, [length_m as f32, radius_m as f32], color);
                }
                Shape::Sphere { radius_m } => capsules.push(link, [0.0, radius_m as f32], color),
                Shape::Capsule { radius_m, length_m } => {
                    capsules.push(link, [length_m as f32, radius_m as f32], color);
                }
            }
        }
        self.show_boxes(rec, &boxes)?;
        self.show_cylinders(rec, &cylinders)?;
        self.show_capsules(rec, &capsules)?;
        self.show_pins(rec)
    }

    fn path(&self, name: &str) -> String {
        format!("{}/{name}", self.path)
    }

    fn show_boxes(&self, rec: &RecordingStream, kind: &Kind<3>) -> Result<(), ViewError> {
        let (take, path) = (self.take, self.path("boxes"));
        if kind.links.is_empty() {
            // Without this row the boxes of the champion before would stay.
            return Ok(rec.log(path, &Boxes3D::clear_fields())?);
        }
        let solids = Boxes3D::from_half_sizes(kind.sizes.iter().copied())
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        let poses = Boxes3D::update_fields()
            .with_centers(kind.positions(take))
            .with_quaternions(kind.rotations(take))
            .columns(kind.lengths(take))?;
        take.send(rec, path, &take.frames, poses)
    }

    fn show_cylinders(&self, rec: &RecordingStream, kind: &Kind<2>) -> Result<(), ViewError> {
        let (take, path) = (self.take, self.path("cylinders"));
        if kind.links.is_empty() {
            return Ok(rec.log(path, &Cylinders3D::clear_fields())?);
        }
        let (lengths, radii): (Vec<_>, Vec<_>) = kind.sizes.iter().map(|&[l, r]| (l, r)).unzip();
        let solids = Cylinders3D::from_lengths_and_radii(lengths, radii)
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        let poses = Cylinders3D::update_fields()
            .with_centers(kind.positions(take))
            .with_quaternions(kind.rotations(take))
            .columns(kind.lengths(take))?;
        take.send(rec, path, &take.frames, poses)
    }

    /// Capsules, and spheres as capsules without a length. No gene makes them: the champion before had none that
    /// could stay.
    fn show_capsules(&self, rec: &RecordingStream, kind: &Kind<2>) -> Result<(), ViewError> {
        if kind.links.is_empty() {
            return Ok(());
        }
        let (take, path) = (self.take, self.path("capsules"));
        let (lengths, radii): (Vec<_>, Vec<_>) = kind.sizes.iter().map(|&[l, r]| (l, r)).unzip();
        let solids = Capsules3D::from_lengths_and_radii(lengths, radii)
            .with_colors(kind.colors.iter().copied())
            .with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;
        // Rerun's stand on their first end, ours about their middle.
        let lengths = kind.sizes.iter().map(|&[length, _]| length).cycle();
        let starts =
            kind.poses(take).zip(lengths).map(|(pose, length)| along_z(&pose, -length / 2.0));
        let poses = Capsules3D::update_fields()
            .with_translations(starts)
            .with_quaternions(kind.rotations(take))
            .columns(kind.lengths(take))?;
        take.send(rec, path, &take.frames, poses)
    }

    fn pins(&self) -> Vec<Pin> {
        let Creature { morphology, controller } = self.creature;
        let links = morphology.links.iter().zip(self.links.clone()).enumerate();
        links
            .filter_map(|(index, (link, shown))| Pin::of(shown, link, *controller.wave(index)?))
            .collect()
    }

    fn show_pins(&self, rec: &RecordingStream) -> Result<(), ViewError> {
        let (take, path, pins) = (self.take, self.path("motors"), self.pins());
        if pins.is_empty() {
            return Ok(rec.log(path, &Cylinders3D::clear_fields())?);
        }
        let [lengths, radii] =
            PIN.map(|share| pins.iter().map(move |pin| (share * pin.radius_m) as f32));
        let solids =
            Cylinders3D::from_lengths_and_radii(lengths, radii).with_fill_mode(FillMode::Solid);
        rec.log(path.as_str(), &solids)?;

        let poses = &take.trajectory().poses;
        let at = |&f: &usize| pins.iter().map(move |pin| pin.at(&poses[f]));
        let places: Vec<_> = take.frames.iter().flat_map(at).collect();
        let centers = places.iter().map(|place| {
            let at = place.translation.vector;
            [at.x as f32, at.y as f32, at.z as f32]
        });
        let rotations = places.iter().map(|place| {
            let [i, j, k, w] = place.rotation.coords.map(|value| value as f32).into();
            Quaternion::from_xyzw([i, j, k, w])
        });
        let rows = Cylinders3D::update_fields()
            .with_centers(centers)
            .with_quaternions(rotations)
            .columns(repeat_n(pins.len(), take.frames.len()))?;
        take.send(rec, path.clone(), &take.frames, rows)?;
        self.show_drives(rec, path, &pins)
    }

    /// The colours of the pins: light while the motor drives one way, dark while it drives the other.
    fn show_drives(
        &self,
        rec: &RecordingStream,
        path: String,
        pins: &[Pin],
    ) -> Result<(), ViewError> {
        let take = self.take;
        let picks = every(&take.times_s(), MOTOR_RATE, f64::INFINITY);
        let frames: Vec<_> = picks.into_iter().map(|pick| take.frames[pick]).collect();
        let (trajectory, period_s) = (take.trajectory(), self.creature.controller.period_s);
        let colors = frames.iter().flat_map(|&f| {
            let scored_s = trajectory.times_s[f] - trajectory.scoring_from_s;
            pins.iter().map(move |pin| palette::drive(pin.drive(scored_s, period_s) as f32))
        });
        let rows = Cylinders3D::update_fields()
            .with_colors(colors)
            .columns(repeat_n(pins.len(), frames.len()))?;
        take.send(rec, path, &frames, rows)
    }
}

/// The links of one kind of solid, each with `N` numbers for its size.
#[derive(Default)]
struct Kind<const N: usize> {
    links: Vec<usize>,
    sizes: Vec<[f32; N]>,
    colors: Vec<Color>,
}

impl<const N: usize> Kind<N> {
    fn push(&mut self, link: usize, size: [f32; N], color: Color) {
        self.links.push(link);
        self.sizes.push(size);
        self.colors.push(color);
    }

    /// The poses of the links, frame after frame.
    fn poses(&self, take: &Take<'_>) -> impl Iterator<Item = Pose> {
        let poses = &take.trajectory().poses;
        take.frames.iter().flat_map(move |&f| self.links.iter().map(move |&link| poses[f][link]))
    }

    fn positions(&self, take: &Take<'_>) -> impl Iterator<Item = [f32; 3]> {
        self.poses(take).map(|pose| pose.position_m)
    }

    fn rotations(&self, take: &Take<'_>) -> impl Iterator<Item = Quaternion> {
        self.poses(take).map(|pose| Quaternion::from_xyzw(pose.rotation_xyzw))
    }

    fn lengths(&self, take: &Take<'_>) -> RepeatN<usize> {
        repeat_n(self.links.len(), take.frames.len())
    }
}

/// A pin through a driven joint, along its axis.
struct Pin {
    link: usize,
    /// What its motor follows.
    wave: Wave,
    /// Where the pin is in the link's frame, along z.
    link_from_pin: Isometry3<f64>,
    radius_m: f64,
}

impl Pin {
    fn of(index: usize, link: &Link, wave: Wave) -> Option<Self> {
        let joint = link.joint.as_ref()?;
        let JointKind::Revolute(axis) = joint.kind else { return None };
        let turn = UnitQuaternion::rotation_between(&Vector3::z(), &axis)
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI));
        let along = Isometry3::from_parts(Translation3::identity(), turn);
        let half = link.shape.half_extents_m();
        let link_from_pin = joint.joint_from_link.inverse() * along;
        Some(Self { link: index, wave, link_from_pin, radius_m: half.x.min(half.z) })
    }

    fn at(&self, poses: &[Pose]) -> Isometry3<f64> {
        let Pose { position_m, rotation_xyzw } = poses[self.link];
        let [x, y, z] = position_m.map(f64::from);
        let [i, j, k, w] = rotation_xyzw.map(f64::from);
        let rotation = UnitQuaternion::from_quaternion(Rotation::new(w, i, j, k));
        Isometry3::from_parts(Translation3::from(vector![x, y, z]), rotation) * self.link_from_pin
    }

    /// Which way the motor drives at a time of scoring, from -1 to 1; before it, nowhere.
    fn drive(&self, scored_s: f64, period_s: f64) -> f64 {
        if scored_s < 0.0 {
            return 0.0;
        }
        let updates = (scored_s / period_s).floor() + 1.0;
        let phase = (self.wave.phase_start_rad + updates * self.wave.phase_step_rad) % TAU;
        self.wave.waveform.at(phase)
    }
}
