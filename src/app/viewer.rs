//! The viewer is a program of its own, which the user may have.

use crate::app::console::say;
use crate::view::VIEWER_VERSION;
use std::io::ErrorKind;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;
use std::time::Duration;

/// The program's name.
const PROGRAM: &str = "rerun";
/// How often and how many times is looked whether a viewer that was opened is still there.
const LOOK: Duration = Duration::from_millis(50);
const LOOKS: u32 = 20;

/// Opens a viewer on a recording or an address, in the background; it stays when this process ends. Where there is
/// none, or one of another version, it is said how to get it. Who is about to end waits for the thread.
pub fn open(what: String) -> JoinHandle<()> {
    std::thread::spawn(move || {
        if let Err(reason) = try_to_open(&what) {
            say(&format!("warning: {reason}"));
        }
    })
}

fn try_to_open(what: &str) -> Result<(), String> {
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => format!("there is no viewer “{PROGRAM}” on the path; {}", remedy()),
        _ => format!("cannot open the viewer {PROGRAM}: {error}"),
    };
    let output = Command::new(PROGRAM).arg("--version").stdin(Stdio::null()).output();
    let said = String::from_utf8_lossy(&output.map_err(failed)?.stdout).into_owned();
    if !is_of_version(&said, VIEWER_VERSION) {
        let said = said.lines().next().unwrap_or_default().chars().take(60).collect::<String>();
        return Err(format!("the viewer on the path is another version ({said}); {}", remedy()));
    }
    // In a group of its own it does not hear the Ctrl-C that stops a run.
    let viewer = Command::new(PROGRAM)
        .arg(what)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .process_group(0)
        .spawn()
        .map_err(failed)?;
    match early_end(viewer) {
        Some(status) => Err(format!(
            "the viewer ended at once ({status}); is there a screen? What it says: {PROGRAM} {what}"
        )),
        None => Ok(()),
    }
}

/// How a viewer failed, if it does so within a moment: without a screen it cannot open its window.
fn early_end(mut viewer: Child) -> Option<ExitStatus> {
    for _ in 0..LOOKS {
        match viewer.try_wait() {
            Ok(None) => std::thread::sleep(LOOK),
            Ok(Some(status)) => return Some(status).filter(|status| !status.success()),
            Err(_) => return None,
        }
    }
    None
}

/// Whether that is what a viewer of a version says of itself, such as “rerun-cli 0.36.3 [rustc …]”.
fn is_of_version(said: &str, version: &str) -> bool {
    said.split_whitespace().any(|word| word == version)
}

fn remedy() -> String {
    format!(
        "get it with: pip install rerun-sdk=={VIEWER_VERSION}  (or: cargo install \
         rerun-cli@{VIEWER_VERSION} --locked)"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_same_version_is_the_same() {
        let said = "rerun-cli 0.36.3 [rustc 1.95.0, LLVM 21] x86_64-unknown-linux-gnu release";
        assert!(is_of_version(said, "0.36.3"));
        assert!(!is_of_version(said, "0.36.2") && !is_of_version("", "0.36.3"));
        assert!(!is_of_version("rerun-cli 0.36.30", "0.36.3"));
    }
}
