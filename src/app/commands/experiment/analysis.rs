//! What the runs of an experiment say.

use super::archive::Run;
use super::definition::Plan;
use super::trial::Trial;
use crate::formats::chart::{Chart, Curve, Point};
use crate::statistics::{self, Five};
use serde::Serialize;
use std::collections::BTreeMap;

/// With more settings of an aim than this, each is compared with the first one only, not with every other.
const ALL_PAIRS_MAX: usize = 6;
/// Parts into which the axis of evaluations is divided.
const PARTS: u32 = 240;

/// What the runs of a setting came to. What could not be scored is worse than any number, and none here.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The setting.
    pub setting: String,
    /// Its runs.
    pub n: usize,
    /// The smallest of their best fitnesses.
    pub min: Option<f64>,
    /// Their lower quartile.
    pub q1: Option<f64>,
    /// Their median.
    pub median: Option<f64>,
    /// Their upper quartile.
    pub q3: Option<f64>,
    /// The largest of them.
    pub max: Option<f64>,
    /// The share of runs that reached the target; none if there is no target.
    pub success_rate: Option<f64>,
    /// The median of the evaluations that took; none if half of the runs never did.
    pub median_evaluations_to_target: Option<f64>,
}

/// Whether two settings differ in their best fitnesses.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// A setting.
    pub a: String,
    /// Another one.
    pub b: String,
    /// In how many pairs of runs the one of `a` is better, ties counted as half.
    pub u: f64,
    /// How probable so large a difference is by chance.
    pub p: f64,
    /// The same with all comparisons of the experiment in mind.
    pub p_holm: f64,
    /// How probable it is that a run of `a` is better than one of `b`.
    pub a12: f64,
}

/// Describes each setting. `runs` has those of each setting in the order of the plan.
pub fn summaries(plan: &Plan, runs: &[Vec<Run>]) -> Vec<Summary> {
    let each = plan.settings.iter().zip(runs);
    each.map(|(setting, runs)| summary(&setting.name, runs, plan.target)).collect()
}

fn summary(name: &str, runs: &[Run], target: Option<f64>) -> Summary {
    let five = Five::of(&bests(runs));
    let number = |pick: fn(&Five) -> f64| five.as_ref().map(pick).filter(|it| it.is_finite());
    let to_target = target.map(|target| {
        let never =
            |run: &Run| run.trial.evaluations_to(target).map_or(f64::INFINITY, |n| n as f64);
        runs.iter().map(never).collect::<Vec<f64>>()
    });
    let successes = |all: &Vec<f64>| all.iter().filter(|it| it.is_finite()).count();
    let median = to_target.as_ref().and_then(|all| Five::of(all)).map(|five| five.median);
    Summary {
        setting: name.to_owned(),
        n: runs.len(),
        min: number(|five| five.least),
        q1: number(|five| five.lower),
        median: number(|five| five.median),
        q3: number(|five| five.upper),
        max: number(|five| five.most),
        success_rate: to_target.as_ref().map(|all| successes(all) as f64 / runs.len() as f64),
        median_evaluations_to_target: median.filter(|median| median.is_finite()),
    }
}

/// Compares each pair of settings with the same aim, or each setting with the first one of its aim if there are many.
pub fn comparisons(plan: &Plan, runs: &[Vec<Run>]) -> Vec<Comparison> {
    let mut alike: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (index, setting) in plan.settings.iter().enumerate() {
        alike.entry(setting.aim()).or_default().push(index);
    }
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for group in alike.values() {
        let firsts = if group.len() <= ALL_PAIRS_MAX { group.len() } else { 1 };
        for (place, &a) in group.iter().enumerate().take(firsts) {
            pairs.extend(group[place + 1..].iter().map(|&b| (a, b)));
        }
    }
    pairs.sort_unstable();
    let compare = |(a, b): (usize, usize)| {
        let (of_a, of_b) = (bests(&runs[a]), bests(&runs[b]));
        let test = statistics::mann_whitney(&of_a, &of_b)?;
        let a12 = statistics::a12(&of_a, &of_b)?;
        let [a, b] = [a, b].map(|index| plan.settings[index].name.clone());
        Some(Comparison { a, b, u: test.u, p: test.p, p_holm: test.p, a12 })
    };
    let mut all: Vec<Comparison> = pairs.into_iter().filter_map(compare).collect();
    let corrected = statistics::holm(&all.iter().map(|it| it.p).collect::<Vec<_>>());
    for (comparison, p_holm) in all.iter_mut().zip(corrected) {
        comparison.p_holm = p_holm;
    }
    all
}

