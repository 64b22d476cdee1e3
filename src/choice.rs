//! Settings that are one of a few: read by the names that they are shown by.

use std::fmt::Display;

/// The one of `all` that is shown as `text`; `kind` says what is chosen.
///
/// # Errors
/// If none is: a sentence that names them all.
pub fn named<T: Copy + Display>(kind: &str, all: &[T], text: &str) -> Result<T, String> {
    all.iter().copied().find(|choice| choice.to_string() == text).ok_or_else(|| {
        let known: Vec<String> = all.iter().map(T::to_string).collect();
        format!("unknown {kind} “{text}”: choose one of {}", known.join(", "))
    })
}
