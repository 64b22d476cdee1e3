//! How genes are read where people changed the scales of the course's parameters.

use super::gene::{Gene, PARAMETER_COUNT};
use super::parameters::{PARAMETERS, Use};
use super::profile::Profile;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How genes are read: a profile, and the scales that differ from its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// What the numbers of a gene mean.
    pub profile: Profile,
    /// The scales that were changed.
    pub scales: Scales,
}

impl From<Profile> for Reading {
    fn from(profile: Profile) -> Self {
        Self { profile, scales: Scales::default() }
    }
}

impl Reading {
    /// What parameter `i` of [`PARAMETERS`] is for.
    pub fn used(&self, i: usize) -> Use {
        let used = PARAMETERS[i].used(self.profile);
        match self.scales.0[i] {
            None => used,
            Some(scale) => Use { to: used.from + scale, ..used },
        }
    }

    /// What the value of parameter `i` of a gene means: a number of its range.
    pub fn value(&self, gene: &Gene, i: usize) -> f64 {
        let Use { from, to, .. } = self.used(i);
        from + gene.0[i] * (to - from)
    }
}

/// Parameters whose scale may be changed: lengths, angles, copies and frequency. The others are ignored by the
/// course's program or choose between a few things.
const SCALABLE: [usize; 10] = [1, 2, 3, 8, 9, 10, 11, 12, 13, 16];
/// The largest scale.
pub const SCALE_MAX: f64 = 100.0;
/// The largest scale of the recurrence: growth is a product of copies.
pub const RECURRENCE_SCALE_MAX: f64 = 16.0;
const RECURRENCE: usize = 3;

/// Scales of the course's parameters that differ from the ones of profile `coursework`: a gene's number times the
/// scale is the value. By default none does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "BTreeMap<String, f64>", try_from = "BTreeMap<String, f64>")]
pub struct Scales([Option<f64>; PARAMETER_COUNT]);

/// Why a scale cannot be changed so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ScaleError {
    /// There is no such parameter, or it has no scale.
    #[error(
        "{0:?} has no scale to change: choose one of {names}",
        names = SCALABLE.map(|i| PARAMETERS[i].name).join(", ")
    )]
    Parameter(String),
    /// The number makes no sense.
    #[error("the scale of {name} must be over 0 and at most {max}, not {scale}")]
    Value {
        /// The parameter.
        name: String,
        /// Its largest scale.
        max: f64,
        /// What was asked for.
        scale: f64,
    },
    /// It is no such assignment.
    #[error("write a parameter and its scale, such as link-length=1, not {0:?}")]
    Syntax(String),
    /// The profile's ranges are what it is.
    #[error("only profile coursework has scales to change, not {0}")]
    Profile(Profile),
}

impl Scales {
    /// None is changed.
    pub const NONE: Self = Self([None; PARAMETER_COUNT]);

    /// Changes the scale of a parameter.
    ///
    /// # Errors
    /// If it has none, or none of that size.
    pub fn set(&mut self, name: &str, scale: f64) -> Result<(), ScaleError> {
        let index = SCALABLE.into_iter().find(|&i| PARAMETERS[i].name == name);
        let index = index.ok_or_else(|| ScaleError::Parameter(name.chars().take(40).collect()))?;
        let max = if index == RECURRENCE { RECURRENCE_SCALE_MAX } else { SCALE_MAX };
        if !(scale > 0.0 && scale <= max) {
            return Err(ScaleError::Value { name: name.to_owned(), max, scale });
        }
        self.0[index] = Some(scale);
        Ok(())
    }

    /// Whether none was changed.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// Whether a profile has such scales.
    ///
    /// # Errors
    /// If some are changed and it has none.
    pub fn check(&self, profile: Profile) -> Result<(), ScaleError> {
        let fine = self.is_empty() || profile == Profile::Coursework;
        fine.then_some(()).ok_or(ScaleError::Profile(profile))
    }

    /// The names of the parameters that were changed, and their scales.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let changed = |(scale, i): (Option<f64>, usize)| Some((PARAMETERS[i].name, scale?));
        self.0.into_iter().zip(0..).filter_map(changed)
    }
}

/// One change, as people write it: `link-length=1`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rescaling {
    name: String,
    scale: f64,
}

