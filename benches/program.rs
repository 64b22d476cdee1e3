//! The real program, run to its end, and what benches of it share.

use serde_json::Value;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Runs the program with these settings, and returns its result.
pub fn run(settings: &[String]) -> Value {
    let folder = folder();
    let output = Command::new(env!("CARGO_BIN_EXE_islands"))
        .args(["--json", "--no-monitor", "--quiet"])
        .args(settings)
        .arg("--out")
        .arg(folder.path())
        .stderr(Stdio::inherit())
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8(output.stdout).expect("it prints text");
    let last = text.lines().last().expect("it prints its result");
    serde_json::from_str(last).expect("its result is JSON")
}

/// A folder on the disk that the program was built on: what is temporary elsewhere may lie in memory.
pub fn folder() -> TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("cargo has made this folder")
}

/// The middle value, the upper one of an even number.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
