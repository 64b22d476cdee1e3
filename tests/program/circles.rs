//! No file of a module imports, by whatever way, a file that imports it: neither among all files of a module, nor among
//! the parts of any folder.

use crate::support::imports::{Import, imports, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A path of modules from the root of the crate.
type Module = Vec<String>;

#[test]
fn no_file_imports_one_that_imports_it() {
    let sources = sources(&["src"]);
    let files: Vec<(&Path, &str)> =
        sources.iter().map(|it| (it.path.as_path(), it.text.as_str())).collect();
    let found = circles(&files);
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_circle_is_found_and_a_line_is_none() {
    let circles = |files: &[(&str, &str)]| {
        let files: Vec<_> = files.iter().map(|(path, text)| (Path::new(*path), *text)).collect();
        circles(&files)
    };
    let line = [
        ("src/a/mod.rs", "mod b; mod c; use b::B; pub use c::C;"),
        ("src/a/b.rs", "use super::c::C; use super::C as D;"),
        ("src/a/c.rs", "pub struct C; #[cfg(test)]\nmod tests { use super::super::b::B; }"),
        ("src/z.rs", "use crate::a::C;"),
    ];
    assert_eq!(circles(&line), Vec::<String>::new());
    // A file asks its parent, which asks it.
    let parent = [("src/a/mod.rs", "use b::B; pub struct A;"), ("src/a/b.rs", "use super::A;")];
    assert_eq!(circles(&parent), ["a: a, a::b"]);
    // Three files, by a group, a signpost, and a path within the code.
    let three = [
        ("src/a/mod.rs", "pub use c::*;"),
        ("src/a/b.rs", "use super::{C, d::D};"),
        ("src/a/c.rs", "pub struct C(crate::a::d::D);"),
        ("src/a/d.rs", "pub struct D; fn f() { super::b::g() }"),
    ];
    assert_eq!(circles(&three), ["a: a::b, a::c, a::d"]);
    // Two folders, of which no file is in a circle.
    let folders = [
        ("src/a/b/x.rs", "use crate::a::c::x::X;"),
        ("src/a/b/y.rs", ""),
        ("src/a/c/x.rs", ""),
        ("src/a/c/y.rs", "use crate::a::b::y::Y;"),
    ];
    assert_eq!(circles(&folders), ["a: b, c"]);
}

/// Every circle, as the module or folder that it is in and what is in it or leads from one to another.
fn circles(files: &[(&Path, &str)]) -> Vec<String> {
    let is_test = |path: &Path| path.iter().any(|part| part == "tests" || part == "tests.rs");
    let files = files.iter().filter(|(path, _)| !is_test(path));
    let house: House = files.map(|(path, text)| (module(path), File::read(text))).collect();
    let mut found = Vec::new();
    let edges: Vec<[Module; 2]> = house.keys().flat_map(|of| edges(&house, of)).collect();
    let tops: BTreeSet<&String> = house.keys().filter_map(|module| module.first()).collect();
    for top in tops {
        let own = edges.iter().filter(|[from, _]| from.first() == Some(top));
        let left = within_circles(own.map(|edge| edge.each_ref().map(|it| it.join("::"))));
        found.extend((!left.is_empty()).then(|| format!("{top}: {}", left.join(", "))));
    }
    let above = |module: &Module| (1..module.len()).map(|end| module[..end].to_vec()).collect();
    let folders: BTreeSet<Module> = house.keys().flat_map::<Vec<Module>, _>(above).collect();
    for folder in folders {
        let part = |module: &Module| module.strip_prefix(&folder[..])?.first().cloned();
        let parts = edges.iter().filter_map(|[from, to]| Some([part(from)?, part(to)?]));
        let left = within_circles(parts.filter(|[from, to]| from != to));
        let circle = format!("{}: {}", folder.join("::"), left.join(", "));
        let is_known =
            |known: &String| left.iter().all(|part| known.contains(&format!("::{part}")));
        found.extend((!left.is_empty() && !found.iter().any(is_known)).then_some(circle));
    }
    found
}

/// What is left when whoever imports nothing, or is imported by nobody, is taken away again and again.
fn within_circles(edges: impl Iterator<Item = [String; 2]>) -> Vec<String> {
    let mut edges: BTreeSet<[String; 2]> = edges.collect();
    loop {
        let [from, to] = [0, 1]
            .map(|end| edges.iter().map(|edge| edge[end].clone()).collect::<BTreeSet<String>>());
        let before = edges.len();
        edges.retain(|edge| to.contains(&edge[0]) && from.contains(&edge[1]));
        if edges.len() == before {
            return from.into_iter().collect();
        }
    }
}

type House = BTreeMap<Module, File>;

/// A file without its tests.
struct File {
    code: String,
    imports: Vec<Import>,
}

impl File {
    fn read(text: &str) -> Self {
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().to_owned();
        Self { imports: imports(&code), code }
    }

    /// Whether something is made here.
    fn defines(&self, name: &str) -> bool {
        let kinds = ["struct", "enum", "trait", "fn", "const", "static", "type", "macro_rules!"];
        let is_end = |c: char| !c.is_alphanumeric() && c != '_';
        kinds.iter().any(|kind| {
            let made = format!("{kind} {name}");
            let mut after = self.code.split(&made).skip(1);
            after.any(|rest| rest.starts_with(is_end) || rest.is_empty())
        })
    }
}

/// The path of modules that a file is.
fn module(path: &Path) -> Module {
    let path = path.strip_prefix("src").unwrap_or(path).with_extension("");
    let parts = path.iter().map(|part| part.to_string_lossy().into_owned());
    parts.filter(|part| part != "mod" && part != "lib").collect()
}

/// From a file to each that it imports from, of the same top-level module.
fn edges(house: &House, of: &Module) -> Vec<[Module; 2]> {
    let used = house[of].imports.iter().filter(|import| !import.is_signpost);
    let found = used.filter_map(|import| resolve(house, of, &import.path, 9));
    let found = found.filter(|to| to != of && to.first() == of.first() && !to.is_empty());
    found.map(|to| [of.clone(), to]).collect()
}

/// The file that a path in another one leads to, along signposts; none if it leads out of the crate.
fn resolve(house: &House, from: &Module, path: &[String], steps: usize) -> Option<Module> {
    let mut at = match path.first()?.as_str() {
        "crate" => Vec::new(),
        "self" | "super" => from.clone(),
        child if house.contains_key(&[&from[..], &[child.to_owned()]].concat()) => from.clone(),
        _ => return None,
    };
    for (index, part) in path.iter().enumerate() {
        let below = [&at[..], std::slice::from_ref(part)].concat();
        match part.as_str() {
            "crate" | "self" => {}
            "super" => drop(at.pop()),
            _ if house.keys().any(|module| module.starts_with(&below)) => at = below,
            name => {
                let beyond = house.get(&at).filter(|_| steps > 0).and_then(|file| {
                    let mut signs = file.imports.iter().filter(|import| import.is_signpost);
                    signs.find_map(|sign| beyond(house, &at, &sign.path, name, steps - 1))
                });
                let is_last = index + 1 == path.len();
                return beyond.or((is_last || !at.is_empty()).then_some(at));
            }
        }
    }
    Some(at)
}

/// Where a name lies behind a signpost, if it does.
fn beyond(house: &House, at: &Module, sign: &[String], name: &str, steps: usize) -> Option<Module> {
    let to = resolve(house, at, sign, steps)?;
    let is_named = sign.last().is_some_and(|last| last == name);
    let is_among = || to.last() == sign.last() && house.get(&to).is_some_and(|it| it.defines(name));
    (is_named || is_among()).then_some(to)
}
