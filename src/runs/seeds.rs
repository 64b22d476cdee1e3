//! Genomes that a run begins with, and the copy of them that it keeps.
//!
//! The result of a run depends on them, so its configuration holds their digest, and its folder what they are. They
//! are dealt out by [`Founders`].

use super::config::{Config, POPULATION_MAX, SeedGenomes};
use super::failure::Failure;
use super::genome_files;
use super::subject::Subject;
use crate::archipelago::Algorithm;
use crate::evolution::Founders;
use crate::store::{RunDir, file};
use std::path::{Path, PathBuf};

/// The largest copy, in bytes.
const BYTES_MAX: usize = 256 << 20;
/// The most files.
const FILES_MAX: usize = 1_000_000;
/// How deep folders are searched.
const DEPTH_MAX: usize = 16;

/// What stands in the copy of some genomes, and what a configuration says of it.
fn copy<P: Subject>(problem: &P, genomes: &[Vec<P::Gene>]) -> (Vec<u8>, SeedGenomes) {
    let mut copy = Vec::new();
    for genome in genomes {
        problem.write_genome(genome, &mut copy).expect("memory takes everything");
        copy.push(b'\n');
    }
    let said = SeedGenomes { count: genomes.len(), digest: blake3::hash(&copy).to_string() };
    (copy, said)
}

/// Finds the genomes that a run is to begin with, and sets in its configuration what it has to say of them: those
/// that are named or, if none are, those of the run whose configuration was read.
///
/// # Errors
/// If they cannot be read, or are longer than the run allows.
pub fn find<P: Subject>(
    problem: &P,
    config: &mut Config,
    named: &[PathBuf],
    dropped: &[usize],
    read_from: Option<&Path>,
) -> Result<Vec<Vec<P::Gene>>, Failure> {
    let found = match (&config.seed_genomes, read_from) {
        _ if !named.is_empty() => {
            read(problem, named, genome_files::dropped(dropped, problem.columns())?)?
        }
        (Some(said), Some(file)) => load(problem, &RunDir::at(file.with_file_name("")), said)?,
        (Some(_), None) | (None, _) => Vec::new(),
    };
    if let Some(long) = found.iter().map(Vec::len).find(|&genes| genes > config.max_genes) {
        return Err(Failure::usage(format!(
            "a genome to begin with has {long} genes, more than --max-genes {}: allow more",
            config.max_genes
        )));
    }
    if config.algorithm == Algorithm::CmaEs && !found.is_empty() {
        return Err(Failure::usage(
            "cma-es begins with random genomes, which all have as many genes: leave out --seed-genomes",
        ));
    }
    let used = found.len().min(config.islands as usize * config.population.min(POPULATION_MAX));
    let found = found[..used].to_vec();
    config.seed_genomes = (!found.is_empty()).then(|| copy(problem, &found).1);
    Ok(found)
}

/// Writes the copy into the folder of a run that begins with some.
///
/// # Errors
/// If the disk is full or gone.
pub fn keep<P: Subject>(
    problem: &P,
    dir: &RunDir,
    genomes: &[Vec<P::Gene>],
) -> Result<(), Failure> {
    if genomes.is_empty() {
        return Ok(());
    }
    let (copy, _) = self::copy(problem, genomes);
    Ok(dir.write(&dir.seed_genomes(), |out| out.write_all(&copy))?)
}

/// Whom a run begins with.
///
/// # Errors
/// If the copy is not there, or not what the configuration says.
pub fn of_run<P: Subject>(
    dir: &RunDir,
    config: &Config,
    problem: &P,
) -> Result<Founders<P::Gene>, Failure> {
    let said = config.seed_genomes.as_ref();
    let genomes = said.map(|said| load(problem, dir, said)).transpose()?;
    Ok(genomes.map_or(Founders::NONE, Founders))
}

/// Reads the copy in a run's folder.
///
/// # Errors
/// If it is not there, or not what the configuration says.
pub fn load<P: Subject>(
    problem: &P,
    dir: &RunDir,
    said: &SeedGenomes,
) -> Result<Vec<Vec<P::Gene>>, Failure> {
    let path = dir.seed_genomes();
    let wrong = |reason: &dyn std::fmt::Display| {
        let path = path.display();
        Failure::usage(format!(
            "cannot use {path}: {reason}; the run begins with the genomes in it"
        ))
    };
    let text = file::read_text(&path, BYTES_MAX).map_err(|error| wrong(&error.reason()))?;
    if blake3::hash(text.as_bytes()).to_string() != said.digest {
        return Err(wrong(&"it is not what run.toml says of it"));
    }
    let genomes = text.split("\n\n").filter(|genome| !genome.trim().is_empty());
    let genomes = genomes.map(|genome| problem.read_genome(genome.as_bytes(), &[]));
    let genomes: Vec<_> = genomes.collect::<Result<_, _>>().map_err(|error| wrong(&error))?;
    match genomes.len() == said.count {
        true => Ok(genomes),
        false => Err(wrong(&"it holds another number of genomes than run.toml says")),
    }
}

