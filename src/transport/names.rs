//! What everything of a run is called, by the run's id.

use std::path::{Path, PathBuf};

/// Sockets lie below the root, and the whole path of one must fit in 108 bytes; iceoryx2 itself needs 44
/// of them for its names. Longer ones fail or panic inside of it.
const ROOT_AND_PREFIX_MAX: usize = 64;

/// What the names of folders, objects and claims begin with.
const NAME: &str = "isl";
/// What follows the prefix in the name of a claim. No object of iceoryx2's is called so: theirs have an
/// ending.
const CLAIM: &str = "launcher";

/// The folder of a run that is launched here.
pub fn root(run_id: u64) -> PathBuf {
    let folder = folder(run_id);
    let root = std::env::temp_dir().join(&folder);
    // A long TMPDIR is common (macOS, build systems), and /tmp always works.
    if fits(run_id, &root) { root } else { Path::new("/tmp").join(folder) }
}

/// What the names of all of a run's objects begin with.
pub fn prefix(run_id: u64) -> String {
    format!("{NAME}{run_id:016x}_")
}

/// What a run's folder is called.
pub fn folder(run_id: u64) -> String {
    format!("{NAME}{run_id:016x}")
}

/// What a run's claim is called.
pub fn claim(run_id: u64) -> String {
    prefix(run_id) + CLAIM
}

/// The run whose claim is called so, if it is the name of one.
pub fn run_id_of_claim(name: &str) -> Option<u64> {
    let id = name.strip_prefix(NAME)?.split_once('_')?.0;
    let run_id = u64::from_str_radix(id, 16).ok()?;
    // Other spellings of the number are not ours.
    (name == claim(run_id)).then_some(run_id)
}

fn fits(run_id: u64, root: &Path) -> bool {
    // iceoryx2 allows only these in a path.
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    let text = root.to_str().filter(|text| text.starts_with('/') && text.chars().all(plain));
    text.is_some_and(|text| text.len() + prefix(run_id).len() <= ROOT_AND_PREFIX_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_that_is_too_long_for_a_socket_is_not_used() {
        assert!(fits(1, Path::new("/tmp/isl0000000000000001")));
        let long = format!("/{}", "a".repeat(ROOT_AND_PREFIX_MAX));
        assert!(!fits(1, Path::new(&long)));
        assert!(!fits(1, Path::new("/tmp/with a space")));
    }

    #[test]
    fn a_claim_is_known_by_its_name_and_nothing_else_is() {
        assert_eq!(run_id_of_claim(&claim(0x2a)), Some(0x2a));
        assert_eq!(run_id_of_claim(&claim(u64::MAX)), Some(u64::MAX));
        for name in [
            "isl2a_launcher",
            "isl+00000000000002a_launcher",
            "isl000000000000002A_launcher",
            "isl000000000000002a_launcher2",
            "isl000000000000002a_x.connection",
            "isl000000000000002a",
            "isé_launcher",
        ] {
            assert_eq!(run_id_of_claim(name), None, "{name}");
        }
    }
}
