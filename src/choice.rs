//! Settings that are one of a few: read by the names that they are shown by.
//!
//! `strum` derives the names and the list of an enum's variants, so that none can be forgotten; `one_of` reads them.
//! Where variants hold a number, its `EnumCount` has the compiler count the list of the usual ones.

use std::fmt::Display;
use strum::VariantArray;

/// All variants of an enum that has `N`.
pub const fn all<T: VariantArray + Copy, const N: usize>() -> [T; N] {
    match T::VARIANTS.split_first_chunk() {
        Some((all, [])) => *all,
        _ => panic!("N is how many variants there are"),
    }
}

/// The one of `all` that is shown as `text`; `kind` says what is chosen.
///
/// # Errors
/// If none is: a sentence that names them all.
pub fn named<T: Copy + Display>(kind: &str, all: &[T], text: &str) -> Result<T, String> {
    let is_it = |choice: &T| choice.to_string() == text;
    all.iter().copied().find(is_it).ok_or_else(|| unknown(kind, all, text))
}

fn unknown<T: Display>(kind: &str, all: &[T], text: &str) -> String {
    let known: Vec<String> = all.iter().map(T::to_string).collect();
    format!("unknown {kind} “{text}”: choose one of {}", known.join(", "))
}

/// A setting of the form `name` or `name:number`.
#[derive(Debug, Clone, Copy)]
pub struct Scheme<'a> {
    name: &'a str,
    number: Option<&'a str>,
}

impl<'a> Scheme<'a> {
    /// Takes a text apart, and finds the one that its name chooses; `usual` has one of every kind, with its usual number.
    ///
    /// # Errors
    /// If there is none: a sentence that names them all.
    pub fn of<T: Copy + Display>(
        kind: &str,
        usual: &[T],
        text: &'a str,
    ) -> Result<(T, Self), String> {
        let (name, number) = text.split_once(':').map_or((text, None), |(s, n)| (s, Some(n)));
        let is_it = |choice: &T| choice.to_string().split(':').next() == Some(name);
        let chosen = usual.iter().copied().find(is_it);
        let chosen = chosen.ok_or_else(|| unknown(kind, usual, text))?;
        Ok((chosen, Self { name, number }))
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
}

/// Gives an enum that derives `strum::Display` and `strum::VariantArray` the list of its variants, and reads them by
/// their names.
macro_rules! one_of {
    ($kind:literal, $of:ident) => {
        impl $of {
            /// Every one, in order.
            pub const ALL: [Self; <Self as strum::VariantArray>::VARIANTS.len()] =
                crate::choice::all();
        }

        impl std::str::FromStr for $of {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                crate::choice::named($kind, &Self::ALL, text)
            }
        }
    };
}
pub(crate) use one_of;

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
