//! Genomes said in the course's terms, for its program to read.

use super::gene::{Gene, PARAMETER_COUNT};
use super::parameters::PARAMETERS;
use super::profile::Profile;
use super::scales::Reading;
use super::traits::{SolidKind, Traits};
use crate::creature::brain::Waveform;

/// What a course's program cannot build: the gene, from 1, and why.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("gene {gene} cannot be said in the course's terms: {reason}")]
pub struct Unsayable {
    /// The gene, from 1.
    pub gene: usize,
    /// What it has that no gene of the course has.
    pub reason: String,
}

/// Says a genome in the terms of the course's program, with its own scales: it builds the same body there.
///
/// # Errors
/// What the program could not build.
pub fn translate(genome: &[Gene], reading: &Reading) -> Result<Vec<Gene>, Unsayable> {
    let translated = genome.iter().zip(1..).map(|(gene, number)| {
        let translated = match reading.profile {
            Profile::Coursework => rescale(gene, reading),
            Profile::Lecture | Profile::Native => Err(foreign(&reading.decode(gene), reading)),
        };
        translated.map_err(|reason| Unsayable { gene: number, reason })
    });
    translated.collect()
}

/// Brings the numbers of a gene to the profile's own scales.
fn rescale(gene: &Gene, reading: &Reading) -> Result<Gene, String> {
    let mut values = gene.0;
    for (i, parameter) in PARAMETERS.iter().enumerate().take(PARAMETER_COUNT) {
        let (theirs, own) = (reading.used(i), parameter.coursework);
        if theirs == own {
            continue;
        }
        let (span, most) = (own.to - own.from, own.to);
        values[i] *= (theirs.to - theirs.from) / span;
        if values[i] >= 1.0 {
            let name = parameter.name;
            let value = own.from + values[i] * span;
            return Err(format!("its {name} is {value}, and in the course always below {most}"));
        }
    }
    Ok(Gene(values))
}

/// Why a gene of another profile cannot be said: there is always a reason.
fn foreign(traits: &Traits, reading: &Reading) -> String {
    let density = traits.density_kg_m3;
    let reasons = [
        (traits.solid == SolidKind::Cuboid, "its link is a box, and in the course all are cylinders".to_owned()),
        (!traits.is_revolute, "its joint is fixed, and in the course all of them turn".to_owned()),
        (traits.waveform == Waveform::Ramp, "its motor follows a ramp, which the course has not".to_owned()),
        (
            reading.profile == Profile::Native,
            "its link hangs by its end on its parent's surface, and in the course by its middle anywhere".to_owned(),
        ),
    ];
    let first = reasons.into_iter().find_map(|(is_so, reason)| is_so.then_some(reason));
    first.unwrap_or_else(|| {
        format!("its density is {density:.3} kg/m³ and its motor's top speed {:.3} rad/s, and in the course both are 1", traits.amplitude_rad_s)
    })
}

#[cfg(test)]
mod tests {
    use super::super::development::express;
    use super::super::scales::{Rescaling, Scales};
    use super::*;
    use expect_test::expect;

    fn coursework(changes: &[&str]) -> Reading {
        let changes = changes.iter().map(|change| change.parse::<Rescaling>().unwrap());
        Reading { profile: Profile::Coursework, scales: changes.collect() }
    }

    #[test]
    fn a_genome_of_the_course_is_said_as_it_is() {
        let genome = [Gene([0.1; 17]), Gene([0.9; 17])];
        assert_eq!(translate(&genome, &Profile::Coursework.into()).unwrap(), genome);
    }

    #[test]
    fn a_genome_with_other_scales_becomes_the_same_body_with_the_courses_own() {
        let reading = coursework(&["link-length=1", "link-recurrence=2", "control-freq=0.5"]);
        let genome = [Gene([0.4; 17]), Gene([0.7; 17]), Gene([0.2; 17])];
        let translated = translate(&genome, &reading).unwrap();
        let [theirs, ours] =
            [express(&genome, reading, 9), express(&translated, Profile::Coursework, 9)];
        let (theirs, ours) = (theirs.unwrap(), ours.unwrap());
        assert_eq!(theirs.morphology.links.len(), ours.morphology.links.len());
        for (a, b) in theirs.morphology.links.iter().zip(&ours.morphology.links) {
            assert!((a.mass_kg - b.mass_kg).abs() < 1e-12);
        }
    }

    #[test]
    fn what_the_course_cannot_build_is_refused_with_the_reason() {
        let mut fixed = Gene([0.4; 17]);
        fixed.0[5] = 0.9;
        let mut cuboid = Gene([0.4; 17]);
        cuboid.0[0] = 0.9;
        let long = coursework(&["link-length=4"]);
        let lecture = Profile::Lecture.into();
        let native = Profile::Native.into();
        let cases: [(Gene, Reading); 5] = [
            (Gene([0.9; 17]), long),
            (Gene([0.4; 17]), native),
            (fixed, lecture),
            (cuboid, native),
            (Gene([0.4; 17]), lecture),
        ];
        let reasons =
            cases.map(|(gene, reading)| translate(&[gene], &reading).unwrap_err().to_string());
        expect![[r#"
            gene 1 cannot be said in the course's terms: its link-length is 3.6, and in the course always below 2
            gene 1 cannot be said in the course's terms: its link hangs by its end on its parent's surface, and in the course by its middle anywhere
            gene 1 cannot be said in the course's terms: its joint is fixed, and in the course all of them turn
            gene 1 cannot be said in the course's terms: its link is a box, and in the course all are cylinders
            gene 1 cannot be said in the course's terms: its density is 0.460 kg/m³ and its motor's top speed 0.100 rad/s, and in the course both are 1"#]].assert_eq(&reasons.join("\n"));
        assert_eq!(lecture.scales, Scales::NONE);
    }
}
