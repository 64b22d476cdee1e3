//! The tables that an experiment leaves, for programs and for people.

use super::analysis::{Comparison, Summary};
use super::archive::Run;
use super::definition::Plan;
use serde::Serialize;

/// A row a run. The last column is the only one that the definition does not fix.
pub fn runs_csv(plan: &Plan, runs: &[Vec<Run>]) -> Vec<u8> {
    let fixed = ["final_generation", "evaluations", "best", "validated", "apart"];
    let fixed = fixed.into_iter().chain(["success", "evaluations_to_target"]);
    let varied = plan.varied.iter().map(String::as_str);
    let head = ["setting"].into_iter().chain(varied).chain(["seed"]).chain(fixed);
    let mut rows = vec![head.chain(["digest", "seconds"]).map(str::to_owned).collect::<Vec<_>>()];
    for (setting, runs) in plan.settings.iter().zip(runs) {
        let values = setting.values(&plan.varied);
        for run in runs {
            let mut row = vec![setting.name.clone()];
            row.extend(values.iter().cloned());
            row.extend(cells(run, plan.target));
            rows.push(row);
        }
    }
    csv(|writer| rows.iter().try_for_each(|row| writer.write_record(row)))
}

fn cells(run: &Run, target: Option<f64>) -> [String; 10] {
    let (trial, end) = (&run.trial, run.trial.end());
    let reached = target.map(|target| trial.evaluations_to(target));
    [
        run.seed.to_string(),
        end.generation.to_string(),
        end.evaluations.to_string(),
        end.best.map(exactly).unwrap_or_default(),
        trial.validated.map(exactly).unwrap_or_default(),
        trial.apart.map(exactly).unwrap_or_default(),
        reached.map(|reached| reached.is_some().to_string()).unwrap_or_default(),
        reached.flatten().map(|evaluations| evaluations.to_string()).unwrap_or_default(),
        trial.digest.clone(),
        format!("{:.3}", run.seconds),
    ]
}

/// A row a run and generation.
pub fn curves_csv(plan: &Plan, runs: &[Vec<Run>]) -> Vec<u8> {
    #[derive(Serialize)]
    struct Row<'a> {
        setting: &'a str,
        seed: u64,
        generation: u32,
        evaluations: u64,
        best: Option<f64>,
        mean: Option<f64>,
        diversity: f64,
    }
    let all = plan.settings.iter().zip(runs);
    let mut all = all.flat_map(|(setting, runs)| runs.iter().map(move |run| (setting, run)));
    csv(|writer| {
        all.try_for_each(|(setting, run)| {
            run.trial.curve.iter().try_for_each(|point| {
                let (setting, seed) = (setting.name.as_str(), run.seed);
                let super::trial::Point { generation, evaluations, best, mean, diversity } = *point;
                let row = Row { setting, seed, generation, evaluations, best, mean, diversity };
                writer.serialize(row)
            })
        })
    })
}

/// A row a setting.
pub fn summary_csv(summaries: &[Summary]) -> Vec<u8> {
    csv(|writer| summaries.iter().try_for_each(|row| writer.serialize(row)))
}

/// A row a pair of settings; only the head if there is but one setting.
pub fn comparisons_csv(comparisons: &[Comparison]) -> Vec<u8> {
    csv(|writer| match comparisons {
        [] => writer.write_record(["a", "b", "u", "p", "p_holm", "a12"]),
        rows => rows.iter().try_for_each(|row| writer.serialize(row)),
    })
}

fn csv(fill: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    fill(&mut writer).expect("rows have as many cells as their head, and memory takes everything");
    writer.into_inner().expect("memory takes everything")
}

/// The settings, a row each, the first row their heads.
pub fn settings(summaries: &[Summary]) -> Vec<[String; 9]> {
    let head = ["setting", "runs", "median", "Q1", "Q3", "min", "max", "success", "evaluations"];
    let row = |it: &Summary| {
        let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
        [
            it.setting.clone(),
            it.n.to_string(),
            number(it.median),
            number(it.q1),
            number(it.q3),
            number(it.min),
            number(it.max),
            it.success_rate.map_or_else(|| "–".to_owned(), |rate| format!("{:.0} %", rate * 100.0)),
            it.median_evaluations_to_target.map_or_else(|| "–".to_owned(), |n| format!("{n:.0}")),
        ]
    };
    [head.map(str::to_owned)].into_iter().chain(summaries.iter().map(row)).collect()
}

/// The comparisons, a row each, the first row their heads.
pub fn pairs(comparisons: &[Comparison]) -> Vec<[String; 6]> {
    let head = ["a", "b", "U", "p", "p (Holm)", "A12"].map(str::to_owned);
    let row = |it: &Comparison| {
        let a12 = format!("{:.2}", it.a12);
        [it.a.clone(), it.b.clone(), it.u.to_string(), short(it.p), short(it.p_holm), a12]
    };
    [head].into_iter().chain(comparisons.iter().map(row)).collect()
}

/// All of it for people, as Markdown.
pub fn summary_md(
    plan: &Plan,
    unit: &str,
    summaries: &[Summary],
    comparisons: &[Comparison],
) -> String {
    let seeds = plan.seeds.len();
    let budget = plan.evaluations.map(|n| format!(", {n} evaluations each")).unwrap_or_default();
    let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
    let mut text = format!(
        "# {} settings, {seeds} seeds{budget}\n\n\
         ![The median of the best fitness against evaluations, with quartiles](convergence.svg)\n\n\
         Best fitness{unit} of each run:\n\n{}",
        plan.settings.len(),
        markdown(&settings(summaries)),
    );
    if let Some(target) = plan.target {
        text += &format!(
            "\nSuccess is a best fitness of at least {target}; “evaluations” is the median of what that took, runs \
             that never got there counted as endless.\n"
        );
    }
    if !comparisons.is_empty() {
        text += &format!(
            "\n{}\nMann–Whitney U of the best fitnesses, two-sided; Holm corrects for the number of comparisons. A12 \
             is the probability that a run of a is better than one of b: 0.5 is none, 0.56 a small, 0.64 a medium, \
             0.71 a large effect, and as much below 0.5.\n",
            markdown(&pairs(comparisons))
        );
    }
    text + &format!("\nislands {}, as in experiment.toml.\n", env!("CARGO_PKG_VERSION"))
}

fn markdown<const COLUMNS: usize>(rows: &[[String; COLUMNS]]) -> String {
    let line = |row: &[String; COLUMNS]| format!("| {} |\n", row.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(COLUMNS));
    let mut lines: Vec<String> = rows.iter().map(line).collect();
    lines.insert(1, rule);
    lines.concat()
}

/// The shortest text that is read back to the same bits.
fn exactly(value: f64) -> String {
    match value.abs() {
        0.0 | 1e-5..1e16 => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// A number with four digits that count.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    match size {
        1e-3..1e-2 => format!("{value:.6}"),
        1e-2..1e-1 => format!("{value:.5}"),
        1e-1..1.0 => format!("{value:.4}"),
        1.0..10.0 => format!("{value:.3}"),
        10.0..100.0 => format!("{value:.2}"),
        100.0..1e3 => format!("{value:.1}"),
        1e3..1e7 => format!("{value:.0}"),
        _ => format!("{value:.3e}"),
    }
}
