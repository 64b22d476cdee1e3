//! The real program, run to its end, and what benches of it share.

use serde_json::Value;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// Runs the program with these settings, and returns its result.
pub fn run(settings: &[String]) -> Value {
    let folder = folder();
    let usual = ["--json", "--no-monitor", "--quiet"].map(str::to_owned);
    let out = format!("--out={}", folder.path().display());
    json(&[&usual, settings, &[out]].concat())
}

/// Does something else with the program, and returns the JSON that it prints last.
pub fn json(arguments: &[String]) -> Value {
    result(start(arguments))
}

/// Starts the program.
pub fn start(arguments: &[String]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_islands"));
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// Waits for its end, and returns the JSON that it prints last.
pub fn result(run: Child) -> Value {
    let output = run.wait_with_output().expect("it is our child");
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8(output.stdout).expect("it prints text");
    let last = text.lines().last().expect("it prints its result");
    serde_json::from_str(last).expect("its result is JSON")
}

/// A number of its result.
pub fn number(result: &Value, name: &str) -> f64 {
    result[name].as_f64().expect("the result has this number")
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
