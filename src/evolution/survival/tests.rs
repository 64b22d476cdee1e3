//! Who lives on under which scheme.

use super::*;
use crate::evolution::{Evaluation, Fitness, Gene, Id};
use crate::rng::Stream;
use bytemuck::{Pod, Zeroable};

/// A genome is one number from 0 to 1; it is its own feature, and worth nothing in particular.
struct Line;

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
struct Place(f64);

impl Gene for Place {
    const WIRE_NAME: &'static str = "islands.tests.Place.v1";

    fn is_valid(&self) -> bool {
        true
    }
}

impl Problem for Line {
    type Gene = Place;

    fn random_gene(&self, _: &mut Stream) -> Place {
        Place(0.5)
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Place> {
        vec![self.random_gene(rng)]
    }

    fn distance(&self, a: &[Place], b: &[Place]) -> f64 {
        (a[0].0 - b[0].0).abs()
    }

    fn evaluate(&self, _: &[Place]) -> Evaluation {
        Evaluation::scored(0.0)
    }

    fn features(&self, genome: &[Place]) -> [f64; 2] {
        [genome[0].0, 0.0]
    }
}

fn id(index: u32) -> Id {
    Id { island: 0, generation: 0, index }
}

fn one(index: u32, place: f64, score: f64) -> Individual<Place> {
    Individual {
        id: id(index),
        parents: [None; 2],
        origin: 0,
        genome: vec![Place(place)],
        fitness: Fitness::new(score),
    }
}

fn child(index: u32, parents: [u32; 2], place: f64, score: f64) -> Individual<Place> {
    Individual { parents: parents.map(|parent| Some(id(parent))), ..one(index, place, score) }
}

fn indices(population: &[Individual<Place>]) -> Vec<u32> {
    population.iter().map(|one| one.id.index).collect()
}

#[test]
fn elites_live_on_before_their_offspring() {
    let old = [one(0, 0.0, 1.0), one(1, 0.0, 3.0), one(2, 0.0, 2.0)];
    let brood = vec![one(3, 0.0, 0.0)];
    assert_eq!(indices(&elitist(&old, brood, 2)), [1, 2, 3]);
}

#[test]
fn in_a_crowd_a_child_replaces_the_parent_that_it_is_like_if_it_is_better() {
    let old = [one(0, 0.1, 1.0), one(1, 0.9, 5.0)];
    let crowd = |brood| indices(&crowding::crowd(&Line, &old, brood));
    assert_eq!(crowd(vec![child(2, [0, 1], 0.2, 2.0)]), [2, 1]);
    assert_eq!(crowd(vec![child(2, [0, 1], 0.8, 2.0)]), [0, 1], "it is worse than that parent");
    assert_eq!(crowd(vec![child(2, [0, 1], 0.8, 6.0)]), [0, 2]);
    let twins = vec![child(2, [0, 0], 0.2, 3.0), child(3, [0, 0], 0.2, 2.0)];
    assert_eq!(crowd(twins), [2, 1], "the place was taken by a better one");
}

#[test]
fn the_young_survive_whom_nobody_as_young_can_beat() {
    let born = |index, origin, score| Individual { origin, ..one(index, 0.0, score) };
    let old = [born(0, 0, 9.0), born(1, 0, 8.0), born(2, 3, 5.0)];
    let brood = vec![born(3, 3, 6.0), born(4, 7, 1.0), born(5, 7, 0.5)];
    // Nobody is better and younger than 0, 3 and 4; among the rest nobody than 1, 2 and 5.
    assert_eq!(indices(&afpo::pareto(&old, brood.clone())), [0, 3, 4]);
    let more: Vec<_> = old.iter().cloned().chain([born(6, 0, 0.1), born(7, 0, 0.0)]).collect();
    assert_eq!(indices(&afpo::pareto(&more, brood)), [0, 3, 4, 1, 2]);
}

#[test]
fn of_clones_one_is_in_front() {
    let clones: Vec<_> = (0..3).map(|index| one(index, 0.0, 9.0)).collect();
    let other = Individual { origin: 1, ..one(3, 0.0, 1.0) };
    assert_eq!(indices(&afpo::pareto(&clones, vec![other])), [0, 3, 1]);
}

#[test]
fn who_lives_alone_keeps_its_fitness_and_a_crowd_shares_one() {
    let crowd = [one(0, 0.5, 3.0), one(1, 0.5, 3.0), one(2, 0.9, 3.0), one(3, 0.1, 1.0)];
    let shared = niching::shared(&Line, &crowd, 0.1);
    assert_eq!(shared[0], shared[1]);
    assert_eq!(shared[2].get(), 2.0 * shared[0].get());
    assert_eq!(shared[3].get(), 0.0);
    let failed = [one(0, 0.5, f64::NAN), one(1, 0.5, 1.0)];
    assert_eq!(niching::shared(&Line, &failed, 0.1)[0], Fitness::WORST);
}

#[test]
fn a_map_has_the_best_of_each_cell_in_the_order_of_the_cells() {
    let all = [one(0, 0.9, 1.0), one(1, 0.1, 2.0), one(2, 0.12, 3.0), one(3, 0.95, 1.0)];
    assert_eq!(indices(&map_elites::fill(&Line, 4, all.clone())), [2, 0]);
    assert_eq!(indices(&map_elites::fill(&Line, 64, all)), [1, 2, 0, 3]);
    let failed = [one(0, 0.1, f64::NAN), one(1, 0.9, f64::NAN)];
    assert_eq!(indices(&map_elites::fill(&Line, 4, failed.clone())), [0]);
    let [a, b] = failed;
    assert_eq!(indices(&map_elites::fill(&Line, 4, [a, b, one(2, 0.5, -9.0)])), [2]);
}

#[test]
fn every_feature_has_a_cell() {
    assert_eq!(map_elites::cell([0.0, 1.0], 8), [0, 7]);
    assert_eq!(map_elites::cell([f64::NAN, -1.0], 8), [0, 0]);
    assert_eq!(map_elites::cell([0.5, f64::INFINITY], 8), [4, 7]);
}

#[test]
fn a_scheme_is_read_as_it_is_written() {
    for scheme in ["generational", "sharing:0.1", "crowding", "afpo", "map-elites:8"] {
        assert_eq!(scheme.parse::<Survival>().unwrap().to_string(), scheme);
    }
    for wrong in ["", "steady", "afpo:1", "sharing:0", "map-elites:1", "map-elites:2.5"] {
        assert!(wrong.parse::<Survival>().is_err(), "{wrong}");
    }
}
