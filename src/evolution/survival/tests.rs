//! Who lives on under which scheme.

use super::*;
use crate::evolution::generation::{Moment, select};
use crate::evolution::population::ranking;
use crate::evolution::{Evaluation, Fitness, Gene, Id, Strategy};
use crate::rng::{Purpose, Source};
use bytemuck::{Pod, Zeroable};
use rand::RngExt;

const SOURCE: Source = Source { seed: 8, island: 0 };

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

fn stream(seed: u64) -> Stream {
    Source { seed, island: 0 }.stream(1, 0, Purpose::Survival)
}

fn indices(population: &[Individual<Place>]) -> Vec<u32> {
    population.iter().map(|one| one.id.index).collect()
}

#[test]
fn elites_live_on_before_their_offspring() {
    let old = [one(0, 0.0, 1.0), one(1, 0.0, 3.0), one(2, 0.0, 2.0)];
    let brood = vec![one(3, 0.0, 0.0)];
    let next = Survival::Generational.survivors(&Line, &old, brood, 2, &mut stream(0));
    assert_eq!(indices(&next), [1, 2, 3]);
}

#[test]
fn who_drifts_takes_the_youngest_of_equals_for_the_best() {
    let old = [one(0, 0.0, 1.0), one(1, 0.0, 3.0), one(2, 0.0, 2.0)];
    let brood = vec![one(3, 0.0, 3.0), one(4, 0.0, 0.0)];
    let next = Survival::Drifting.survivors(&Line, &old, brood, 1, &mut stream(0));
    assert_eq!(indices(&next), [3, 4, 1]);
    assert_eq!(ranking(&next)[0], 0);
}

#[test]
fn in_a_crowd_everybody_is_a_parent_twice_whatever_its_fitness() {
    for individuals in [2, 3, 8, 9] {
        let couples = crowding::couples(individuals, &mut stream(individuals as u64));
        assert_eq!(couples.len(), individuals);
        let mut mothers: Vec<usize> = couples.iter().map(|couple| couple[0]).collect();
        let mut fathers: Vec<usize> = couples.iter().map(|couple| couple[1]).collect();
        mothers.sort_unstable();
        fathers.sort_unstable();
        assert!(mothers.iter().copied().eq(0..individuals) && mothers == fathers);
        for pair in couples.chunks_exact(2) {
            assert_eq!(pair[0], [pair[1][1], pair[1][0]]);
        }
    }
}

#[test]
fn in_a_crowd_a_child_replaces_the_parent_that_it_is_like_if_it_is_better() {
    let old = [one(0, 0.1, 1.0), one(1, 0.9, 5.0)];
    let crowd =
        |brood: [Individual<Place>; 2]| indices(&crowding::crowd(&Line, &old, brood.to_vec()));
    let [near, far] = [0.2, 0.8];
    assert_eq!(crowd([child(2, [0, 1], near, 2.0), child(3, [1, 0], far, 2.0)]), [2, 1]);
    assert_eq!(crowd([child(2, [0, 1], near, 0.5), child(3, [1, 0], far, 6.0)]), [0, 3]);
    assert_eq!(
        crowd([child(2, [0, 1], far, 6.0), child(3, [1, 0], near, 2.0)]),
        [3, 2],
        "children face the parents that they are more like, both together"
    );
    let alone = crowding::crowd(&Line, &old, vec![child(2, [1, 1], near, 6.0)]);
    assert_eq!(indices(&alone), [0, 2]);
}

