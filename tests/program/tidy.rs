//! The house keeps its order: who may import whom, who alone knows a heavy dependency, and what lies where.

use expect_test::expect;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The floor of each module: it imports only from lower ones.
const FLOORS: [(&str, u8); 17] = [
    ("choice", 0),
    ("rng", 0),
    ("statistics", 0),
    ("work_queue", 0),
    ("evolution", 1),
    ("creature", 1),
    ("archipelago", 2),
    ("simulation", 2),
    ("problems", 3),
    ("transport", 4),
    ("store", 4),
    ("formats", 4),
    ("view", 4),
    ("runs", 5),
    ("app", 6),
    // The front door and the guide name every module to their readers and import from any.
    ("guide", 7),
    ("lib", 7),
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
fn evolution_and_creature_do_not_know_each_other() {
    for file in sources(&["src/evolution", "src/creature"]) {
        let other = if file.module() == "creature" { "evolution" } else { "creature" };
        assert!(!file.imported_modules().iter().any(|m| m == other), "{}", file.path.display());
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

#[test]
fn the_reader_of_imports_finds_groups_and_paths_and_skips_comments_and_text() {
    let text = r##"
        //! See [`crate::app`].
        use crate::{self, rng::Stream, creature::{Gene as G, gene::{self, *}}, problems};
        pub(crate) use super::super::store as s;
        use clap;
        fn f() -> crate::view::Clip { g::<rerun::Color>("bincode::\"::") } // crate::transport
        const QUOTES: [char; 3] = ['"', '\'', '\\']; /* crate::transport */
        const RAW: &str = r#"a "bincode::"#;
        #[derive(::serde::Serialize)]
        struct S<'a>(&'a str, x::Y);
    "##;
    let found: Vec<String> = paths(text).iter().map(|path| path.join("::")).collect();
    expect![[r#"
        crate::self
        crate::rng::Stream
        crate::creature::Gene
        crate::creature::gene::self
        crate::creature::gene
        crate::problems
        super::super::store
        clap
        crate::view::Clip
        rerun::Color
        serde::Serialize
        x::Y"#]]
    .assert_eq(&found.join("\n"));
}

struct Source {
    /// Its path from the root of the repository.
    path: PathBuf,
    text: String,
}

impl Source {
    /// The top-level module that it belongs to.
    fn module(&self) -> String {
        let part = self.path.iter().nth(1).unwrap();
        Path::new(part).file_stem().unwrap().to_string_lossy().into_owned()
    }

    fn paths(&self) -> Vec<Vec<String>> {
        paths(&self.text)
    }

    /// The modules that its paths lead to. One that starts with `super` may stay within the module, at a file
    /// that is called like another module.
    fn imported_modules(&self) -> Vec<String> {
        let home = root().join("src").join(self.module());
        let stays =
            |name: &str| home.join(name).is_dir() || home.join(name).with_extension("rs").is_file();
        let lead = |path: Vec<String>| -> Option<String> {
            let name = path.iter().find(|part| *part != "super" && *part != "crate")?;
            match path[0].as_str() {
                "crate" => Some(name.clone()),
                "super" if !stays(name) => Some(name.clone()),
                _ => None,
            }
        };
        self.paths().into_iter().filter_map(lead).collect()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn floor(module: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

/// Every Rust file below some folders.
fn sources(folders: &[&str]) -> Vec<Source> {
    let mut files = Vec::new();
    let mut left: Vec<PathBuf> = folders.iter().map(|folder| root().join(folder)).collect();
    while let Some(path) = left.pop() {
        if path.is_dir() {
            left.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            let path = path.strip_prefix(root()).unwrap().to_owned();
            files.push(Source { path, text });
        }
    }
    assert!(!files.is_empty(), "there is nothing in {folders:?}");
    files
}

/// Every path of two parts or more in a Rust file, and all that is used, its groups taken apart.
fn paths(text: &str) -> Vec<Vec<String>> {
    let tokens = tokens(text);
    let mut paths = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at] == "use" {
            at = read_used(&tokens, at + 1, &[], &mut paths);
        } else {
            let (path, end) = read_path(&tokens, at);
            if path.len() > 1 {
                paths.push(path);
            }
            at = end.max(at + 1);
        }
    }
    paths
}

/// Reads what is used from a token on, below a path; returns where it ends.
fn read_used(
    tokens: &[String],
    at: usize,
    above: &[String],
    paths: &mut Vec<Vec<String>>,
) -> usize {
    let (path, mut at) = read_path(tokens, at);
    let path = [above, &path].concat();
    if tokens[at] != "{" {
        paths.push(path);
        return at;
    }
    while tokens[at] != "}" {
        at = read_used(tokens, at + 1, &path, paths);
        // A star or a new name for what is used.
        while !matches!(tokens[at].as_str(), "," | "}") {
            at += 1;
        }
    }
    at + 1
}

/// The path at a token, empty if there is none, and where it ends.
fn read_path(tokens: &[String], mut at: usize) -> (Vec<String>, usize) {
    let is_name = |token: &str| token.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let mut path = Vec::new();
    while let Some(token) = tokens.get(at) {
        let may_be_name = path.is_empty() || tokens[at - 1] == "::";
        if may_be_name && is_name(token) {
            path.push(token.clone());
        } else if token != "::" {
            break;
        }
        at += 1;
    }
    (path, at)
}

/// The names and marks of a Rust file, without comments and quoted text; `::` is one mark.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match unread_length(rest) {
            Some(length) => length,
            None => {
                let ends = |c: char| !c.is_alphanumeric() && c != '_';
                let length = match rest.find(ends).unwrap_or(rest.len()) {
                    0 if rest.starts_with("::") => 2,
                    0 => first.len_utf8(),
                    name => name,
                };
                tokens.push(rest[..length].to_owned());
                length
            }
        };
        rest = &rest[length..];
    }
    tokens
}

/// The length of the space, comment, quoted text or character that something starts with, if it does.
fn unread_length(text: &str) -> Option<usize> {
    let through = |start: usize, end: &str| {
        Some(text[start..].find(end).map_or(text.len(), |at| start + at + end.len()))
    };
    let raw = text.trim_start_matches('b').strip_prefix('r').map(|raw| raw.trim_start_matches('#'));
    match text.as_bytes() {
        [b' ' | b'\n' | b'\r' | b'\t', ..] => Some(1),
        [b'/', b'/', ..] => through(0, "\n"),
        [b'/', b'*', ..] => through(2, "*/"),
        [b'"', ..] => Some(quoted_length(text)),
        [b'r' | b'b', ..] => {
            let raw = raw.filter(|raw| raw.starts_with('"'))?;
            let start = text.len() - raw.len();
            let hashes = text[..start].matches('#').count();
            through(start + 1, &format!("\"{}", "#".repeat(hashes)))
        }
        [b'\'', b'\\', ..] => through(3, "'"),
        // A quote with no end after one character begins a lifetime.
        [b'\'', ..] => {
            let (length, _) = text.char_indices().nth(2)?;
            text[length..].starts_with('\'').then_some(length + 1)
        }
        _ => None,
    }
}

fn quoted_length(text: &str) -> usize {
    let mut is_escaped = true;
    let end = text.find(|c| {
        let ends = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 1)
}
