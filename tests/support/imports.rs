//! What Rust files import.

use std::fs;
use std::path::{Path, PathBuf};

/// A Rust file of the repository.
pub struct Source {
    /// Its path from the root of the repository.
    pub path: PathBuf,
    /// What is in it.
    pub text: String,
}

impl Source {
    /// The top-level module that it belongs to.
    pub fn module(&self) -> String {
        let part = self.path.iter().nth(1).unwrap();
        Path::new(part).file_stem().unwrap().to_string_lossy().into_owned()
    }

    /// Every path in it.
    pub fn paths(&self) -> Vec<Vec<String>> {
        paths(&self.text)
    }

    /// The modules that its paths lead to. One that starts with `super` may stay within the module, at a file
    /// that is called like another module.
    pub fn imported_modules(&self) -> Vec<String> {
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

/// The root of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file below some folders.
pub fn sources(folders: &[&str]) -> Vec<Source> {
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

/// A path in a Rust file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// Its parts.
    pub path: Vec<String>,
    /// Whether it only shows others the way: `pub use`.
    pub is_signpost: bool,
}

/// Every path of two parts or more in a Rust file, and all that is used, its groups taken apart; a star is left out.
pub fn imports(text: &str) -> Vec<Import> {
    let tokens = tokens(text);
    let mut imports = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let mut paths = Vec::new();
        // A signpost begins with `pub` or `pub(…)`.
        let is_signpost =
            tokens[at] == "use" && at > 0 && matches!(tokens[at - 1].as_str(), "pub" | ")");
        if tokens[at] == "use" {
            at = read_used(&tokens, at + 1, &[], &mut paths);
        } else {
            let (path, end) = read_path(&tokens, at);
            if path.len() > 1 {
                paths.push(path);
            }
            at = end.max(at + 1);
        }
        imports.extend(paths.into_iter().map(|path| Import { path, is_signpost }));
    }
    imports
}

/// Every path of [`imports`].
fn paths(text: &str) -> Vec<Vec<String>> {
    imports(text).into_iter().map(|import| import.path).collect()
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
    expect_test::expect![[r#"
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
