//! Several bodies in one film.

use super::kit::*;
use crate::creature::Shape;
use crate::problems::Task;
use crate::simulation::{Engine, Entrant, Meeting, Trajectory, Trial, film_together};
use nalgebra::Vector3;
use rerun::log::Chunk;

const CUBE: Shape = Shape::Cuboid { half_extents_m: Vector3::new(0.2, 0.2, 0.1) };

/// The centre of the only box of an entity, frame by frame.
fn centres_m(chunks: &[Chunk], body: &str) -> Vec<[f32; 3]> {
    points(chunks, &format!("/islands/0/{body}/boxes"), "Boxes3D:centers")
}

fn centres_of(film: &Trajectory, link: usize) -> Vec<[f32; 3]> {
    film.poses.iter().map(|poses| poses[link].position_m).collect()
}

#[test]
fn two_bodies_that_collide_are_both_in_the_film_and_the_camera_follows_the_first() {
    let [below, above] = [body(&[CUBE]), body(&[CUBE])];
    let falling = Entrant { offset_m: Vector3::new(0.1, 0.0, 0.4), ..Entrant::alone(&above) };
    let trial = Trial { settle_s: 0.0, scored_s: 2.0, ..Task::Walk.trial() };
    let entrants = [Entrant::alone(&below), falling];
    let filmed = film_together(&entrants, &trial, Meeting::Collide, Engine::Rapier);
    let (measured, film) = filmed.expect("bodies collide there");
    measured.expect("nobody blows up");

    let chunks = record(|recorder| {
        let mut clip = clip(0, 0, film.clone());
        (clip.creature, clip.others) = (below.clone(), vec![above.clone()]);
        recorder.champion(&clip)?;
        recorder.report(&report(0, 0))
    });

    let [first, second] = ["champion", "others/1"].map(|body| centres_m(&chunks, body));
    let shown = first.len();
    assert!(shown > 25, "{shown} frames");
    assert_eq!(first, centres_of(&film, 0)[..shown]);
    assert_eq!(second, centres_of(&film, 1)[..shown]);
    let frames = |body: &str| {
        chunks.iter().any(|chunk| chunk.entity_path().to_string() == format!("/islands/0/{body}"))
    };
    assert!(frames("others/1") && !frames("others/2"), "each has the frame of the lane");

    // One lies on the other: they did collide.
    let last = film.poses.last().expect("there are frames");
    let above_m = last[1].position_m[2] - last[0].position_m[2];
    assert!((above_m - 0.2).abs() < 0.02, "{above_m} m");
    let follow = points(&chunks, "/islands/0/follow", "Transform3D:translation");
    assert!(follow.iter().all(|[_, _, z]| *z < 0.25), "{follow:?}");
}
