//! Promises of what is read and of what is made of it; whole experiments are in `tests/program/experiment.rs`.

use super::analysis;
use super::archive::Run;
use super::definition::{Definition, Plan};
use super::tables;
use super::trial::{Point, Trial};
use crate::formats::chart;
use clap::Args;
use expect_test::expect;

fn plan(text: &str) -> Result<Plan, String> {
    Definition::parse(text)?.plan()
}

fn names(text: &str) -> Vec<String> {
    let plan = plan(text).expect("it makes sense");
    plan.settings.into_iter().map(|setting| setting.name).collect()
}

/// A run of seed 1 with a generation for each pair of evaluations and best.
fn run(curve: &[(u64, f64)]) -> Run {
    let point = |(generation, &(evaluations, best)): (usize, &(u64, f64))| Point {
        generation: generation as u32,
        evaluations,
        best: best.is_finite().then_some(best),
        mean: None,
        diversity: 0.5,
    };
    let curve = curve.iter().enumerate().map(point).collect();
    let (digest, unit) = ("d1ce".to_owned(), "m".to_owned());
    let trial = Trial { digest, unit, validated: None, apart: None, curve };
    Run { seed: 1, key: String::new(), seconds: 0.25, trial }
}

#[test]
fn a_grid_is_every_combination_and_multiplies_named_settings() {
    assert_eq!(names(""), ["base"]);
    let grid = "[grid]\nmigrants = [0, 2]\nselection = [\"rank\", \"roulette\"]\n";
    assert_eq!(
        names(grid),
        [
            "migrants=0,selection=rank",
            "migrants=0,selection=roulette",
            "migrants=2,selection=rank",
            "migrants=2,selection=roulette"
        ]
    );
    let named = "[grid]\nmigrants = [0, 2]\n[[setting]]\nname = \"a\"\n[[setting]]\nname = \"b\"\ngenes = 2\n";
    assert_eq!(names(named), ["a,migrants=0", "a,migrants=2", "b,migrants=0", "b,migrants=2"]);
    let plan = plan(named).expect("it makes sense");
    assert_eq!(plan.varied, ["genes", "migrants"]);
    assert_eq!(plan.settings[3].values(&plan.varied), ["2", "2"]);
    let config = plan.settings[2].config(7);
    assert_eq!((config.genes, config.migrants, config.seed), (2, 0, Some(7)));
}

#[test]
fn what_settings_have_in_common_need_not_mean_something_to_all_of_them() {
    let base = "[base]\nelites = 4\n";
    let searches = "[grid]\nalgorithm = [\"ga\", \"random\"]\n";
    let plan_of_both = plan(&format!("{base}{searches}")).expect("it makes sense");
    assert_eq!(plan_of_both.settings[0].config(1).elites, 4);
    assert_eq!(plan_of_both.settings[1].config(1), {
        let alone = plan("[base]\nalgorithm = \"random\"").expect("it makes sense");
        alone.settings[0].config(1)
    });
    for (text, setting) in [
        (format!("{searches}elites = [1, 4]"), "algorithm=random,elites=1"),
        (format!("{base}algorithm = \"random\""), "base"),
    ] {
        let refusal = plan(&text).expect_err("it means nothing");
        let said = format!("setting {setting}: elites means nothing to random: ");
        assert!(refusal.starts_with(&said), "{refusal}");
    }
}

#[test]
fn settings_may_stand_in_sections() {
    let flat =
        "[base]\nelites = 4\n[grid]\nmigrants = [0, 2]\n[[setting]]\nname = \"a\"\ngenes = 2\n";
    let in_sections = "[base.genetic-algorithm]\nelites = 4\n[grid.migration]\nmigrants = [0, 2]\n\
                       [[setting]]\nname = \"a\"\n[setting.genetic-algorithm]\ngenes = 2\n";
    assert_eq!(plan(in_sections), plan(flat));
    let wrong = plan("[grid.migrations]\nmigrants = [0, 2]").expect_err("there is none");
    assert_eq!(
        wrong,
        "[grid]: there is no section [migrations]: choose one of vectors, creatures, genetic-algorithm, migration, \
         running"
    );
}

