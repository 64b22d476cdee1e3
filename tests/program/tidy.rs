//! The house keeps its order: who may import whom, who alone knows a heavy dependency, and what lies where.

use crate::support::imports::{root, sources};
use std::fs;
use std::process::Command;

/// The floor of each module: it imports only from lower ones.
const FLOORS: [(&str, u8); 18] = [
    ("choice", 0),
    ("rng", 0),
    ("statistics", 0),
    ("work_queue", 0),
    ("evolution", 1),
    ("networks", 1),
    ("creature", 2),
    ("archipelago", 2),
    ("simulation", 3),
    ("problems", 4),
    ("transport", 5),
    ("store", 5),
    ("formats", 5),
    ("view", 5),
    ("runs", 6),
    ("app", 7),
    // The front door and the guide name every module to their readers and import from any.
    ("guide", 8),
    ("lib", 8),
];

/// Each heavy dependency, and the only module that imports it.
const SOLE_IMPORTERS: [(&str, &str); 6] = [
    ("rapier3d", "simulation"),
    ("iceoryx2", "transport"),
    ("bincode", "store"),
    ("rerun", "view"),
    ("plotters", "formats"),
    ("clap", "app"),
];

const FILE_LINES_MAX: usize = 400;

const TOP_LEVEL: [&str; 8] =
    ["Cargo.toml", "Cargo.lock", "README.md", "LICENSE", "src", "bins", "tests", "benches"];

#[test]
fn a_module_imports_only_from_lower_floors() {
    let mut wrong = Vec::new();
    for file in sources(&["src"]) {
        let module = file.module();
        let own = floor(&module).unwrap_or_else(|| panic!("give {module} a floor"));
        for import in file.imported_modules() {
            if import != module && floor(&import).is_some_and(|other| other >= own) {
                wrong.push(format!("{} imports {import}", file.path.display()));
            }
        }
    }
    assert_eq!(wrong, Vec::<String>::new());
}

#[test]
fn bodies_and_brains_know_no_evolution() {
    for file in sources(&["src/creature/body", "src/creature/brain"]) {
        let imports = file.imported_modules();
        assert!(!imports.iter().any(|module| module == "evolution"), "{}", file.path.display());
    }
}

#[test]
fn a_heavy_dependency_has_a_single_importer() {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    for (dependency, importer) in SOLE_IMPORTERS {
        assert!(manifest.contains(&format!("\n{dependency} = ")), "{dependency} is used no more");
        for file in sources(&["src", "bins"]) {
            let imports = file.paths().iter().any(|path| path[0] == dependency);
            assert!(
                !imports || file.module() == importer,
                "{} imports {dependency}, which {importer} alone does",
                file.path.display()
            );
        }
    }
}

#[test]
fn no_file_is_longer_than_400_lines() {
    for file in sources(&["src", "bins", "tests", "benches"]) {
        let lines = file.text.lines().count();
        assert!(lines <= FILE_LINES_MAX, "{} has {lines} lines", file.path.display());
    }
}

#[test]
fn the_top_level_of_the_repository_is_the_package_and_nothing_else() {
    // A package that was downloaded is no repository.
    if !root().join(".git").exists() {
        return;
    }
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output().unwrap();
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    for path in String::from_utf8(listed.stdout).unwrap().split_terminator('\0') {
        let top = path.split('/').next().unwrap();
        assert!(top.starts_with('.') || TOP_LEVEL.contains(&top), "{path} is out of place");
    }
}

fn floor(module: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}