fn bests(runs: &[Run]) -> Vec<f64> {
    runs.iter().map(|run| run.trial.worth()).collect()
}

/// How the settings converge: the median of the best fitness so far against evaluations, and the quartiles around
/// it. Where no fitness is above 0 it is minus an error, which is drawn on a logarithmic axis.
pub fn convergence(plan: &Plan, runs: &[Vec<Run>]) -> Chart {
    let bests = || {
        let points = runs.iter().flatten().flat_map(|run| &run.trial.curve);
        points.filter_map(|point| point.best)
    };
    let is_error = bests().all(|best| best <= 0.0) && bests().any(|best| best < 0.0);
    // Nothing is not on a logarithmic axis: it is drawn where the smallest error is.
    let least = bests().map(|best| -best).filter(|error| *error > 0.0).fold(f64::MAX, f64::min);
    let value = |best: f64| if is_error { (-best).max(least) } else { best };
    let until = runs.iter().flatten().map(|run| run.trial.end().evaluations).max().unwrap_or(0);
    let each = plan.settings.iter().zip(runs).map(|(setting, runs)| Curve {
        name: setting.name.clone(),
        points: curve(runs, until).into_iter().map(|point| convert(point, value)).collect(),
    });
    let unit = runs.iter().flatten().next().map_or("", |run| run.trial.unit.as_str());
    let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    Chart {
        x: "evaluations of all islands".to_owned(),
        y: format!(
            "{}{unit}, median and quartiles",
            if is_error { "error" } else { "best fitness" }
        ),
        is_logarithmic: is_error,
        curves: each.collect(),
    }
}

fn convert(point: Point, value: impl Fn(f64) -> f64) -> Point {
    let (low, high) = (value(point.low), value(point.high));
    Point { x: point.x, low: low.min(high), middle: value(point.middle), high: low.max(high) }
}

/// A setting's curve, from where all its runs have a best to where the first of them ends.
fn curve(runs: &[Run], until: u64) -> Vec<Point> {
    let begins = runs.iter().map(|run| {
        let first = run.trial.curve.iter().find(|point| point.best.is_some());
        first.map_or(u64::MAX, |point| point.evaluations)
    });
    let ends = runs.iter().map(|run| run.trial.end().evaluations);
    let (Some(begin), Some(end)) = (begins.max(), ends.min()) else { return Vec::new() };
    if begin > end {
        return Vec::new();
    }
    let steps = (1..=PARTS).map(|part| (until as f64 * f64::from(part) / f64::from(PARTS)) as u64);
    let within = steps.filter(|at| begin < *at && *at < end);
    let mut places: Vec<u64> = [begin].into_iter().chain(within).chain([end]).collect();
    places.dedup();
    places.into_iter().filter_map(|at| at_evaluations(runs, at)).collect()
}

fn at_evaluations(runs: &[Run], at: u64) -> Option<Point> {
    let bests: Vec<f64> = runs.iter().filter_map(|run| best_after(&run.trial, at)).collect();
    let five = Five::of(&bests)?;
    Some(Point { x: at as f64, low: five.lower, middle: five.median, high: five.upper })
}

/// The best fitness after so many evaluations: between two generations it is that of the one before.
fn best_after(trial: &Trial, evaluations: u64) -> Option<f64> {
    let done = trial.curve.partition_point(|point| point.evaluations <= evaluations);
    trial.curve[..done].last()?.best
}
