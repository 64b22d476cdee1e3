//! Functions to be minimised, shifted and rotated.
//!
//! An optimum in the middle of the domain and axes along the variables are gifts to an algorithm, so the suites of the
//! CEC competitions move the one and, if wished, turn the other. Which shift and which rotation is fixed by the
//! instance's number alone: no seed of a run has a say, and shorter vectors have the same beginning.

use super::fixed;
use super::functions::{Facts, Function};
use crate::evolution::variation::sequences::Layout;
use crate::evolution::variation::values::normal;
use crate::evolution::{Evaluation, Gene, Hurdles, Problem};
use crate::rng::{Purpose, Source, Stream};
use crate::work_queue;
use bytemuck::{Pod, Zeroable};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// A variable as a share of its domain, from 0 (included) to 1 (excluded), so that operators are the same for all
/// problems of real numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
pub struct Real(pub f64);

impl Gene for Real {
    const WIRE_NAME: &'static str = "islands.real.v1";

    fn is_valid(&self) -> bool {
        (0.0..1.0).contains(&self.0)
    }

    fn values(&self) -> &[f64] {
        std::slice::from_ref(&self.0)
    }

    fn values_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(&mut self.0)
    }
}

/// The optimum lies so far from both ends of the domain, as a share of it.
const MARGIN: f64 = 0.1;
/// What costs less in all is done sooner by one thread than dealt out: multiplications, about a tenth of a
/// millisecond.
const WORTH_SHARING: u64 = 100_000;

/// A function with a place for its optimum. The fitness is minus the error, so the best there is is 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Benchmark {
    function: Function,
    /// The optimum, as a genome.
    shift: Vec<Real>,
    /// The rows of the rotation; none if it is not rotated.
    rotation: Vec<Vec<f64>>,
}

impl Benchmark {
    /// A function of so many variables, at least 1, that is shifted and, if wished, rotated as the instance's number
    /// says. Rotating n variables takes n³ multiplications here, and n² at each evaluation.
    pub fn new(function: Function, dimensions: usize, instance: u64, rotated: bool) -> Self {
        let stream = |what| {
            let source = Source { seed: instance, island: function as u32 };
            source.stream(0, what, Purpose::Instance)
        };
        let mut rng = stream(0);
        let place = |share: f64| Real(MARGIN + (1.0 - 2.0 * MARGIN) * share);
        let shift = (0..dimensions).map(|_| place(rng.random())).collect();
        let rotation = if rotated { orthogonal(dimensions, &mut stream(1)) } else { Vec::new() };
        Self { function, shift, rotation }
    }

    /// The function.
    pub fn function(&self) -> Function {
        self.function
    }

    /// The number of its variables.
    pub fn dimensions(&self) -> usize {
        self.shift.len()
    }

    /// The one genome whose error is 0.
    pub fn optimum(&self) -> &[Real] {
        &self.shift
    }

    /// The rows of the rotation; none if it is not rotated.
    pub fn rotation(&self) -> &[Vec<f64>] {
        &self.rotation
    }

    /// The point of the domain that a gene stands for.
    pub fn variable(&self, gene: Real) -> f64 {
        let Facts { low, high, .. } = self.function.facts();
        low + gene.0 * (high - low)
    }

    /// How much worse than the optimum a genome of the right length is, at least 0.
    pub fn error(&self, genome: &[Real]) -> f64 {
        let Facts { scale, optimum, .. } = self.function.facts();
        let away =
            |(gene, best): (&Real, &Real)| scale * (self.variable(*gene) - self.variable(*best));
        let away: Vec<f64> = genome.iter().zip(&self.shift).map(away).collect();
        let turned = match self.rotation.is_empty() {
            true => away,
            false => self.rotation.iter().map(|row| dot(row, &away)).collect(),
        };
        let z: Vec<f64> = turned.into_iter().map(|way| way + optimum).collect();
        self.function.error(&z)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A random orthogonal matrix: rows of normal numbers, each made orthogonal to those before it (Gram–Schmidt), which
/// is uniform over all rotations and reflections (Stewart 1980).
fn orthogonal(dimensions: usize, rng: &mut Stream) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(dimensions);
    while rows.len() < dimensions {
        let mut row: Vec<f64> = (0..dimensions).map(|_| normal(rng)).collect();
        // Twice is enough: the first time leaves the rounding errors of what it took away.
        for _ in 0..2 {
            for other in &rows {
                let share = dot(&row, other);
                row.iter_mut().zip(other).for_each(|(value, other)| *value -= share * other);
            }
        }
        let length = libm::sqrt(dot(&row, &row));
        // One that lies among the others, but for rounding errors, has no direction of its own.
        if length > 1e-6 {
            row.iter_mut().for_each(|value| *value /= length);
            rows.push(row);
        }
    }
    rows
}

impl Problem for Benchmark {
    type Gene = Real;

    fn random_gene(&self, rng: &mut Stream) -> Real {
        Real(rng.random())
    }

    fn random_genome(&self, rng: &mut Stream) -> Vec<Real> {
        (0..self.dimensions()).map(|_| self.random_gene(rng)).collect()
    }

    fn layout(&self) -> Layout {
        Layout::Fixed
    }

    /// The first two variables, as a share of the domain.
    fn features(&self, genome: &[Real]) -> [f64; 2] {
        [0, 1].map(|place| genome.get(place).map_or(0.0, |gene| gene.0))
    }

    fn distance(&self, a: &[Real], b: &[Real]) -> f64 {
        fixed::distance(a, b, |a, b| (a.0 - b.0).abs())
    }

    fn evaluate(&self, genome: &[Real]) -> Evaluation {
        fixed::evaluate(genome, self.dimensions(), |genome| -self.error(genome))
    }