/// Two hills, the second one higher: crowding keeps both, where selection by fitness keeps one.
#[test]
fn niches_persist_in_a_crowd() {
    let hill = |place: f64| 1.0 - 10.0 * (place - 0.2).abs().min((place - 0.8).abs() - 0.02);
    let climb = |survival: Survival| {
        let mut population: Vec<_> = (0..20)
            .map(|index| f64::from(index) / 19.0)
            .enumerate()
            .map(|(index, place)| one(index as u32, place, hill(place)))
            .collect();
        for generation in 1..200_u32 {
            let strategy = Strategy { survival, population: 20, ..Strategy::default() };
            let moment = Moment { source: SOURCE, generation };
            let couples = select(&Line, &population, &strategy, moment, strategy.brood());
            let mut rng = SOURCE.stream(generation, 0, Purpose::Mutation);
            let breed = |(index, couple): (usize, &[usize; 2])| {
                let [mother, father] = couple.map(|parent| &population[parent]);
                let middle = (mother.genome[0].0 + father.genome[0].0) / 2.0;
                let place = middle + 0.02 * (rng.random::<f64>() - 0.5);
                let id = Id { island: 0, generation, index: index as u32 };
                let parents = [Some(mother.id), Some(father.id)];
                Individual { id, parents, ..one(0, place, hill(place)) }
            };
            let brood = couples.iter().enumerate().map(breed).collect();
            let mut fate = SOURCE.stream(generation, 0, Purpose::Survival);
            population = survival.survivors(&Line, &population, brood, 2, &mut fate);
        }
        [0.2, 0.8]
            .map(|top| population.iter().filter(|one| (one.genome[0].0 - top).abs() < 0.05).count())
    };
    let [low, high] = climb(Survival::Crowding);
    assert!(low >= 4 && high >= 4 && low + high == 20, "{low} and {high}");
    let [low, high] = climb(Survival::Generational);
    assert!(low == 0 || high == 0, "{low} and {high}");
}

fn born(index: u32, origin: u32, score: f64) -> Individual<Place> {
    Individual { origin, ..one(index, 0.0, score) }
}

#[test]
fn the_young_survive_whom_nobody_as_young_can_beat() {
    let old = [born(0, 0, 9.0), born(1, 0, 8.0), born(2, 3, 5.0)];
    let brood = vec![born(3, 3, 6.0), born(4, 7, 1.0), born(5, 7, 0.5)];
    // Nobody is better and younger than 0, 3 and 4, and there is no room for more.
    for seed in 0..20 {
        let next = afpo::pareto(&old, brood.clone(), &mut stream(seed));
        assert_eq!(indices(&next), [0, 3, 4]);
    }
    // With more room tournaments decide who of the others lives on.
    let more: Vec<_> = old.iter().cloned().chain([born(6, 0, 0.1), born(7, 0, 0.0)]).collect();
    let mut lucky = std::collections::BTreeSet::new();
    for seed in 0..200 {
        let next = indices(&afpo::pareto(&more, brood.clone(), &mut stream(seed)));
        assert!(next.len() == 5 && [0, 3, 4].iter().all(|one| next.contains(one)), "{next:?}");
        lucky.extend(next);
    }
    assert_eq!(lucky.len(), 8, "everybody has a chance: {lucky:?}");
}

#[test]
fn of_clones_one_is_in_front() {
    let clones: Vec<_> = (0..3).map(|index| one(index, 0.0, 9.0)).collect();
    let other = Individual { origin: 1, ..one(3, 0.0, 1.0) };
    for seed in 0..20 {
        let next = indices(&afpo::pareto(&clones, vec![other.clone()], &mut stream(seed)));
        assert!(next.contains(&0) && next.contains(&3), "{next:?}");
    }
}

#[test]
fn under_age_fitness_pareto_newcomers_breed_like_everybody_else() {
    let mut population: Vec<_> = (0..9).map(|index| one(index, 0.0, 100.0)).collect();
    population.push(Individual { origin: 5, ..one(9, 0.0, 0.0) });
    let strategy = Strategy { survival: Survival::Afpo, ..Strategy::default() };
    let moment = Moment { source: SOURCE, generation: 1 };
    let couples = select(&Line, &population, &strategy, moment, 2_000);
    let newcomer = couples.iter().flatten().filter(|&&parent| parent == 9).count();
    assert!((330..470).contains(&newcomer), "{newcomer} of 4,000 parents, not a tenth");
}

