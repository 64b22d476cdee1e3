//! Which settings mean nothing to the problem, the algorithm or who survives.

use super::defaults::Wish;
use super::list::{Config, SETTINGS};
use crate::runs::failure::Failure;
use crate::runs::kind::Kind;
use crate::runs::setting::{self, About, Section};

/// What only creatures have, besides settings with a flag.
const FILES_OF_BODIES: [&str; 2] = ["scales", "terrain"];

/// A setting that means nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unused {
    /// Its name.
    pub name: &'static str,
    /// What it means nothing to: a problem, an algorithm or a scheme of survival.
    choice: String,
    /// The flag that chooses such.
    flag: &'static str,
    /// Whether it has another value than its default.
    pub is_said: bool,
}

impl Config {
    /// The settings that mean nothing here, in their order.
    ///
    /// # Errors
    /// If a number is too large for a file.
    pub fn unused(&self) -> Result<Vec<Unused>, Failure> {
        let Self { problem, dimensions, survival, .. } = *self;
        let wish =
            Wish { problem: Some(problem), dimensions: Some(dimensions), survival: Some(survival) };
        let (said, usual) = (self.table()?, Self::default_for(wish).table()?);
        let settings = SETTINGS.iter().map(|setting| (setting.name.as_str(), setting.about));
        let of_bodies = setting::of(Section::Creatures).tries_bodies();
        let files = FILES_OF_BODIES.map(|name| (name, of_bodies));
        let unused = settings.chain(files).filter_map(|(name, about)| {
            let (choice, flag) = self.has_no_use_for(&about)?;
            Some(Unused { name, choice, flag, is_said: said.get(name) != usual.get(name) })
        });
        Ok(unused.collect())
    }

    /// What a setting means nothing to, and the flag that chooses it; none if it means something.
    fn has_no_use_for(&self, about: &About) -> Option<(String, &'static str)> {
        let Self { problem, algorithm, survival, .. } = *self;
        let useless = [
            (!(about.algorithm)(algorithm)).then(|| (algorithm.to_string(), "algorithm")),
            (!(about.survival)(survival)).then(|| (survival.to_string(), "survival")),
            (!(about.problem)(problem)).then(|| (problem.to_string(), "problem")),
        ];
        useless.into_iter().flatten().next()
    }

    /// Makes sure that nothing is said that means nothing; at its default it is not said. The ranges must have been
    /// checked.
    pub(super) fn check_use(&self) -> Result<(), Failure> {
        match self.unused()?.iter().find(|unused| unused.is_said) {
            Some(Unused { name, choice, flag, .. }) => Err(Failure::usage(format!(
                "{name} means nothing to {choice}: leave it out, or choose another --{flag}"
            ))),
            None => Ok(()),
        }
    }

    /// The names of the settings that mean nothing to a problem.
    pub(super) fn useless_to(problem: Kind) -> Vec<&'static str> {
        let useless = SETTINGS.iter().filter(|setting| !(setting.about.problem)(problem));
        let files = FILES_OF_BODIES.into_iter().filter(|_| !problem.has_bodies());
        useless.map(|setting| setting.name.as_str()).chain(files).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::{Algorithm, Digest, lockstep};
    use crate::runs::catalogue::Visitor;
    use crate::runs::subject::Subject;

    const SPHERE: &str =
        "problem = \"sphere\"\ndimensions = 3\nislands = 3\npopulation = 6\ngenerations = 40";
    const WALK: &str = "islands = 1\npopulation = 3\ngenerations = 1\nrobustness = 0\njudged = false\nmax-links = 3";

    /// What each setting of the search may be besides its default, and a run that it may decide.
    const OTHERWISE: [(&str, &str, &str); 21] = [
        ("genes", "2", WALK),
        ("selection", "roulette", SPHERE),
        ("elites", "4", SPHERE),
        ("survival", "crowding", SPHERE),
        ("crossover", "uniform", SPHERE),
        ("crossover-rate", "0", SPHERE),
        ("mutation", "gaussian", SPHERE),
        ("point-rate", "1", SPHERE),
        ("point-amount", "0.1", SPHERE),
        ("shrink-rate", "1", WALK),
        ("grow-rate", "1", WALK),
        ("duplicate-rate", "1", WALK),
        ("adaptation", "one-fifth", SPHERE),
        ("heterogeneous", "true", SPHERE),
        ("topology", "full", SPHERE),
        ("migration-interval", "2", SPHERE),
        ("migrants", "0", SPHERE),
        ("migration-lag", "0", SPHERE),
        ("emigrants", "random", SPHERE),
        ("replacement", "random", SPHERE),
        ("exchange", "async", SPHERE),
    ];

    fn result(config: &Config) -> Digest {
        struct Run<'a>(&'a Config);
        impl Visitor for Run<'_> {
            type Output = Digest;

            fn visit<P: Subject>(self, problem: P) -> Digest {
                let (archipelago, generations) = (self.0.archipelago(), self.0.generations);
                Digest::of(&lockstep::run(&problem, &archipelago, generations, |_| {}))
            }
        }
        config.visit(Run(config))
    }

    fn run(algorithm: Algorithm, text: &str) -> Config {
        let text = format!("{text}\nseed = 7\nalgorithm = \"{algorithm}\"");
        Config::parse(&text).expect("it is sound")
    }

    #[test]
    fn an_algorithm_refuses_a_setting_of_the_search_if_and_only_if_it_decides_nothing() {
        for algorithm in Algorithm::ALL {
            let usual = [SPHERE, WALK].map(|text| result(&run(algorithm, text).settled()));
            for (name, value, text) in OTHERWISE {
                let setting = SETTINGS.iter().find(|setting| setting.name == name);
                let mut config = run(algorithm, text);
                (setting.expect("there is one").set)(&mut config, value).expect("it can be");
                // As the program does: what is settled says less.
                let checked = config.check();
                let config = config.settled();
                let checked = checked.and_then(|()| config.check());
                let usual = usual[usize::from(text == WALK)];
                // In lockstep nobody is faster than another.
                let decides = match name {
                    "exchange" => algorithm == Algorithm::Ga,
                    _ => result(&config) != usual,
                };
                assert_eq!(checked.is_ok(), decides, "{algorithm} {name}: {checked:?}");
                if let Err(failure) = checked {
                    let said = format!("{name} means nothing to {algorithm}: ");
                    assert!(failure.message.starts_with(&said), "{failure}");
                }
            }
        }
    }

    #[test]
    fn every_setting_of_the_search_is_tried_with_every_algorithm() {
        let of_search =
            |about: &About| matches!(about.section, Section::GeneticAlgorithm | Section::Migration);
        let all = SETTINGS.iter().filter(|setting| of_search(&setting.about));
        // It bounds how many genes a random genome may have, too.
        let all = all.map(|setting| setting.name.as_str()).filter(|name| *name != "max-genes");
        assert_eq!(all.collect::<Vec<_>>(), OTHERWISE.map(|(name, ..)| name));
    }

    #[test]
    fn what_a_run_was_launched_with_can_be_read_whatever_it_means() {
        let config = Config { elites: 3, ..run(Algorithm::Random, SPHERE) };
        let refusal = config.check().expect_err("it means nothing").message;
        assert_eq!(
            refusal,
            "elites means nothing to random: leave it out, or choose another --algorithm"
        );
        assert!(config.check_values().is_ok());
        assert!(
            Config { population: 2, elites: 2, ..run(Algorithm::Random, SPHERE) }.check().is_ok()
        );
    }
}
