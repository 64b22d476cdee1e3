//! README is short, and what it says to type works; its links and those of the guide lead somewhere.

use crate::formats::course::fixture;
use crate::support::World;
use std::fs;
use std::path::Path;

const README: &str = include_str!("../../README.md");
const LINES_MAX: usize = 150;
const GUIDE: &str = "src/guide";

/// What a command of ours begins with.
const OURS: [&str; 2] = ["islands ", "cargo run --release -- "];
/// Commands that need the view.
const FILMING: [&str; 2] = ["replay ", "monitor "];

/// Settings with which a run of any problem, and one of creatures, takes a moment.
const SHORT: [&str; 2] = ["--generations 2", "--view off"];
const SHORT_OF_CREATURES: [&str; 2] = ["--population 4", "--robustness 0"];

#[test]
fn the_readme_has_at_most_150_lines() {
    let lines = README.lines().count();
    assert!(lines <= LINES_MAX, "README.md has {lines} lines");
}

#[test]
fn every_command_of_the_readme_works_in_its_order() {
    let world = World::new();
    write_what_is_taken_for_granted(&world);
    let commands = commands();
    assert!(!commands.is_empty());
    for command in commands.iter().filter(|command| can_be_run(command)) {
        let ending = world.islands(&shortened(command));
        assert_eq!(ending.code, Some(0), "islands {command}: {ending:?}");
    }
    world.assert_left_nothing();
}

#[test]
fn commands_are_shortened_and_keep_what_else_they_say() {
    for (command, short) in [
        (
            "--n 4 --generations 20 --seed 7",
            "--n 4 --seed 7 --generations 2 --view off --population 4 --robustness 0",
        ),
        (
            "run --problem sphere --dimensions 9",
            "run --problem sphere --dimensions 9 --generations 2 --view off",
        ),
        ("resume a --generations 200", "resume a --generations 4"),
        ("resume a", "resume a"),
        ("evaluate a.csv --trials 100 --json", "evaluate a.csv --json --trials 2"),
        ("verify a", "verify a"),
    ] {
        assert_eq!(shortened(command), short);
    }
}

#[test]
fn every_link_of_the_readme_and_of_the_guide_leads_to_a_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let targets = README.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    for target in targets.filter(|target| !target.starts_with("https://")) {
        assert!(root.join(target).exists(), "README.md links to {target}");
    }
    // Where the definitions of a page lead in the documentation, another file says.
    let guide = root.join(GUIDE);
    let in_documentation = fs::read_to_string(guide.join("links.md")).unwrap();
    let pages = fs::read_dir(&guide).unwrap().map(|entry| entry.unwrap().path());
    for page in pages.filter(|path| path.extension().is_some_and(|it| it == "md")) {
        let text = fs::read_to_string(&page).unwrap();
        for (name, target) in text.lines().filter_map(definition) {
            let leads = guide.join(target).exists() || target.starts_with("crate::");
            assert!(leads, "{} links to {target}", page.display());
            let is_there = in_documentation.lines().filter_map(definition).any(|it| it.0 == name);
            assert!(is_there, "links.md does not say where [{name}] leads");
        }
    }
}

/// README's commands without what they begin with and without comments.
fn commands() -> Vec<String> {
    let blocks = blocks("sh");
    let lines = blocks.iter().flat_map(|block| block.lines());
    let ours = |line: &str| {
        let code = line.split(" #").next().unwrap().trim_end();
        OURS.iter().find_map(|start| code.strip_prefix(*start)).map(str::to_owned)
    };
    let commands: Vec<String> = lines.filter_map(ours).collect();
    for command in &commands {
        let needs_shell = command.contains(['|', '&', ';', '>', '*', '\'', '"', '$']);
        assert!(!needs_shell, "no shell reads this: {command}");
    }
    commands
}

fn can_be_run(command: &str) -> bool {
    cfg!(feature = "view") || !FILMING.iter().any(|verb| command.starts_with(verb))
}

/// The same command, but so that it takes a moment. One that is not known to take long stays as it is.
fn shortened(command: &str) -> String {
    let first = command.split(' ').next().unwrap();
    let verb = if first.starts_with('-') { "run" } else { first };
    let short = SHORT.into_iter();
    match verb {
        "run" if command.contains("--problem ") => short.fold(command.to_owned(), with),
        "run" => short.chain(SHORT_OF_CREATURES).fold(command.to_owned(), with),
        "resume" if command.contains("--generations ") => {
            with(command.to_owned(), "--generations 4")
        }
        "evaluate" if command.contains("--trials ") => with(command.to_owned(), "--trials 2"),
        _ => command.to_owned(),
    }
}

/// The command with a setting, instead of the one of the same name that it may have.
fn with(command: String, setting: &str) -> String {
    let flag = setting.split([' ', '=']).next().unwrap();
    let mut words = command.split_whitespace();
    let mut kept = Vec::new();
    while let Some(word) = words.next() {
        if word == flag {
            // Its value goes, too.
            words.next();
        } else {
            kept.push(word);
        }
    }
    kept.push(setting);
    kept.join(" ")
}

/// Writes what README's commands read: the experiment that README shows, and genomes of the course.
fn write_what_is_taken_for_granted(world: &World) {
    for block in blocks("toml") {
        let name = block.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap();
        world.write(name, block.lines().map(shortened_line).collect::<String>());
    }
    fs::create_dir(world.path("elites")).unwrap();
    world.write("elites/elite_1.csv", fixture("genome_1.csv"));
}

/// A line of an experiment, changed where it decides how long the experiment takes.
fn shortened_line(line: &str) -> String {
    let line = match line.split_whitespace().next() {
        Some("seeds") => "seeds = 2",
        Some("evaluations") => "evaluations = 16",
        Some("[base]") => "[base]\npopulation = 4\nrobustness = 0",
        _ => line,
    };
    format!("{line}\n")
}

/// What stands in README's blocks of a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let opening = format!("```{language}\n");
    README.split(&opening).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

/// The name and the target of a line that defines a link.
fn definition(line: &str) -> Option<(&str, &str)> {
    line.strip_prefix('[')?.split_once("]: ")
}
