//! Creatures have bodies: they can be filmed, and taken elsewhere.

#[cfg(feature = "view")]
use super::Shot;
use super::Subject;
use crate::creature::{Creature, Encoding};
use crate::evolution::Fitness;
#[cfg(feature = "view")]
use crate::evolution::{Evaluation, Outcome};
use crate::formats::{genome_csv, urdf};
use crate::problems::{Locomotion, Validation};
#[cfg(feature = "view")]
use crate::simulation::{Ground, Trajectory};
use std::io::{self, Write};
#[cfg(feature = "view")]
use std::panic::{AssertUnwindSafe, catch_unwind};

impl<E: Encoding> Subject for Locomotion<E> {
    const INHABITANTS: &'static str = "creatures";
    const HAS_BODIES: bool = true;

    fn title(&self) -> String {
        format!("Task **{}**, {}", self.task, self.encoding.title())
    }

    fn columns(&self) -> usize {
        self.encoding.columns().len()
    }

    fn read_genome(&self, bytes: &[u8], dropped: &[usize]) -> Result<Vec<E::Gene>, String> {
        let read = genome_csv::read_without(&self.encoding, bytes, dropped);
        read.map(|read| read.genome).map_err(|error| error.to_string())
    }

    fn write_genome(&self, genome: &[E::Gene], output: &mut dyn Write) -> io::Result<()> {
        genome_csv::write(genome, output)
    }

    /// As URDF. What cannot be expressed has no body, and was never scored.
    fn body(&self, genome: &[E::Gene]) -> Option<Vec<u8>> {
        let Creature { morphology, controller } = self.express(genome).ok()?;
        let mut file = Vec::new();
        urdf::write(&morphology, &controller, "champion", &mut file)
            .expect("memory takes everything");
        Some(file)
    }

