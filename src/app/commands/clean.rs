//! `islands clean`: removes what crashed runs left in shared memory and in the folder for temporary files.

use crate::app::args::cli::CleanArgs;
use crate::app::console::print;
use crate::app::table;
use crate::runs::Failure;
use crate::transport::{Domain, Remains, Removal, TransportError};

/// Lists what dead launchers of this user left, and removes it. Runs that are under way, and whatever is
/// another user's, are neither listed nor touched; the runs' own folders are not either: they can be resumed.
///
/// # Errors
/// If something cannot be removed.
pub fn run(args: &CleanArgs) -> Result<(), Failure> {
    let remains = Domain::abandoned();
    if remains.is_empty() {
        print("nothing is left of any crashed run");
        return Ok(());
    }
    let mut rows = vec![["run", "objects", "kB", "folder", "result"].map(str::to_owned)];
    let mut stubborn = 0;
    for remains in remains {
        let [id, objects, size, folder] = describe(&remains);
        let result = match args.dry_run {
            true => "it would be removed".to_owned(),
            false => remove(remains).unwrap_or_else(|error| {
                stubborn += 1;
                error.to_string()
            }),
        };
        rows.push([id, objects, size, folder, result]);
    }
    print(&table::lay_out(&rows));
    match stubborn {
        0 => Ok(()),
        count => Err(Failure::failed(format!("{count} of these could not be removed"))),
    }
}

fn describe(remains: &Remains) -> [String; 4] {
    let folder = remains.folder.as_ref();
    [
        Domain::new(remains.run_id).to_string(),
        remains.objects.to_string(),
        remains.bytes.div_ceil(1_000).to_string(),
        folder.map_or_else(|| "none".to_owned(), |folder| folder.display().to_string()),
    ]
}

fn remove(remains: Remains) -> Result<String, TransportError> {
    let result = match remains.remove()? {
        Removal::Done => "removed",
        Removal::Held => "left alone: it is under way again, or somebody else removes it",
        Removal::Gone => "gone already",
    };
    Ok(result.to_owned())
}
