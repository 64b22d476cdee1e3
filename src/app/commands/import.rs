//! `islands import`: takes in genomes of the course, whatever state their files are in.

use crate::app::args::cli::ImportArgs;
use crate::app::console::{print, say};
use crate::app::genomes;
use crate::app::table::harmless;
use crate::creature::encodings::course::profile::COURSEWORK_LINKS_MAX;
use crate::creature::{Course, Encoding, Gene, Profile, Scales};
use crate::formats::genome_csv;
use crate::runs::{Failure, genome_files, seeds};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// What came of all files.
#[derive(Serialize)]
struct Report {
    read: usize,
    refused: Vec<Refused>,
    /// Files of which values were clamped.
    clamped: Vec<Clamped>,
    out: Option<PathBuf>,
}

#[derive(Serialize)]
struct Refused {
    file: PathBuf,
    reason: String,
}

#[derive(Serialize)]
struct Clamped {
    file: PathBuf,
    values: usize,
}

/// Reads every file that is named, and writes those that can be read anew.
///
/// # Errors
/// With exit code 1 if some were refused, with 2 if nothing can be done.
pub fn run(args: &ImportArgs) -> Result<(), Failure> {
    let encoding = Course {
        profile: args.profile,
        scales: args.changes.scales(),
        links_max: COURSEWORK_LINKS_MAX,
        ..Course::DEFAULT
    };
    let checked = encoding.scales.check(encoding.profile);
    checked.map_err(|error| Failure::usage(error.to_string()))?;
    let dropped = genome_files::dropped(&args.changes.drop_columns, encoding.columns().len())?;
    let files = seeds::gather(&args.files)?;
    args.out.as_deref().map(make_folder).transpose()?;
    let outs = names(&files, args.out.as_deref());
    let results: Vec<Result<usize, String>> = files
        .par_iter()
        .zip(&outs)
        .map(|(file, out)| take_in(file, out.as_deref(), &encoding, dropped))
        .collect();
    let report = report(files, results, args.out.clone());
    show(&report);
    if args.json {
        print(&serde_json::to_string(&report).expect("a report is plain data"));
    }
    match (report.read, report.refused.len()) {
        (_, 0) => Ok(()),
        (0, _) => Err(Failure::usage("none of the files could be read")),
        (_, some) => Err(Failure::failed(format!("{some} of the files could not be read"))),
    }
}

/// Reads one file, and writes what it holds; returns how many of its values were clamped.
fn take_in(
    file: &Path,
    out: Option<&Path>,
    encoding: &Course,
    dropped: &[usize],
) -> Result<usize, String> {
    let read = genomes::read_quietly(encoding, file, dropped)?;
    let genome = in_own_scales(&read.genome, encoding)?;
    let own = Course { scales: Scales::NONE, ..*encoding };
    own.count_links(&genome).map_err(|error| error.to_string())?;
    let Some(out) = out else { return Ok(read.clamped.len()) };
    let write = || {
        let mut file = BufWriter::new(File::create(out)?);
        genome_csv::write(&genome, &mut file)?;
        file.flush()
    };
    write().map_err(|error| format!("cannot write {}: {error}", out.display()))?;
    Ok(read.clamped.len())
}

/// A genome in the scales that its profile has by itself.
fn in_own_scales(genome: &[Gene], encoding: &Course) -> Result<Vec<Gene>, String> {
    if encoding.profile != Profile::Coursework {
        return Ok(genome.to_vec());
    }
    encoding.exported(genome).map_err(|error| {
        format!("{error}; leave it as it is, and give --scale to the command that uses it")
    })
}

fn make_folder(folder: &Path) -> Result<(), Failure> {
    let unusable = |reason: String| {
        let folder = folder.display();
        Failure::usage(format!("cannot use {folder}: {reason}; choose another folder with --out"))
    };
    std::fs::create_dir_all(folder).map_err(|error| unusable(error.to_string()))?;
    let mut entries = std::fs::read_dir(folder).map_err(|error| unusable(error.to_string()))?;
    match entries.next() {
        None => Ok(()),
        Some(_) => Err(unusable("it is not empty".to_owned())),
    }
}

/// What each file is called in the folder: its own name, or with a number if that is taken.
fn names(files: &[PathBuf], folder: Option<&Path>) -> Vec<Option<PathBuf>> {
    let mut taken = BTreeSet::new();
    // The last number that a name was given: there may be a million of one name.
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let name = |file: &PathBuf| {
        let folder = folder?;
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let number = numbers.entry(stem.clone()).or_default();
        let mut names = std::iter::repeat_with(|| {
            *number += 1;
            if *number == 1 { format!("{stem}.csv") } else { format!("{stem}-{number}.csv") }
        });
        let free = names.find(|name| taken.insert(name.clone()));
        Some(folder.join(free.expect("there is always a next number")))
    };
    files.iter().map(name).collect()
}

fn report(
    files: Vec<PathBuf>,
    results: Vec<Result<usize, String>>,
    out: Option<PathBuf>,
) -> Report {
    let mut report = Report { read: 0, refused: Vec::new(), clamped: Vec::new(), out };
    for (file, result) in files.into_iter().zip(results) {
        match result {
            Err(reason) => report.refused.push(Refused { file, reason }),
            Ok(values) => {
                report.read += 1;
                if values > 0 {
                    report.clamped.push(Clamped { file, values });
                }
            }
        }
    }
    report
}

fn show(report: &Report) {
    for Clamped { file, values } in &report.clamped {
        say(&format!(
            "warning: {}: {values} value(s) of 1 and more are now just under 1",
            file.display()
        ));
    }
    for Refused { file, reason } in &report.refused {
        say(&format!("refused: {}: {}", file.display(), harmless(reason)));
    }
    let whereto = report.out.as_ref().map(|out| format!(", and wrote them to {}", out.display()));
    print(&format!(
        "read {} of {} genomes{}",
        report.read,
        report.read + report.refused.len(),
        whereto.unwrap_or_default()
    ));
}