#[test]
fn seeds_are_a_number_a_list_or_a_range() {
    let seeds = |text: &str| plan(text).map(|plan| plan.seeds);
    assert_eq!(seeds(""), Ok((1..=10).collect()));
    assert_eq!(seeds("seeds = 3"), Ok(vec![1, 2, 3]));
    assert_eq!(seeds("seeds = [5, 0]"), Ok(vec![5, 0]));
    assert_eq!(seeds("seeds = \"9-11\""), Ok(vec![9, 10, 11]));
    let wrong = [
        "0",
        "-1",
        "[1, 1]",
        "[]",
        "\"3-2\"",
        "\"1-\"",
        "1.5",
        "[-1]",
        "100001",
        "\"0-9999999999999\"",
    ];
    for wrong in wrong {
        let refusal = seeds(&format!("seeds = {wrong}")).expect_err(wrong);
        assert!(refusal.starts_with("seeds must be "), "{refusal}");
    }
}

#[test]
fn tasks_are_other_aims_and_climbing_needs_no_file() {
    let plan = plan("[grid]\ntask = [\"walk\", \"climb\"]").expect("it makes sense");
    let [walk, climb] = [0, 1].map(|index| plan.settings[index].aim());
    assert_ne!(walk, climb);
}

#[test]
fn a_budget_stands_beside_generations_or_instead_of_them() {
    let generations =
        |text: &str| plan(text).expect("it makes sense").settings[0].config(1).generations;
    assert_eq!(generations(""), 140);
    assert_eq!(generations("evaluations = 9"), 1_000_000_000);
    assert_eq!(generations("evaluations = 9\n[base]\ngenerations = 5"), 5);
    assert_eq!(generations("[base]\ngenerations = 5"), 5);
}

#[test]
fn a_run_has_another_key_if_and_only_if_something_that_decides_it_is_another() {
    let key = |text: &str, seed| {
        let plan = plan(text).expect("it makes sense");
        plan.key(&plan.settings[0], seed)
    };
    let first = key("", 1);
    assert_eq!(key("target = 3.0\nseeds = 2\n[[setting]]\nname = \"x\"", 1), first);
    assert_eq!(key("[base]\ngenerations = 140", 1), first);
    for other in [
        key("", 2),
        key("evaluations = 100", 1),
        key("[base]\ngenerations = 141", 1),
        key("[base]\nmigrants = 1", 1),
    ] {
        assert_ne!(other, first);
    }
}

