//! `islands export`: a creature for other programs.

use crate::app::args::cli::{ExportArgs, Format};
use crate::app::console::print;
use crate::app::genomes::Specimen;
use crate::creature::{Creature, Encoding};
use crate::formats::{genome_csv, mjcf, motion, stl, urdf};
use crate::problems::Locomotion;
use crate::runs::Failure;
use crate::runs::subject::Subject;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Printers think in millimetres.
const MILLIMETRES_PER_M: f64 = 1000.0;
/// Nobody prints larger or smaller than this, times the own size.
const SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Writes a creature in the format that is asked for.
///
/// # Errors
/// If it cannot be read, said in that format, or written.
pub fn run(args: &ExportArgs) -> Result<(), Failure> {
    export(args, &args.trial.config()?.locomotion())
}

fn export<E: Encoding>(args: &ExportArgs, problem: &Locomotion<E>) -> Result<(), Failure> {
    if !SIZES.contains(&args.size) {
        return Err(Failure::usage("--size must be from 0.000001 to 1000000"));
    }
    if args.format == Format::Mjcf && problem.trial().ground.terrain().is_some() {
        return Err(Failure::usage(
            "--format mjcf writes a plane to stand on: leave out --task climb and --terrain; of the formats only motion \
             knows the terrain",
        ));
    }
    let encoding = &problem.encoding;
    let specimen = Specimen::read(&args.genome, encoding, &args.trial.changes)?;
    if args.format == Format::Csv {
        return export_genome(args, encoding, &specimen);
    }
    let creature = specimen.creature(&args.genome, encoding)?;
    let name = name(&args.genome);
    let Creature { morphology, controller } = &creature;
    let out = &args.out;
    match args.format {
        Format::Csv => Ok(()),
        Format::Urdf => write(out, |file| urdf::write(morphology, controller, &name, file)),
        Format::Mjcf => write(out, |file| mjcf::write(&creature, &name, file)),
        Format::Stl => export_stl(args, &creature),
        Format::Motion => {
            let (evaluation, film) = problem.film_body(&creature);
            print(&format!("{}  {}", problem.show(evaluation.fitness), evaluation.outcome));
            write(out, |file| motion::write(&film, file))
        }
    }
}

fn export_genome<E: Encoding>(
    args: &ExportArgs,
    encoding: &E,
    specimen: &Specimen<E::Gene>,
) -> Result<(), Failure> {
    let path = args.genome.display();
    let Specimen::Genome(genome) = specimen else {
        return Err(Failure::usage(format!("{path} is a body and has no genome to write")));
    };
    let said = encoding.exported(genome);
    let said = said.map_err(|error| Failure::usage(format!("cannot export {path}: {error}")))?;
    write(&args.out, |file| genome_csv::write(&said, file))
}

fn export_stl(args: &ExportArgs, creature: &Creature) -> Result<(), Failure> {
    let units_per_m = args.size * MILLIMETRES_PER_M;
    write(&args.out, |file| stl::write(&creature.morphology, units_per_m, file))?;
    if !args.parts {
        return Ok(());
    }
    let stem = name(&args.out);
    for (index, link) in creature.morphology.links.iter().enumerate() {
        let part = args.out.with_file_name(format!("{stem}-link_{index}.stl"));
        write(&part, |file| stl::write_link(&link.shape, units_per_m, file))?;
    }
    Ok(())
}

/// A file's name without what says its format.
fn name(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    let create = || File::create(path).map(BufWriter::new);
    let mut file = create().map_err(|error| {
        let path = path.display();
        Failure::usage(format!("cannot write {path}: {error}; choose another file with --out"))
    })?;
    fill(&mut file)
        .and_then(|()| file.flush())
        .map_err(|error| Failure::failed(format!("cannot write {}: {error}", path.display())))
}