    fn unit(&self) -> &'static str {
        self.task.unit()
    }

    fn feature_names(&self) -> [&'static str; 2] {
        ["links", "height"]
    }

    fn possible_scores(&self, genome: &[E::Gene]) -> Vec<Fitness> {
        Self::possible_scores(self, genome)
    }

    fn fresh(&self, genome: &[E::Gene], trials: Option<u32>) -> Vec<Validation> {
        let Ok(creature) = self.express(genome) else { return Vec::new() };
        self.validate_in_each(&creature, trials.unwrap_or(self.fresh_trials()))
    }

    fn tried_once_more(&self, genome: &[E::Gene]) -> Option<Fitness> {
        self.robustness
            .is_wanted()
            .then(|| self.express(genome).map_or(Fitness::WORST, |body| self.elsewhere(&body)))
    }

    fn short(&self, fitness: Fitness) -> String {
        match fitness.finite() {
            Some(score) => format!("{score:.2} {}", self.unit()),
            None => "failed".to_owned(),
        }
    }

    fn remark(&self, genome: &[E::Gene]) -> Option<String> {
        let creature = self.express(genome).ok()?;
        Some(format!("{} links", creature.morphology.links.len()))
    }

    fn clip_s(&self) -> f64 {
        let trial = self.trial();
        trial.settle_s + trial.scored_s
    }

    #[cfg(feature = "view")]
    fn ground(&self) -> Ground {
        self.trial().ground
    }

    #[cfg(feature = "view")]
    fn shoot(&self, genome: &[E::Gene]) -> Option<Shot> {
        let nothing = Trajectory {
            bodies: Vec::new(),
            shapes: Vec::new(),
            times_s: Vec::new(),
            poses: Vec::new(),
            scoring_from_s: 0.0,
            ground: self.ground(),
        };
        let filmed = match catch_unwind(AssertUnwindSafe(|| self.film(genome))) {
            Ok(film) => film.ok()?,
            // The island survived it, too: it is an outcome like others.
            Err(_) => (Evaluation::failed(Outcome::Panicked), nothing),
        };
        let (evaluation, trajectory) = filmed;
        let (creature, others) = (self.express(genome).ok()?, self.trial().other_creatures());
        Some(Shot { creature, others, evaluation, trajectory })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::encodings::ExpressionError;
    use crate::creature::{Controller, Link, Morphology, Shape};
    use crate::evolution::Gene;
    use crate::rng::Stream;
    use bytemuck::{Pod, Zeroable};
    use nalgebra::{UnitQuaternion, Vector3};
    use rand::RngExt;
    use serde::{Deserialize, Serialize};

    /// A second encoding, for this test alone: its gene is the size of a box.
    #[derive(Debug, Clone, PartialEq)]
    struct Boxes;

    /// Half the size along x and y, in metres.
    #[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
    #[repr(transparent)]
    struct Size([f64; 2]);

    impl Gene for Size {
        const WIRE_NAME: &'static str = "test.size";

        fn is_valid(&self) -> bool {
            self.0.iter().all(|value| (0.0..1.0).contains(value))
        }

        fn values(&self) -> &[f64] {
            &self.0
        }

        fn values_mut(&mut self) -> &mut [f64] {
            &mut self.0
        }
    }

    impl Encoding for Boxes {
        type Gene = Size;

        fn title(&self) -> String {
            "boxes".to_owned()
        }

        fn columns(&self) -> Vec<&'static str> {
            vec!["length", "width"]
        }

        fn random_gene(&self, rng: &mut Stream) -> Size {
            Size([rng.random(), rng.random()])
        }

        fn random_genome(&self, rng: &mut Stream) -> Vec<Size> {
            vec![self.random_gene(rng)]
        }

        fn distance(&self, a: &[Size], b: &[Size]) -> f64 {
            f64::from(a != b)
        }

        fn express(&self, genome: &[Size]) -> Result<Creature, ExpressionError> {
            let Size([length_m, width_m]) = *genome.first().ok_or(ExpressionError::Empty)?;
            let half_extents_m = Vector3::new(0.1 + length_m, 0.1 + width_m, 0.1);
            let shape = Shape::Cuboid { half_extents_m };
            let link = Link { shape, mass_kg: 1.0, inertia: None, joint: None };
            let root_rotation = UnitQuaternion::identity();
            Ok(Creature {
                morphology: Morphology { links: vec![link], root_rotation },
                controller: Controller::of_waves(0.1, [None]),
            })
        }

        fn count_links(&self, _: &[Size]) -> Result<usize, ExpressionError> {
            Ok(1)
        }

        fn links_max(&self) -> usize {
            1
        }
    }

    #[test]
    fn genomes_of_another_encoding_are_written_and_read_without_a_format_of_their_own() {
        let usual = Locomotion::DEFAULT;
        let Locomotion { task, engine, robustness, judged, terrain, .. } = usual;
        let problem = Locomotion { encoding: Boxes, task, engine, robustness, judged, terrain };
        let genome = vec![Size([0.25, 0.5]), Size([0.0, 0.75])];
        let mut file = Vec::new();
        problem.write_genome(&genome, &mut file).expect("memory takes everything");
        assert_eq!(str::from_utf8(&file), Ok("0.25,0.5,\n0,0.75,\n"));
        assert_eq!(problem.read_genome(&file, &[]), Ok(genome.clone()));
        assert_eq!(problem.read_genome(b"9,0.25,0.5\n0,0.75\n", &[1]), Ok(genome.clone()));
        let refused = |text: &str| problem.read_genome(text.as_bytes(), &[]).unwrap_err();
        let advice = "write a gene a line, its numbers separated by commas";
        assert_eq!(refused("0.5"), format!("line 1 has 1 column instead of 2: {advice}"));
        assert!(refused("0.5,-1").starts_with("line 1, column 2 (width) holds \"-1\": "));
        assert_eq!(problem.title(), "Task **walk**, boxes");
        assert!(problem.body(&genome).is_some_and(|urdf| urdf.starts_with(b"<?xml")));
    }
}