impl std::str::FromStr for Rescaling {
    type Err = ScaleError;

    fn from_str(text: &str) -> Result<Self, ScaleError> {
        let syntax = || ScaleError::Syntax(text.chars().take(40).collect());
        let (name, scale) = text.split_once('=').ok_or_else(syntax)?;
        let one = Self { name: name.to_owned(), scale: scale.parse().map_err(|_| syntax())? };
        Scales::default().set(&one.name, one.scale)?;
        Ok(one)
    }
}

impl FromIterator<Rescaling> for Scales {
    fn from_iter<T: IntoIterator<Item = Rescaling>>(changes: T) -> Self {
        let mut scales = Self::default();
        for Rescaling { name, scale } in changes {
            scales.set(&name, scale).expect("it was checked when it was read");
        }
        scales
    }
}

impl From<Scales> for BTreeMap<String, f64> {
    fn from(scales: Scales) -> Self {
        scales.iter().map(|(name, scale)| (name.to_owned(), scale)).collect()
    }
}

impl TryFrom<BTreeMap<String, f64>> for Scales {
    type Error = ScaleError;

    fn try_from(named: BTreeMap<String, f64>) -> Result<Self, ScaleError> {
        let mut scales = Self::default();
        named.into_iter().try_for_each(|(name, scale)| scales.set(&name, scale))?;
        Ok(scales)
    }
}

#[cfg(test)]
mod tests {
    use super::super::gene::VALUE_MAX;
    use super::super::{Traits, express};
    use super::*;

    fn reading(changes: &[&str]) -> Reading {
        let scales = changes.iter().map(|change| change.parse::<Rescaling>().unwrap()).collect();
        Reading { profile: Profile::Coursework, scales }
    }

    #[test]
    fn the_scales_of_the_course_are_exact() {
        let gene = Gene([0.3; PARAMETER_COUNT]);
        let own = Reading::from(Profile::Coursework);
        assert_eq!(own.value(&gene, 1), 0.3 * 2.0);
        assert_eq!(own.value(&gene, 9), 0.3 * std::f64::consts::TAU);
    }

    #[test]
    fn a_changed_scale_changes_its_parameter_and_no_other() {
        let gene = Gene([0.5; PARAMETER_COUNT]);
        let own = Profile::Coursework.decode(&gene);
        let changed = reading(&["link-length=4", "control-freq=2"]).decode(&gene);
        assert_eq!((changed.length_m, changed.phase_step_rad), (2.0, 1.0));
        assert_eq!(Traits { length_m: own.length_m, phase_step_rad: 0.5, ..changed }, own);
        assert_eq!(reading(&[]).decode(&gene), own);
    }

    #[test]
    fn the_scale_of_the_recurrence_bounds_the_copies() {
        for (scale, most) in [("1", 1), ("2", 2), ("2.5", 3), ("4", 4)] {
            let reading = reading(&[&format!("link-recurrence={scale}")]);
            let copies = |value| reading.decode(&Gene([value; PARAMETER_COUNT])).copies;
            assert_eq!((copies(0.0), copies(VALUE_MAX)), (1, most));
        }
        let genome = [Gene([0.5; PARAMETER_COUNT]), Gene([0.9; PARAMETER_COUNT])];
        let links =
            |reading: Reading| express(&genome, reading, 99).unwrap().morphology.links.len();
        assert_eq!((links(reading(&[])), links(reading(&["link-recurrence=4"]))), (4, 5));
    }

    #[test]
    fn a_scale_that_makes_no_sense_is_refused() {
        for text in [
            "link-length",
            "link-length=",
            "link-length=0",
            "link-length=NaN",
            "x=1",
            "link-length=-1",
            "link-mass=2",
            "control-amp=1",
            "link-recurrence=17",
            "link-radius=1e9",
        ] {
            assert!(text.parse::<Rescaling>().is_err(), "{text}");
        }
        assert_eq!(reading(&["link-length=1"]).scales.check(Profile::Coursework), Ok(()));
        assert!(reading(&["link-length=1"]).scales.check(Profile::Native).is_err());
        assert_eq!(Scales::default().check(Profile::Native), Ok(()));
    }
}
