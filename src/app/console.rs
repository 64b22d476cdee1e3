//! The one place that prints, and the one that reads a clock.

use indicatif::MultiProgress;
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

/// Says something to the user, on standard error. Nobody listening is no reason to fail.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", printable(line));
}

/// Says something to the user above bars of progress.
#[expect(clippy::disallowed_methods, reason = "this is the one place that prints")]
pub fn say_above(bars: &MultiProgress, line: &str) {
    // A terminal that went away is no reason to fail.
    let _ = bars.println(printable(line));
}

/// Prints a line of the result, on standard output. Nobody reading it is no reason to fail, either.
pub fn print(line: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{}", printable(line));
}

/// A text that tells a terminal nothing but where lines end: files may say anything, and some of it is shown. What was
/// JSON is the same JSON.
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_command = |c: char| c.is_control() && !"\n\t".contains(c);
    if !text.contains(is_command) {
        return text.into();
    }
    let shown = |c: char| match is_command(c) {
        true => format!("\\u{:04x}", u32::from(c)),
        false => c.to_string(),
    };
    text.chars().map(shown).collect::<String>().into()
}

/// A path as a shell takes it.
pub fn quoted(path: &Path) -> String {
    let path = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+:@%".contains(c);
    match path.chars().all(is_plain) {
        true => path,
        false => format!("'{}'", path.replace('\'', r"'\''")),
    }
}

/// Measures how long something takes, for people and for time-outs.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Instant);

impl Stopwatch {
    /// A stopwatch that starts now.
    #[expect(clippy::disallowed_methods, reason = "this is the one place that may read the clock")]
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// The time since its start.
    pub fn elapsed(self) -> Duration {
        self.0.elapsed()
    }

    /// The same in seconds.
    pub fn seconds(self) -> f64 {
        self.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_that_is_printed_stays_what_it_is() {
        let name = "\u{7f}\u{9b}\u{1b}\"";
        let json = serde_json::to_string(name).expect("it is text");
        let printed: String = serde_json::from_str(&printable(&json)).expect("it is JSON");
        assert_eq!(printed, name);
        assert!(!printable(&json).contains(char::is_control));
    }

    #[test]
    fn what_is_printed_commands_no_terminal() {
        assert_eq!(printable("a\tb\nc ±1"), "a\tb\nc ±1");
        assert_eq!(printable("\u{1b}[2J\u{9b}1\r\u{7}"), "\\u001b[2J\\u009b1\\u000d\\u0007");
    }
}