#[test]
fn what_makes_no_sense_is_refused_by_its_name() {
    let refusals = [
        "sedes = 3",
        "evaluations = 0",
        "target = inf",
        "[base]\npopluation = 3",
        "[base]\npopulation = \"many\"",
        "[base]\npopulation = 1",
        "[base]\nseed = 3",
        "[base]\nseed-genomes = { hash = \"\", count = 1 }",
        "[base]\nthreads = 3",
        "[base]\nterrain = { digest = \"\" }",
        "[grid]\nmigrants = 3",
        "[grid]\nmigrants = []",
        "[grid]\nmigrants = [3, 40]",
        "[grid]\nmigrants = [3, \"x\"]",
        "[grid]\nmigrants = [3, 3]",
        "[grid]\nnothing = [3]",
        "[grid]\ngenes = [1, 2]\n[[setting]]\nname = \"a\"\ngenes = 3",
        "[[setting]]\ngenes = 3",
        "[[setting]]\nname = \"a|b\"",
        "[[setting]]\nname = \"a\"\nnothing = 3",
        "[[setting]]\nname = \"a\"\n[[setting]]\nname = \"a\"\ngenes = 3",
        "[[setting]]\nname = \"a\"\n[[setting]]\nname = \"b\"\ngenes = 4",
        "seeds = 50001\n[grid]\nmigrants = [0, 1]",
    ];
    let said: Vec<String> =
        refusals.iter().map(|text| plan(text).expect_err("it makes no sense")).collect();
    expect![[r#"
        line 1: unknown field `sedes`, expected one of `seeds`, `evaluations`, `target`, `version`, `base`, `grid`, `setting`
        evaluations must be at least 1
        target must be a finite number
        [base] has an unknown setting popluation: see islands run --help
        [base] population: invalid type: string "many", expected usize
        setting base: population must be from 2 to 100000, not 1
        [base] must not say seed: say seeds, above all tables
        [base] must not say seed-genomes: runs of an experiment begin with random genomes
        [base] must not say threads: say --threads
        [base] must not say terrain: a configuration does not say which; task = "climb" has one of its own
        [grid] migrants must be a list of values
        [grid] migrants must be a list of values
        setting migrants=40: 40 migrants are more than there can be: take at most 24, with a population of 24
        [grid] migrants: invalid type: string "x", expected usize
        two settings are called migrants=3
        [grid] has an unknown setting nothing: see islands run --help
        both [grid] and setting a say genes
        each [[setting]] needs a name, which is text
        “a|b” is no name for a setting: take up to 200 characters, and no |
        setting a has an unknown setting nothing: see islands run --help
        two settings are called a
        settings a and b are the same
        these are more than 100000 runs"#]]
    .assert_eq(&said.join("\n"));
}

#[test]
fn the_examples_of_the_help_and_of_the_readme_make_sense() {
    let help = super::ExperimentArgs::augment_args(clap::Command::new(""))
        .get_after_help()
        .expect("there is")
        .to_string();
    let example: String = help
        .lines()
        .skip_while(|line| !line.starts_with("  seeds"))
        .take_while(|line| line.is_empty() || line.starts_with("  "))
        .map(|line| format!("{}\n", line.trim()))
        .collect();
    assert_eq!(plan(&example).map(|plan| plan.settings.len()), Ok(4), "{example}");
    let readme = include_str!("../../../../README.md");
    let section = readme.split("## Experiments").nth(1).expect("there is one");
    let example = section.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let plan = plan(example.expect("there is one")).expect("it makes sense");
    assert!(plan.settings.len() > 1);
}

#[test]
fn success_is_counted_and_its_price_is_the_median_over_those_that_never_succeed_too() {
    let plan = plan("target = 2.0").expect("it makes sense");
    let never = f64::NEG_INFINITY;
    let runs = vec![vec![
        run(&[(4, never), (8, 3.0)]),
        run(&[(4, 2.0), (9, 2.0)]),
        run(&[(4, 1.0), (9, 1.5)]),
        run(&[(4, never), (9, never)]),
        run(&[(4, 1.0), (10, 2.5)]),
    ]];
    let summary = &analysis::summaries(&plan, &runs)[0];
    assert_eq!((summary.n, summary.success_rate), (5, Some(0.6)));
    assert_eq!(summary.median_evaluations_to_target, Some(10.0));
    assert_eq!((summary.min, summary.q1, summary.median), (None, Some(1.5), Some(2.0)));
    let most = vec![runs[0][2..].to_vec()];
    let summary = &analysis::summaries(&plan, &most)[0];
    assert_eq!(summary.median_evaluations_to_target, None, "two of three never succeed");
}

#[test]
fn few_settings_are_compared_with_each_other_and_many_with_the_first_and_p_is_corrected() {
    let grid = |settings: usize| {
        let values: Vec<String> = (0..settings).map(|migrants| migrants.to_string()).collect();
        plan(&format!("[grid]\nmigrants = [{}]", values.join(", "))).expect("it makes sense")
    };
    let compared = |settings: usize| {
        let best = |setting: usize, run: usize| (setting * 10 + run) as f64;
        let runs = |setting| (0..5).map(|r| run(&[(1, best(setting, r))])).collect();
        let runs: Vec<Vec<Run>> = (0..settings).map(runs).collect();
        analysis::comparisons(&grid(settings), &runs)
    };
    assert_eq!(compared(1), []);
    let three = compared(3);
    let pairs: Vec<_> = three.iter().map(|it| (it.a.as_str(), it.b.as_str())).collect();
    let [none, one, two] = ["migrants=0", "migrants=1", "migrants=2"];
    assert_eq!(pairs, [(none, one), (none, two), (one, two)]);
    for comparison in &three {
        assert_eq!((comparison.u, comparison.a12), (0.0, 0.0));
        assert!((comparison.p - 2.0 / 252.0).abs() < 1e-12);
        assert!((comparison.p_holm - 6.0 / 252.0).abs() < 1e-12);
    }
    assert_eq!(compared(6).len(), 15);
    assert!(compared(7).len() == 6 && compared(7).iter().all(|it| it.a == none));
}

#[test]
fn curves_are_step_functions_and_as_long_as_all_runs_of_a_setting() {
    let plan = plan("").expect("it makes sense");
    let runs = vec![vec![
        run(&[(10, 1.0), (120, 5.0), (240, 6.0)]),
        run(&[(20, 2.0), (60, 3.0), (200, 9.0)]),
        run(&[(10, 0.5), (130, 4.0), (220, 5.0)]),
    ]];
    let drawn = analysis::convergence(&plan, &runs);
    assert_eq!(
        (drawn.y.as_str(), drawn.is_logarithmic),
        ("best fitness (m), median and quartiles", false)
    );
    let points = &drawn.curves[0].points;
    assert_eq!((points[0].x, points.last().unwrap().x), (20.0, 200.0));
    let at = |x: f64| *points.iter().find(|point| point.x == x).unwrap();
    assert_eq!(at(59.0), chart::Point { x: 59.0, low: 0.75, middle: 1.0, high: 1.5 });
    assert_eq!(at(60.0).middle, 1.0);
    assert_eq!(at(60.0).high, 2.0);
    assert_eq!(at(119.0).middle, 1.0);
    assert_eq!(at(120.0).middle, 3.0);
    assert_eq!(at(200.0), chart::Point { x: 200.0, low: 4.5, middle: 5.0, high: 7.0 });
}

#[test]
fn what_is_minimised_is_drawn_as_an_error_on_a_logarithmic_axis() {
    let plan = plan("").expect("it makes sense");
    let runs = vec![vec![run(&[(10, -8.0), (20, -0.5), (30, 0.0)])]];
    let drawn = analysis::convergence(&plan, &runs);
    assert!(drawn.is_logarithmic && drawn.y.starts_with("error (m)"), "{}", drawn.y);
    let points = &drawn.curves[0].points;
    assert_eq!(points[0], chart::Point { x: 10.0, low: 8.0, middle: 8.0, high: 8.0 });
    // Nothing has no place there: it is drawn at the smallest error.
    assert_eq!(points.last().unwrap().middle, 0.5);
    assert!(!drawn.to_svg().contains("NaN"));
}

#[test]
fn a_setting_that_never_scores_has_no_curve_and_no_numbers() {
    let plan = plan("").expect("it makes sense");
    let runs = vec![vec![run(&[(10, f64::NEG_INFINITY)]), run(&[(10, 1.0)])]];
    assert_eq!(analysis::convergence(&plan, &runs).curves[0].points, []);
    let csv = String::from_utf8(tables::runs_csv(&plan, &runs)).expect("it is text");
    assert_eq!(
        csv,
        "setting,seed,final_generation,evaluations,best,validated,apart,success,evaluations_to_target,digest,seconds\n\
         base,1,0,10,,,,,,d1ce,0.250\nbase,1,0,10,1,,,,,d1ce,0.250\n"
    );
}