#[test]
fn who_lives_alone_keeps_its_fitness_and_a_crowd_shares_one() {
    let crowd = [one(0, 0.5, 3.0), one(1, 0.5, 3.0), one(2, 0.9, 3.0), one(3, 0.1, 1.0)];
    let shared = sharing::shared(&Line, &crowd, 0.1);
    assert_eq!(shared[0], shared[1]);
    assert_eq!(shared[2].get(), 2.0 * shared[0].get());
    assert_eq!(shared[3].get(), 0.0);
    let failed = [one(0, 0.5, f64::NAN), one(1, 0.5, 1.0)];
    assert_eq!(sharing::shared(&Line, &failed, 0.1)[0], Fitness::WORST);
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
    let names = [
        "generational",
        "drifting",
        "sharing:0.1",
        "species:3",
        "crowding",
        "afpo",
        "map-elites:8",
    ];
    assert_eq!(Survival::USUAL.map(|scheme| scheme.to_string()), names);
    assert_eq!(names.map(str::parse), Survival::USUAL.map(Ok));
    for wrong in ["", "steady", "afpo:1", "sharing:0", "map-elites:1", "map-elites:2.5"] {
        assert!(wrong.parse::<Survival>().is_err(), "{wrong}");
    }
}

/// Two crowds of six and a loner, whose fitness is its place.
fn crowds() -> Vec<Individual<Place>> {
    let places = [0.1, 0.11, 0.12, 0.13, 0.14, 0.15, 0.5, 0.8, 0.81, 0.82, 0.83, 0.84, 0.85];
    (0..).zip(places).map(|(index, place)| one(index, place, place)).collect()
}

fn here(generation: u32) -> species::Here {
    species::Here { source: SOURCE, generation }
}

#[test]
fn who_is_alike_is_of_one_species_and_mean_fitness_decides_how_many_offspring_it_has() {
    let population = crowds();
    let species = species::Species::first(&Line, &population, 0.2);
    assert_eq!(species.of_each(), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    let uniform = Selection::Tournament { size: 1 };
    let couples = species.couples(&population, uniform, |index| index % 2 == 0, here(1));
    // Means of 0.125, 0.5 and 0.825 share 13 places; of two species of six the champions live on.
    assert_eq!(couples.len(), 11);
    let mothers = |own: std::ops::Range<usize>| {
        couples.iter().filter(|couple| own.contains(&couple[0])).count()
    };
    assert_eq!([mothers(0..6), mothers(6..7), mothers(7..13)], [0, 5, 6]);
    assert!(couples.iter().all(|&[mother, father]| mother >= father), "she is the fitter one");
    let next = species.survivors(&population, vec![one(99, 0.1, 0.1); 11], here(1));
    assert_eq!(indices(&next)[..3], [5, 12, 99], "champions of more than five live on");
    assert_eq!(next.len(), population.len());
}

#[test]
fn a_species_that_does_not_improve_for_fifteen_generations_has_no_offspring() {
    let mut population = crowds();
    let mut species = species::Species::first(&Line, &population, 0.2);
    for generation in 1..=17 {
        let couples =
            species.couples(&population, Selection::Roulette, |_| false, here(generation));
        let has_offspring =
            |own: std::ops::Range<usize>| couples.iter().any(|couple| own.contains(&couple[0]));
        assert_eq!(has_offspring(6..7), generation <= 15, "generation {generation}");
        assert!(has_offspring(7..13));
        let next: Vec<_> = population.clone();
        // The best of the last species gets better and better.
        population[12].fitness = Fitness::new(f64::from(generation));
        species = species.after(&Line, &next, &population, 0.2, here(generation));
        assert_eq!(species.count(), 3);
        assert!(species.is_sound(13, generation) && !species.is_sound(12, generation));
    }
}

#[test]
fn an_immigrant_finds_its_species_or_founds_one_and_residents_keep_theirs() {
    let before = crowds();
    let species = species::Species::first(&Line, &before, 0.2);
    let mut now = before.clone();
    now[0] = one(50, 0.84, 0.1);
    now[1] = one(51, 0.3001, 0.1);
    let species = species.with_immigrants(&Line, &before, &now, 0.1, here(1));
    assert_eq!(species.of_each()[..3], [2, 3, 0]);
    assert_eq!(species.of_each()[6..], [1, 2, 2, 2, 2, 2, 2]);
    assert_eq!(species.count(), 4);
}
