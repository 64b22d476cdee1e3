//! Bodies made by hand that other engines were asked about, too.
//!
//! `fixtures/physics/hand` has them as URDF, for other engines, and what they are in one manifest. All are tried as
//! the course tries creatures: for 10 s of 2,400 steps, from where the manifest lifts them to, without settling.
//!
//! How far an engine may be from the others is how far these are from each other, since all solve contacts, and none
//! solves them exactly. PyBullet 3.2.7 and MuJoCo 4.0.0, metres:
//!
//! | body | PyBullet | MuJoCo | allowed | why |
//! |---|---|---|---|---|
//! | wheels4 | 2.964 | 2.953 | 2.91–3.01 | it rolls on four wheels: 3.0 m/s·s less a start, and all agree to 0.4 % |
//! | wheels2 | 2.791 | 2.803 | 2.70–2.90 | it drags its trunk's edge: how it leans depends on the contacts' softness |
//! | wheel1 | 1.005 | 1.100 | 0.90–1.20 | it turns round its one wheel, and the two differ by 9 % |
//! | hinge_flap | 0.330 | 0.270 | 0.24–0.36 | a path of trembling: every step counts, and the two differ by 20 % |
//! | paddle_walker | 0.381 | 0.116 | 0.05–0.60 | stick and slip: the two differ by a factor of three |

use islands::creature::{
    Controller, Creature, Joint, JointKind, Link, Morphology, Motor, Shape, Wave, Waveform,
};
use islands::simulation::{self, Engine, Ground, Guards, Medium, Perturbation, Start, Trial};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use serde::Deserialize;

#[derive(Deserialize)]
struct Body {
    name: String,
    links: Vec<Part>,
    /// Where the root's centre begins, in metres.
    z_lift: f64,
}

#[derive(Deserialize)]
struct Part {
    /// -1 for the root.
    parent: i64,
    shape: String,
    length: f64,
    radius: f64,
    mass: f64,
    jtype: String,
    /// 0 x, 1 y, 2 z, in the part's own frame.
    axis: usize,
    xyz: [f64; 3],
    rpy: [f64; 3],
    wave: Waveform,
    /// Phase gained at each motor update, in radians.
    freq: f64,
}

impl Part {
    fn link(&self) -> Link {
        let Self { length, radius, .. } = *self;
        let shape = match self.shape.as_str() {
            "cylinder" => Shape::Cylinder { radius_m: radius, length_m: length },
            _ => Shape::Cuboid { half_extents_m: Vector3::new(radius, radius, length / 2.0) },
        };
        let joint = usize::try_from(self.parent).ok().map(|parent| self.joint(parent));
        Link { shape, mass_kg: self.mass, inertia: None, joint }
    }

    /// The joint is at the part's centre, as all are in the course.
    fn joint(&self, parent: usize) -> Joint {
        let [roll, pitch, yaw] = self.rpy;
        let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Joint {
            parent,
            parent_from_joint: Isometry3::from_parts(Translation3::from(self.xyz), rotation),
            joint_from_link: Isometry3::identity(),
            kind: match self.jtype.as_str() {
                "fixed" => JointKind::Fixed,
                _ => JointKind::Revolute(Vector3::ith(self.axis, 1.0)),
            },
        }
    }

    fn driven(&self) -> Option<(Motor, Wave)> {
        let wave = Wave {
            waveform: self.wave,
            amplitude_rad_s: 1.0,
            phase_start_rad: 0.0,
            phase_step_rad: self.freq,
        };
        let is_driven = self.parent >= 0 && self.jtype == "revolute";
        is_driven.then_some((Motor { torque_nm_max: 5.0 }, wave))
    }
}

impl Body {
    fn creature(&self) -> Creature {
        Creature {
            morphology: Morphology {
                links: self.links.iter().map(Part::link).collect(),
                root_rotation: UnitQuaternion::identity(),
            },
            controller: Controller::of_waves(0.1, self.links.iter().map(Part::driven)),
        }
    }

    fn trial(&self) -> Trial {
        Trial {
            steps_per_s: 240,
            perturbation: Perturbation::NONE,
            gravity_m_s2: 10.0,
            ground: Ground::Plane,
            medium: Medium::Void,
            start: Start::RootAt(self.z_lift),
            settle_s: 0.0,
            scored_s: 10.0,
            guards: Guards { keeps_ledger: false, ..Guards::ALL },
            others: Vec::new(),
        }
    }

    /// How far from where it was after the first step its root ends, in the plane, in metres.
    fn distance_m(&self, engine: Engine) -> f64 {
        let measured = simulation::simulate(&self.creature(), &self.trial(), engine).unwrap();
        (measured.root_last_m - measured.root_first_m).xy().norm()
    }

    /// The length of its root's path in space, in metres.
    fn path_m(&self, engine: Engine) -> f64 {
        let (_, film) = simulation::film(&self.creature(), &self.trial(), engine);
        let roots: Vec<Vector3<f32>> =
            film.poses.iter().map(|links| links[0].position_m.into()).collect();
        roots.windows(2).map(|pair| f64::from((pair[1] - pair[0]).norm())).sum()
    }
}

fn body(name: &str) -> Body {
    let manifest = include_str!("../../fixtures/physics/hand/manifest.json");
    let bodies: Vec<Body> = serde_json::from_str(manifest).unwrap();
    bodies.into_iter().find(|body| body.name == name).unwrap()
}

#[test]
fn a_body_made_by_hand_gets_as_far_as_in_other_engines() {
    for engine in Engine::ALL {
        for (name, least_m, most_m) in [
            ("wheels4", 2.91, 3.01),
            ("wheels2", 2.70, 2.90),
            ("wheel1", 0.90, 1.20),
            ("paddle_walker", 0.05, 0.60),
        ] {
            let distance_m = body(name).distance_m(engine);
            eprintln!("{name} in {engine}: {distance_m:.4} m");
            assert!((least_m..most_m).contains(&distance_m), "{engine}: {name} {distance_m} m");
        }
    }
}

#[test]
fn a_body_that_trembles_moves_along_as_long_a_path_as_in_other_engines() {
    for engine in Engine::ALL {
        let path_m = body("hinge_flap").path_m(engine);
        eprintln!("hinge_flap in {engine}: {path_m:.4} m");
        assert!((0.24..0.36).contains(&path_m), "{engine}: {path_m} m");
    }
}

#[test]
fn a_body_without_a_motor_lies_where_it_fell() {
    for engine in Engine::ALL {
        for name in ["fallbox", "fallcyl_side"] {
            let distance_m = body(name).distance_m(engine);
            eprintln!("{name} in {engine}: {distance_m:.4} m");
            assert!(distance_m < 0.02, "{engine}: {name} {distance_m} m");
        }
    }
}