    /// The multiplications, about.
    fn cost(&self, genome: &[Real]) -> u64 {
        let n = genome.len() as u64;
        if self.rotation.is_empty() { 16 * n } else { 16 * n + n * n }
    }

    fn estimate_batch(&self, genomes: &[&[Real]], _: &Hurdles) -> Vec<Evaluation> {
        let costs: Vec<u64> = genomes.iter().map(|genome| self.cost(genome)).collect();
        if costs.iter().sum::<u64>() < WORTH_SHARING {
            return genomes.iter().map(|genome| self.evaluate(genome)).collect();
        }
        work_queue::dearest_first(&costs, |index| self.evaluate(genomes[index]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::encodings::course::VALUE_MAX;
    use crate::evolution::{Fitness, Outcome};

    fn all(dimensions: usize) -> impl Iterator<Item = Benchmark> {
        let both = |function| [false, true].map(|rotated| (function, rotated));
        let all = Function::ALL.into_iter().flat_map(both);
        all.map(move |(function, rotated)| Benchmark::new(function, dimensions, 1, rotated))
    }

    #[test]
    fn the_optimum_is_worth_nothing_less_and_everything_else_less() {
        for problem in all(10) {
            let best = problem.optimum().to_vec();
            assert_eq!(problem.evaluate(&best), Evaluation::scored(0.0), "{problem:?}");
            for place in 0..10 {
                let mut beside = best.clone();
                beside[place].0 += 0.001;
                assert!(problem.evaluate(&beside).fitness < Fitness::new(-1e-12), "{problem:?}");
            }
        }
    }

    #[test]
    fn the_shift_keeps_the_optimum_well_inside_of_the_domain_and_is_another_one_each_time() {
        let mut seen: Vec<Vec<Real>> = Vec::new();
        for function in Function::ALL {
            for instance in 0..20 {
                let shift = Benchmark::new(function, 30, instance, false).shift;
                assert!(shift.iter().all(|gene| (MARGIN..1.0 - MARGIN).contains(&gene.0)));
                assert!(!seen.contains(&shift), "{function} {instance}");
                seen.push(shift);
            }
        }
        let [short, long] = [3, 30].map(|n| Benchmark::new(Function::Ackley, n, 7, false).shift);
        assert_eq!(short, long[..3]);
    }

    #[test]
    fn a_rotation_is_orthogonal_and_mixes_the_variables() {
        for n in [1, 2, 10, 100] {
            let rotation = Benchmark::new(Function::Sphere, n, 3, true).rotation;
            for (i, a) in rotation.iter().enumerate() {
                for (j, b) in rotation.iter().enumerate() {
                    let expected = f64::from(u8::from(i == j));
                    assert!((dot(a, b) - expected).abs() < 1e-13, "rows {i} and {j} of {n}");
                }
            }
            let is_mixed = |row: &Vec<f64>| row.iter().filter(|x| x.abs() > 1e-6).count() > n / 2;
            assert!(rotation.iter().all(is_mixed));
        }
    }

    #[test]
    fn a_rotation_changes_no_distance_and_so_not_the_sphere() {
        let [plain, rotated] = [false, true].map(|it| Benchmark::new(Function::Sphere, 30, 1, it));
        let mut rng = Source { seed: 9, island: 0 }.stream(0, 0, Purpose::Genesis);
        for _ in 0..50 {
            let genome = plain.random_genome(&mut rng);
            let [a, b] = [plain.error(&genome), rotated.error(&genome)];
            assert!((a - b).abs() < 1e-12 * a, "{a} and {b}");
        }
        let [plain, rotated] =
            [false, true].map(|it| Benchmark::new(Function::Rastrigin, 30, 1, it));
        let genome = plain.random_genome(&mut rng);
        assert!((plain.error(&genome) - rotated.error(&genome)).abs() > 1.0);
    }

    #[test]
    fn an_error_is_the_functions_value_at_what_is_left_of_the_way() {
        let problem = Benchmark::new(Function::Rastrigin, 2, 1, false);
        let mut genome = problem.optimum().to_vec();
        // A domain of 10: so one pit further.
        genome[0].0 += if genome[0].0 < 0.5 { 0.1 } else { -0.1 };
        assert!((problem.error(&genome) - 1.0).abs() < 1e-9, "{}", problem.error(&genome));
    }

    #[test]
    fn what_is_no_genome_of_the_problem_is_not_scored() {
        for problem in all(4) {
            let refused = Evaluation::failed(Outcome::TooLarge);
            assert_eq!(problem.evaluate(&[Real(0.5); 3]), refused);
            assert_eq!(problem.evaluate(&[Real(1.0); 4]), refused);
            assert_eq!(problem.evaluate(&[Real(f64::NAN); 4]), refused);
            for edge in [0.0, VALUE_MAX] {
                assert!(problem.evaluate(&[Real(edge); 4]).fitness.finite().is_some());
            }
        }
    }

    #[test]
    fn who_evaluates_a_batch_changes_no_bit() {
        let problem = Benchmark::new(Function::Ackley, 100, 1, true);
        let mut rng = Source { seed: 4, island: 0 }.stream(0, 0, Purpose::Genesis);
        let genomes: Vec<_> = (0..30).map(|_| problem.random_genome(&mut rng)).collect();
        let batch: Vec<&[Real]> = genomes.iter().map(Vec::as_slice).collect();
        let one_by_one: Vec<_> = batch.iter().map(|genome| problem.evaluate(genome)).collect();
        assert!(batch.iter().map(|it| problem.cost(it)).sum::<u64>() > WORTH_SHARING);
        assert_eq!(problem.evaluate_batch(&batch), one_by_one);
    }
}
