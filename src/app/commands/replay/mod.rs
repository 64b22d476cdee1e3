//! `islands replay`: films genomes and bodies, or a run's champions or their ancestors.

use crate::app::args::cli::ReplayArgs;
use crate::runs::Failure;

#[cfg(feature = "view")]
mod film;
#[cfg(feature = "view")]
mod line;
#[cfg(feature = "view")]
mod race;

/// Films the creatures in the files that are named, genomes or bodies, side by side, or the creatures of a run, one
/// after another.
///
/// # Errors
/// If one cannot be read or expressed, or the recording cannot be written.
#[cfg(feature = "view")]
pub fn run(args: &ReplayArgs) -> Result<(), Failure> {
    use crate::app::args::cli::Watching;
    use crate::app::console::print;

    if let Some(seconds) = args.seconds
        && !(0.1..=3_600.0).contains(&seconds)
    {
        let wrong = format!("seconds must be from 0.1 to 3600, not {seconds}");
        return Err(Failure::usage(wrong));
    }
    let out = match &args.what[..] {
        [dir] if dir.is_dir() && !args.changes.drop_columns.is_empty() => {
            let wrong = "--drop-column is for files of genomes, and this is a run: leave it out";
            return Err(Failure::usage(wrong));
        }
        [dir] if dir.is_dir() => line::film(args, dir)?,
        genomes if genomes.iter().any(|path| path.is_dir()) => {
            return Err(Failure::usage(
                "replay takes the folder of one run, or files of genomes: name either",
            ));
        }
        _ if args.ancestry => {
            let wrong = "a genome alone has no ancestors: name the folder of its run";
            return Err(Failure::usage(wrong));
        }
        genomes => race::film(args, genomes)?,
    };
    print(&format!("view it:  rerun {}", out.display()));
    if args.view == Watching::Spawn {
        // A viewer that cannot be opened has been said.
        let _ = crate::app::viewer::open(out.display().to_string()).join();
    }
    Ok(())
}

/// Says that this program cannot.
///
/// # Errors
/// Always.
#[cfg(not(feature = "view"))]
pub fn run(_: &ReplayArgs) -> Result<(), Failure> {
    Err(Failure::usage("this program was built without the feature “view”, and cannot film"))
}
