//! The gene table: what each of the 17 numbers is for.

use super::gene::PARAMETER_COUNT;
use super::profile::Profile;
use std::f64::consts::TAU;

/// What a parameter is for in one profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Use {
    /// What a value of 0 means.
    pub from: f64,
    /// What a value of 1, which is never quite reached, would mean.
    pub to: f64,
    /// The unit of the range; empty for a choice or a share.
    pub unit: &'static str,
    /// What it does.
    pub meaning: &'static str,
}

/// A row of the gene table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The name that the course program gives it.
    pub name: &'static str,
    /// In profile `coursework`.
    pub coursework: Use,
    /// In profile `lecture`.
    pub lecture: Use,
    /// In profile `native`, with what was changed against the lecture and why.
    pub native: Use,
}

impl Parameter {
    /// What the parameter is for in a profile.
    pub fn used(&self, profile: Profile) -> Use {
        match profile {
            Profile::Coursework => self.coursework,
            Profile::Lecture => self.lecture,
            Profile::Native => self.native,
        }
    }
}

const fn spans(from: f64, to: f64, unit: &'static str, meaning: &'static str) -> Use {
    Use { from, to, unit, meaning }
}

/// The gene table: what each of the 17 numbers means.
///
/// `coursework` is the encoding of thousands of existing genomes, dead parameters included; `lecture`
/// brings every parameter to life, with lower bounds that keep a body fit for simulation; `native`
/// keeps the lecture's parameters and changes their ranges so that bodies can really walk: parts as heavy
/// as wood, attached to one another, and motors that are fast and strong enough to lift them.
pub const PARAMETERS: [Parameter; PARAMETER_COUNT] = [
    Parameter {
        name: "link-shape",
        coursework: spans(0.0, 1.0, "", "ignored: always a cylinder"),
        lecture: spans(0.0, 1.0, "", "below 0.5 a cylinder, else a box of the same extents"),
        native: spans(0.0, 1.0, "", "as lecture"),
    },
    Parameter {
        name: "link-length",
        coursework: spans(0.0, 2.0, "m", "extent along the link's z axis"),
        lecture: spans(
            0.1,
            1.0,
            "m",
            "extent along the link's z axis; from 0.1: thinner ones fly apart",
        ),
        native: spans(
            0.2,
            0.8,
            "m",
            "as lecture; limbs long enough to stride, none that dwarfs the rest",
        ),
    },
    Parameter {
        name: "link-radius",
        coursework: spans(0.0, 1.0, "m", "radius about the z axis"),
        lecture: spans(
            0.05,
            1.0,
            "m",
            "radius, or half the side of a box; from 0.05 as the length",
        ),
        native: spans(
            0.05,
            0.15,
            "m",
            "as lecture; limbs rather than drums, and mass ratios under 100",
        ),
    },
    Parameter {
        name: "link-recurrence",
        coursework: spans(
            1.0,
            4.0,
            "copies",
            "whole part: how often the link and all it carries are built",
        ),
        lecture: spans(1.0, 5.0, "copies", "as coursework, up to 4"),
        native: spans(
            1.0,
            4.0,
            "copies",
            "as coursework: four of everything is rarely a body under 32 links",
        ),
    },
    Parameter {
        name: "link-mass",
        coursework: spans(1.0, 1.0, "kg/m³", "ignored: density 1"),
        lecture: spans(0.1, 1.0, "kg/m³", "density; from 0.1: a link without mass has no dynamics"),
        native: spans(
            500.0,
            1000.0,
            "kg/m³",
            "density of wood to water, so that weight and grip are real",
        ),
    },
    Parameter {
        name: "joint-type",
        coursework: spans(0.0, 1.0, "", "ignored: always revolute"),
        lecture: spans(0.0, 1.0, "", "below 0.5 revolute, else fixed"),
        native: spans(0.0, 0.625, "", "as lecture, but four of five joints move"),
    },
    Parameter {
        name: "joint-parent",
        coursework: spans(0.0, 1.0, "", "share of the way through the earlier links: the parent"),
        lecture: spans(0.0, 1.0, "", "as coursework"),
        native: spans(0.0, 1.0, "", "as coursework"),
    },
    Parameter {
        name: "joint-axis-xyz",
        coursework: spans(0.0, 1.0, "", "up to 0.33 the joint's X axis, up to 0.66 Y, else Z"),
        lecture: spans(0.0, 1.0, "", "as coursework"),
        native: spans(0.0, 1.0, "", "as coursework; Z twists the limb"),
    },
    Parameter {
        name: "joint-origin-rpy-1",
        coursework: spans(
            0.0,
            TAU,
            "rad",
            "roll × sibling index: turns the copies of a link apart",
        ),
        lecture: spans(0.0, TAU, "rad", "as coursework"),
        native: spans(
            0.0,
            TAU,
            "rad",
            "× sibling index: turns limb and attachment about the parent's z axis, so that copies stand \
             around a trunk instead of inside each other",
        ),
    },
    Parameter {
        name: "joint-origin-rpy-2",
        coursework: spans(0.0, TAU, "rad", "pitch"),
        lecture: spans(0.0, TAU, "rad", "as coursework"),
        native: spans(
            -TAU / 4.0,
            TAU / 4.0,
            "rad",
            "tilt away from straight out of the parent: limbs point outwards, not into the body",
        ),
    },
    Parameter {
        name: "joint-origin-rpy-3",
        coursework: spans(0.0, TAU, "rad", "yaw"),
        lecture: spans(0.0, TAU, "rad", "as coursework"),
        native: spans(0.0, TAU, "rad", "turn about the limb's own axis: where its hinge points"),
    },
    Parameter {
        name: "joint-origin-xyz-1",
        coursework: spans(0.0, 1.0, "m", "x of the joint in the parent's frame"),
        lecture: spans(0.0, 1.0, "m", "as coursework"),
        native: spans(
            -1.0,
            1.0,
            "half extents",
            "in half extents of the parent: the direction in which its surface is met, so that \
             the parts of a body touch",
        ),
    },
    Parameter {
        name: "joint-origin-xyz-2",
        coursework: spans(0.0, 1.0, "m", "y of the joint"),
        lecture: spans(0.0, 1.0, "m", "as coursework"),
        native: spans(-1.0, 1.0, "half extents", "as above"),
    },
    Parameter {
        name: "joint-origin-xyz-3",
        coursework: spans(0.0, 1.0, "m", "z of the joint"),
        lecture: spans(0.0, 1.0, "m", "as coursework"),
        native: spans(-1.0, 1.0, "half extents", "as above"),
    },
    Parameter {
        name: "control-waveform",
        coursework: spans(0.0, 1.0, "", "up to 0.5 pulse, else sine"),
        lecture: spans(0.0, 1.0, "", "a third each: sine, pulse, ramp"),
        native: spans(0.0, 1.0, "", "as lecture; copies run half a cycle apart, as legs do"),
    },
    Parameter {
        name: "control-amp",
        coursework: spans(0.0, 0.25, "rad/s", "ignored: the amplitude is 1 rad/s"),
        lecture: spans(0.0, 0.25, "rad/s", "the largest speed that the motor aims at"),
        native: spans(0.0, 8.0, "rad/s", "as lecture; a walking leg swings at several rad/s"),
    },
    Parameter {
        name: "control-freq",
        coursework: spans(0.0, 1.0, "rad/update", "phase gained at each motor update, every 0.1 s"),
        lecture: spans(0.0, 1.0, "rad/update", "as coursework"),
        native: spans(
            0.25,
            2.0,
            "Hz",
            "phase gained a second, whatever the update rate: strides of half a second to four",
        ),
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_ascend() {
        for parameter in PARAMETERS {
            for profile in Profile::ALL {
                let Use { from, to, .. } = parameter.used(profile);
                assert!(from <= to, "{} in {profile}", parameter.name);
            }
        }
    }
}