fn read<P: Subject>(
    problem: &P,
    named: &[PathBuf],
    dropped: &[usize],
) -> Result<Vec<Vec<P::Gene>>, Failure> {
    let files = gather(named)?;
    let read = |path: &PathBuf| {
        genome_files::read_for(problem, path, dropped).map_err(|reason| {
            let path = path.display();
            let advice = match P::HAS_BODIES {
                true => " (islands import sorts out what can be read)",
                false => "",
            };
            Failure::usage(format!("cannot begin with {path}: {reason}{advice}"))
        })
    };
    files.iter().map(read).collect()
}

/// The files that are meant: a folder means every CSV below it, and a name with * or ? every file that fits. In the
/// order in which they are named, those of a folder in the order of their names.
///
/// # Errors
/// If there are none.
pub fn gather(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in named {
        let before = files.len();
        if path.is_dir() {
            below(path, DEPTH_MAX, &mut files)?;
        } else if path.exists() || !is_pattern(path) {
            files.push(path.clone());
        } else {
            fitting(path, &mut files)?;
        }
        if files.len() == before {
            return Err(Failure::usage(format!("there is no CSV file in {}", path.display())));
        }
        if files.len() > FILES_MAX {
            return Err(Failure::usage(format!("there are more than {FILES_MAX} files")));
        }
    }
    Ok(files)
}

fn below(folder: &Path, depth: usize, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for path in entries(folder)? {
        let is_csv = path.extension().is_some_and(|it| it.eq_ignore_ascii_case("csv"));
        // A folder that is a link may lead back here.
        if path.is_dir() && !path.is_symlink() && depth > 0 {
            below(&path, depth - 1, files)?;
        } else if is_csv && path.is_file() {
            files.push(path);
        }
    }
    Ok(())
}

fn fitting(pattern: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let folder = pattern.parent().filter(|folder| !folder.as_os_str().is_empty());
    let name = name(pattern);
    let fits =
        |path: &PathBuf| path.is_file() && fits(name.as_bytes(), self::name(path).as_bytes());
    let entries = entries(folder.unwrap_or(Path::new(".")))?.into_iter().filter(fits);
    // A pattern without a folder names files without one.
    files.extend(entries.map(|path| match folder {
        None => PathBuf::from(self::name(&path)),
        Some(_) => path,
    }));
    Ok(())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let read = || -> std::io::Result<Vec<PathBuf>> {
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
    };
    let mut entries = read().map_err(|error| {
        Failure::usage(format!("cannot look into {}: {error}", folder.display()))
    })?;
    entries.sort();
    Ok(entries)
}

fn is_pattern(path: &Path) -> bool {
    name(path).contains(['*', '?'])
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a name fits a pattern, in which ? is any character and * any number of them.
fn fits(pattern: &[u8], name: &[u8]) -> bool {
    // Where the last star was, and where the name goes on if it takes one character more.
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        match pattern.get(p) {
            Some(b'*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&one) if one == b'?' || one == name[n] => (p, n) = (p + 1, n + 1),
            _ => {
                let Some((at, taken)) = star else { return false };
                star = Some((at, taken + 1));
                (p, n) = (at + 1, taken + 1);
            }
        }
    }
    pattern[p..].iter().all(|&rest| rest == b'*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_is_any_text_and_a_question_mark_one_character() {
        let all =
            [("*.csv", "a.csv"), ("*", ""), ("a?c", "abc"), ("*a*b*", "xxaxxbxx"), ("a*a", "aaa")];
        assert!(all.iter().all(|(pattern, name)| fits(pattern.as_bytes(), name.as_bytes())));
        let none = [("*.csv", "a.csv2"), ("a?c", "ac"), ("", "a"), ("*a*b", "ba"), ("a", "ab")];
        assert!(!none.iter().any(|(pattern, name)| fits(pattern.as_bytes(), name.as_bytes())));
    }
}
