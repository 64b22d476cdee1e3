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

/// A setting of the form `name` or `name:number`.
#[derive(Debug, Clone, Copy)]
pub struct Scheme<'a> {
    text: &'a str,
    /// What stands before the colon, or all.
    pub name: &'a str,
    number: Option<&'a str>,
}

impl<'a> Scheme<'a> {
    /// Takes a text apart.
    pub fn of(text: &'a str) -> Self {
        let (name, number) = text.split_once(':').map_or((text, None), |(s, n)| (s, Some(n)));
        Self { text, name, number }
    }

    /// What a scheme without a number is.
    ///
    /// # Errors
    /// If there is a number.
    pub fn plain<T>(self, scheme: T) -> Result<T, String> {
        match self.number {
            None => Ok(scheme),
            Some(_) => Err(format!("{} takes no number", self.name)),
        }
    }

    /// The number, or the usual one where there is none.
    ///
    /// # Errors
    /// If it is no number from `least` to `most`.
    pub fn number(self, usual: f64, least: f64, most: f64) -> Result<f64, String> {
        match self.number.map(str::parse::<f64>) {
            None => Ok(usual),
            Some(Ok(number)) if (least..=most).contains(&number) => Ok(number),
            Some(_) => Err(format!("{} takes a number from {least} to {most}", self.name)),
        }
    }

    /// The whole number, or the usual one where there is none.
    ///
    /// # Errors
    /// If it is no whole number from `least` to `most`.
    pub fn whole(self, usual: u32, least: u32, most: u32) -> Result<u32, String> {
        match self.number.map(str::parse::<u32>) {
            None => Ok(usual),
            Some(Ok(number)) if (least..=most).contains(&number) => Ok(number),
            Some(_) => Err(format!("{} takes a whole number from {least} to {most}", self.name)),
        }
    }

    /// The sentence for a name that is not known.
    pub fn unknown(self, kind: &str, choices: &str) -> String {
        format!("unknown {kind} “{}”: choose {choices}", self.text)
    }
}

/// Makes types that are shown and read as text be stored as this text, too.
macro_rules! as_text {
    ($($of:ty),+) => {$(
        impl TryFrom<String> for $of {
            type Error = String;

            fn try_from(text: String) -> Result<Self, String> {
                text.parse()
            }
        }

        impl From<$of> for String {
            fn from(value: $of) -> String {
                value.to_string()
            }
        }
    )+};
}
pub(crate) use as_text;
