//! The one place that makes problems of configurations, and hands the one that is meant to whoever does something with it.

use super::config::Config;
use super::kind::Kind;
use super::subject::Subject;
use crate::problems::{Benchmark, Bits, Neat};

/// What is done with a problem, whichever it is.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Does it.
    fn visit<P: Subject>(self, problem: P) -> Self::Output;
}

impl Config {
    /// Makes the problem that is solved, and hands it to a visitor.
    pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
        let Self { dimensions, instance, rotated, block, .. } = *self;
        match self.problem {
            Kind::Creatures => visitor.visit(self.locomotion()),
            Kind::Function(function) => {
                visitor.visit(Benchmark::new(function, dimensions, instance, rotated))
            }
            Kind::Bits(pattern) => visitor.visit(Bits { pattern, bits: dimensions, block }),
            Kind::Network(test) => visitor.visit(Neat { test, start: self.start }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::{Selection, Variation};
    use crate::rng::{Purpose, Source};
    use crate::runs::config::{SETTINGS, Wish};

    fn usual(problem: Kind) -> Config {
        Config::default_for(Wish { problem: Some(problem), ..Wish::default() })
    }

    fn useless(problem: Kind) -> Vec<&'static str> {
        let useless = SETTINGS.iter().filter(|setting| !(setting.about.problem)(problem));
        useless.map(|setting| setting.name.as_str()).collect()
    }

    #[test]
    fn the_defaults_of_every_problem_are_sound_and_survive_their_file() {
        for problem in Kind::all() {
            let config = Config { seed: Some(7), ..usual(problem) };
            config.check().unwrap_or_else(|failure| panic!("{problem}: {failure}"));
            let text = config.to_toml();
            assert_eq!(Config::parse(&text).as_ref(), Ok(&config), "{problem}");
            let is_said =
                |name: &&str| text.lines().any(|line| line.starts_with(&format!("{name} =")));
            assert_eq!(useless(problem).into_iter().find(is_said), None, "{problem}: {text}");
            assert_eq!(Config::parse(&format!("problem = \"{problem}\"")), Ok(usual(problem)));
            assert_eq!(problem.to_string().parse(), Ok(problem));
        }
    }

    #[test]
    fn defaults_follow_the_dimensions_and_what_is_said_wins_over_them() {
        let config = Config::parse("problem = \"sphere\"\ndimensions = 8\npopulation = 9");
        let config = config.expect("it is sound");
        assert_eq!((config.genes, config.max_genes, config.point_rate), (8, 8, 0.125));
        assert_eq!((config.population, config.generations), (9, 1_000));
    }

    #[test]
    fn with_sharing_parents_are_not_picked_by_tournaments_unless_it_is_said() {
        let selection = |text: &str| Config::parse(text).expect("it is sound").selection;
        assert_eq!(selection("survival = \"sharing:0.2\""), Selection::Sus);
        assert_eq!(selection("problem = \"trap\"\nsurvival = \"sharing\""), Selection::Sus);
        let said = "survival = \"sharing\"\nselection = \"tournament:3\"";
        assert_eq!(selection(said), Selection::Tournament { size: 3 });
    }

    #[test]
    fn what_means_nothing_to_a_scheme_of_survival_is_refused_by_name() {
        for survival in ["crowding", "afpo", "map-elites"] {
            for (name, setting) in [("selection", "selection = \"sus\""), ("elites", "elites = 1")]
            {
                let text = format!("survival = \"{survival}\"\n{setting}");
                let config = Config::parse(&text).expect("it can be read");
                let refusal = config.check().expect_err("it means nothing").message;
                let said = format!("{name} means nothing to {survival}");
                assert!(refusal.starts_with(&said), "{refusal}");
            }
            let panmictic = format!("survival = \"{survival}\"\nalgorithm = \"panmictic\"");
            let config = Config::parse(&panmictic).expect("it can be read").settled();
            assert!(config.check().is_ok(), "{survival}");
        }
    }

    #[test]
    fn a_file_that_cannot_be_is_complained_of_by_its_line() {
        let complaint = |text| Config::parse(text).unwrap_err();
        assert!(complaint("seed = 1\nproblem = \"cube\"").starts_with("line 2: unknown problem"));
        assert!(complaint("problem = \"sphere\"\nsize = 3").starts_with("line 2: "));
        assert!(complaint("dimensions = -1").starts_with("line 1: "));
    }

    #[test]
    fn genomes_of_every_problem_are_read_as_they_were_written_and_none_has_another_length() {
        struct Writer;
        impl Visitor for Writer {
            type Output = ();

            fn visit<P: Subject>(self, problem: P) {
                let source = Source { seed: 1, island: 0 };
                let mut rng = source.stream(0, 0, Purpose::Genesis);
                let genome = problem.random_genome(&mut rng);
                let mut file = Vec::new();
                problem.write_genome(&genome, &mut file).expect("memory takes everything");
                assert_eq!(problem.read_genome(&file, &[]), Ok(genome));
                assert_eq!(problem.body(&[]), None);
            }
        }
        Kind::all().into_iter().for_each(|problem| usual(problem).visit(Writer));
    }

    #[test]
    fn offspring_are_as_long_as_their_parents_where_genomes_are_of_one_length() {
        struct Breeder<'a>(&'a Config);
        impl Visitor for Breeder<'_> {
            type Output = ();

            fn visit<P: Subject>(self, problem: P) {
                let variation = Variation {
                    grow_rate: 1.0,
                    shrink_rate: 1.0,
                    ..self.0.archipelago().strategy.variation
                };
                let source = Source { seed: 1, island: 0 };
                let mut rng = source.stream(0, 0, Purpose::Crossover);
                let [a, b] = [0; 2].map(|_| problem.random_genome(&mut rng));
                for _ in 0..50 {
                    let mut child = problem.crossover(&a, &b, &variation, &mut rng);
                    problem.mutate(&mut child, &variation, &mut rng);
                    assert_eq!(child.len(), self.0.dimensions);
                }
            }
        }
        for problem in Kind::all().into_iter().filter(|kind| kind.is_of_one_length()) {
            usual(problem).visit(Breeder(&usual(problem)));
        }
    }
}
