//! A body that was read, as JSON: what counts of it here.

use super::urdf::ReadBody;
use crate::creature::{Joint, JointKind, Link, Motor, Shape, Wave};
use nalgebra::Isometry3;
use serde::Serialize;

/// A body, in the form that is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyInspection {
    /// Where it comes from.
    pub source: String,
    /// Its name.
    pub name: String,
    /// The time between two motor updates, in seconds.
    pub control_period_s: f64,
    /// Roll, pitch and yaw of the root at the start, in radians.
    pub root_rpy: [f64; 3],
    /// What of the file does not count, a sentence each.
    pub notes: Vec<String>,
    /// The links, the root first and every parent before its children.
    pub links: Vec<BodyLink>,
}

/// A link, in the frame of its solid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyLink {
    /// Its name in the file.
    pub name: String,
    /// Its parent's place among the links, from 0; none for the root.
    pub parent_index: Option<usize>,
    /// `cylinder`, `box`, `sphere` or `capsule`.
    pub shape: &'static str,
    /// Size along the axes of the solid, in metres; a capsule's with its ends.
    pub size: [f64; 3],
    /// Mass in kilograms.
    pub mass: f64,
    /// The centre of mass, in metres.
    pub centre: [f64; 3],
    /// Moments of inertia about it, in kg·m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
    /// The place of the solid's centre at rest, the root's at the origin, in metres.
    pub rest_xyz: [f64; 3],
    /// Its rotation then, a unit quaternion (x, y, z, w).
    pub rest_xyzw: [f64; 4],
    /// `revolute` or `fixed`; none for the root.
    pub joint: Option<&'static str>,
    /// The hinge's axis in the joint's frame.
    pub axis: Option<[f64; 3]>,
    /// What drives it.
    pub motor: Option<BodyMotor>,
}

/// A motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyMotor {
    /// The form of its wave.
    pub waveform: String,
    /// The largest target speed, in rad/s.
    pub amplitude_rad_s: f64,
    /// The phase before the first update, in radians.
    pub phase_start_rad: f64,
    /// Phase gained at each update, in radians.
    pub phase_step_rad: f64,
    /// The largest torque, in newton metres.
    pub torque_nm_max: f64,
}

impl BodyInspection {
    /// Inspects a body.
    pub fn new(body: &ReadBody, source: impl Into<String>) -> Self {
        let morphology = &body.creature.morphology;
        let poses = morphology.rest_poses();
        let controller = &body.creature.controller;
        let driven = |index: usize| Some((controller.motors[index]?, *controller.wave(index)?));
        let links = morphology.links.iter().zip(&poses).zip(&body.link_names).enumerate();
        Self {
            source: source.into(),
            name: body.name.clone(),
            control_period_s: controller.period_s,
            root_rpy: super::rotation::roll_pitch_yaw_rad(&morphology.root_rotation),
            notes: body.notes.clone(),
            links: links.map(|(i, ((l, pose), name))| link(name, l, pose, driven(i))).collect(),
        }
    }
}

fn link(name: &str, link: &Link, pose: &Isometry3<f64>, driven: Option<(Motor, Wave)>) -> BodyLink {
    let m = link.inertia_kg_m2();
    let kind = link.joint.as_ref().map(|joint| joint.kind);
    BodyLink {
        name: name.to_owned(),
        parent_index: link.joint.as_ref().map(|Joint { parent, .. }| *parent),
        shape: Shape::name(&link.shape),
        size: (link.shape.half_extents_m() * 2.0).into(),
        mass: link.mass_kg,
        centre: link.centre_m().into(),
        inertia: [m.m11, m.m22, m.m33, m.m12, m.m13, m.m23],
        rest_xyz: pose.translation.vector.into(),
        rest_xyzw: pose.rotation.coords.into(),
        joint: kind.map(|kind| if kind == JointKind::Fixed { "fixed" } else { "revolute" }),
        axis: match kind {
            Some(JointKind::Revolute(axis)) => Some(axis.into()),
            _ => None,
        },
        motor: driven.map(|(motor, wave)| BodyMotor {
            waveform: wave.waveform.to_string(),
            amplitude_rad_s: wave.amplitude_rad_s,
            phase_start_rad: wave.phase_start_rad,
            phase_step_rad: wave.phase_step_rad,
            torque_nm_max: motor.torque_nm_max,
        }),
    }
}
