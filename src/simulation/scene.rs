//! The world that a body is tried in: a plane, gravity, a clock.

use rapier3d::prelude::*;

/// How a body is tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Steps a second.
    pub steps_per_s: u32,
    /// Acceleration of gravity, downwards, in m/s².
    pub gravity_m_s2: f64,
    /// Where the body begins.
    pub start: Start,
    /// Time to come to rest before scoring, in seconds; motors hold still meanwhile.
    pub settle_s: f64,
    /// Time that is scored, in seconds.
    pub scored_s: f64,
    /// Whether a body that gains momentum out of nothing is refused.
    pub keeps_ledger: bool,
}

/// Where a body begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// With its root this high, in metres.
    RootAt(f64),
    /// With its lowest point this high, in metres.
    LowestAt(f64),
}

impl Trial {
    /// The simulated time after a number of steps, in seconds.
    pub fn time_s(&self, step: u32) -> f64 {
        f64::from(step) / f64::from(self.steps_per_s)
    }

    /// All steps of a trial that runs to its end.
    pub fn steps(&self) -> u32 {
        self.steps_in_exactly(self.settle_s) + self.steps_in_exactly(self.scored_s)
    }

    /// The nearest number of steps to a period, at least 1.
    pub(super) fn steps_in(&self, period_s: f64) -> u32 {
        self.steps_in_exactly(period_s).max(1)
    }

    pub(super) fn steps_in_exactly(&self, period_s: f64) -> u32 {
        (period_s * f64::from(self.steps_per_s)).round() as u32
    }
}

/// Friction of the ground and of every link; their product acts between them. From the course.
pub(super) const FRICTION: f32 = 0.5;

/// The ground belongs to this group and touches the creature; links of one creature never touch each other,
/// since most overlap their neighbours at birth.
const GROUND_GROUP: Group = Group::GROUP_1;
const CREATURE_GROUP: Group = Group::GROUP_2;

/// A world with a ground, without a body yet.
pub struct Scene {
    pub(super) world: PhysicsWorld,
}

impl Scene {
    /// An empty world for a trial.
    pub fn new(trial: &Trial) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -trial.gravity_m_s2 as f32);
        world.integration_parameters = IntegrationParameters {
            dt: 1.0 / trial.steps_per_s as f32,
            // Each iteration is a whole substep: one at a small time step is as sound as four, and three
            // times faster.
            num_solver_iterations: 1,
            max_ccd_substeps: 0,
            ..IntegrationParameters::default()
        };
        let ground = ColliderBuilder::halfspace(nalgebra::Unit::new_unchecked(Vector::Z))
            .friction(FRICTION)
            .friction_combine_rule(CoefficientCombineRule::Multiply)
            .collision_groups(InteractionGroups::new(
                GROUND_GROUP,
                CREATURE_GROUP,
                InteractionTestMode::And,
            ));
        world.insert_collider(ground, None);
        Self { world }
    }

    /// Advances the world by one step.
    pub fn step(&mut self) {
        self.world.step();
    }

    /// The collider of a link, touching the ground alone.
    pub(super) fn link_collider(builder: ColliderBuilder) -> ColliderBuilder {
        builder
            .friction(FRICTION)
            .friction_combine_rule(CoefficientCombineRule::Multiply)
            .collision_groups(InteractionGroups::new(
                CREATURE_GROUP,
                GROUND_GROUP,
                InteractionTestMode::And,
            ))
    }
}
