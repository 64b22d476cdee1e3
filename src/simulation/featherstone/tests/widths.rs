//! Worlds side by side against one alone, bit by bit.

use super::TRIAL;
use crate::creature::{Creature, Gene, Profile, express};
use crate::simulation::failure::Failure;
use crate::simulation::lanes::Everywhere;
use crate::simulation::lanes::width::{Alone, Avx2, Avx512, Pair, Width, avx2, avx512, pair};
use crate::simulation::{
    Abreast, Engine, Measurement, Start, Trial, simulate, simulate_abreast, terrain,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn random_creature(seed: u64) -> Creature {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let genes = 1 + seed as usize % 5;
    let genome: Vec<Gene> =
        (0..genes).map(|_| Gene(std::array::from_fn(|_| rng.random()))).collect();
    express(&genome, Profile::Native, 16).unwrap()
}

/// Everything that was measured, to the last bit; zeros have no sign.
fn bits(measured: &Result<Measurement, Failure>) -> Result<Vec<u64>, Failure> {
    let measured = measured.as_ref().map_err(|outcome| *outcome)?;
    let places = [
        measured.root_first_m,
        measured.root_last_m,
        measured.centre_first_m,
        measured.centre_last_m,
    ];
    let places = places.iter().flat_map(|place| place.iter().copied());
    let track = measured.track_m.iter().flat_map(|place| place.iter().copied());
    let rest = measured.heights_m.iter().copied().chain([measured.path_m, measured.extent_m]);
    Ok(places.chain(track).chain(rest).map(|number| (number + 0.0).to_bits()).collect())
}

#[test]
fn a_trial_has_the_same_bits_whatever_goes_beside_it_and_whatever_the_processor_does_at_a_time() {
    let walk = || Trial { start: Start::LeaningAt(0.1), settle_s: 0.5, scored_s: 2.0, ..TRIAL };
    for seed in 0..24 {
        let creature = random_creature(seed);
        let usual = if seed % 4 == 3 { walk().on(terrain::mountain()) } else { walk() };
        // More than eight, so that worlds are used again; another number than any width divides.
        let trials: Vec<Trial> = (0..11).map(|index| usual.perturbed(index)).collect();
        let alone = |trial| simulate(&creature, trial, Engine::Featherstone);
        let expected: Vec<_> = trials.iter().map(alone).collect();
        for abreast in Abreast::here() {
            let lanes = abreast.lanes();
            let found = simulate_abreast(&creature, &trials, abreast);
            for (index, (expected, found)) in expected.iter().zip(&found).enumerate() {
                assert_eq!(bits(expected), bits(found), "{seed}, {index}, {lanes} at a time");
            }
        }
    }
}

/// What a width makes of some numbers, lane by lane.
fn worked<W: Width>(width: W, a: &[f64], b: &[f64]) -> Vec<Vec<u64>> {
    let all = |numbers: &[f64]| {
        let mut all = width.real(0.0);
        numbers.iter().enumerate().for_each(|(lane, number)| all.set(lane, *number));
        all
    };
    let (a, b) = (all(a), all(b));
    let mixed = a.where_or(a.is_less(b), b * b);
    let results = [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a.abs(),
        a.sqrt(),
        a.max(b),
        a.min(b),
        a.inverse(),
        a.inverse_root(),
        a.within(b.abs()),
        a.where_or(a.is_at_most(b), b),
        a.only(!a.is_less(b) & b.is_at_most(a) | b.is_less(width.real(0.0))),
        mixed,
        (a.single() + b.single()).double(),
        (a.single() / b.single()).sqrt().double(),
        a.single().where_or(a.single().is_less(b.single()), -b.single()).double(),
    ];
    let lane = |lane: usize| {
        // What is no number has many bits.
        let bits =
            |number: f64| if number.is_nan() { f64::NAN.to_bits() } else { number.to_bits() };
        results.iter().map(|all| bits(all.get(lane))).collect()
    };
    (0..W::LANES).map(lane).collect()
}

#[test]
fn every_width_works_as_one_number_does() {
    let odd = [0.0, -0.0, 1.0, -1.5, f64::MIN_POSITIVE, f64::INFINITY, f64::NAN, 1e300, -3e-310];
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut draw = || match rng.random_range(0..3) {
        0 => odd[rng.random_range(0..odd.len())],
        _ => rng.random_range(-10.0..10.0),
    };
    for _ in 0..2_000 {
        let (a, b): (Vec<f64>, Vec<f64>) = (0..8).map(|_| (draw(), draw())).unzip();
        let alone = |lane: usize| worked(Alone, &a[lane..=lane], &b[lane..=lane]).remove(0);
        let expected: Vec<_> = (0..8).map(alone).collect();
        if let Some(pair) = pair() {
            assert_eq!(worked::<Pair>(pair, &a[..2], &b[..2]), expected[..2]);
        }
        if let Some(avx2) = avx2() {
            assert_eq!(worked::<Avx2>(avx2, &a[..4], &b[..4]), expected[..4]);
        }
        if let Some(avx512) = avx512() {
            assert_eq!(worked::<Avx512>(avx512, &a, &b), expected);
        }
    }
}
