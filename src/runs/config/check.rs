//! What makes a configuration one that can be run.

use super::limits::{GENES_MAX, GENES_OF_ISLAND_MAX, SEED_MAX};
use super::list::{Config, SETTINGS};
use crate::archipelago::Algorithm;
use crate::archipelago::migration::MIGRANTS_MAX;
use crate::creature::encodings::course::PARAMETER_COUNT;
use crate::evolution::cma;
use crate::problems::{Function, Pattern};
use crate::runs::failure::Failure;
use crate::runs::kind::Kind;
use crate::runs::terrains::KeptTerrain;

impl Config {
    /// Says what is wrong with the configuration, if anything.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn check(&self) -> Result<(), Failure> {
        self.check_values()?;
        self.check_use()
    }

    /// Says what is wrong with the values, whether or not all of them mean something: those of a run that was launched
    /// were checked by the program that launched it.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn check_values(&self) -> Result<(), Failure> {
        self.check_dimensions()?;
        if self.seed.is_some_and(|seed| seed > SEED_MAX) {
            return Err(Failure::usage(format!("seed must be at most {SEED_MAX}")));
        }
        // A number that is too large for a file is out of its range as well, which is found for all then.
        let unused = self.unused().unwrap_or_default();
        let is_used =
            |name: &str| unused.iter().all(|unused| unused.name != name || unused.is_said);
        for setting in SETTINGS.iter().filter(|setting| is_used(&setting.name)) {
            setting.check(self).map_err(Failure::usage)?;
        }
        self.check_genes()?;
        self.check_migrants()?;
        self.terrain.as_ref().map_or(Ok(()), KeptTerrain::check)?;
        self.scales.check(self.profile).map_err(|error| Failure::usage(error.to_string()))?;
        self.locomotion().check().map_err(|error| Failure::usage(error.to_string()))
    }

    /// Makes sure that the problem can have so many variables or bits.
    fn check_dimensions(&self) -> Result<(), Failure> {
        let Self { problem, dimensions, instance, block, .. } = *self;
        let least = if problem == Kind::Function(Function::Rosenbrock) { 2 } else { 1 };
        if !(least..=GENES_MAX).contains(&dimensions) {
            return Err(Failure::usage(format!(
                "dimensions must be from {least} to {GENES_MAX}, not {dimensions}"
            )));
        }
        if instance > SEED_MAX {
            return Err(Failure::usage(format!("instance must be at most {SEED_MAX}")));
        }
        self.check_algorithm()?;
        let is_whole = (1..=dimensions).contains(&block) && dimensions.is_multiple_of(block);
        match problem {
            Kind::Bits(Pattern::Trap | Pattern::RoyalRoad) if !is_whole => {
                Err(Failure::usage(format!(
                    "{dimensions} bits cannot be cut into blocks of {block}: change --dimensions or --block"
                )))
            }
            _ => Ok(()),
        }
    }

    /// Makes sure that the algorithm can search there.
    fn check_algorithm(&self) -> Result<(), Failure> {
        let values = match self.problem {
            Kind::Creatures => self.genes.saturating_mul(PARAMETER_COUNT),
            Kind::Function(_) => self.dimensions,
            Kind::Bits(_) | Kind::Network(_) => 0,
        };
        match self.algorithm {
            Algorithm::CmaEs if values == 0 => Err(Failure::usage(format!(
                "cma-es learns from numbers, and the genes of {} hold none: choose another --algorithm",
                self.problem
            ))),
            Algorithm::CmaEs if values > cma::DIMENSIONS_MAX => Err(Failure::usage(format!(
                "cma-es learns {} numbers at most, and a genome has {values}: choose smaller genomes",
                cma::DIMENSIONS_MAX
            ))),
            _ => Ok(()),
        }
    }

    fn check_genes(&self) -> Result<(), Failure> {
        let genes = self.population.saturating_mul(self.max_genes);
        if genes > GENES_OF_ISLAND_MAX {
            return Err(Failure::usage(format!(
                "a population of {} with max-genes {} may have {genes} genes: an island holds {GENES_OF_ISLAND_MAX} \
                 at most",
                self.population, self.max_genes
            )));
        }
        match self.problem {
            Kind::Network(test) if self.start.genes_max(test.sockets()) > self.max_genes => {
                Err(Failure::usage(format!(
                    "--start {} makes networks of up to {} genes, more than --max-genes {}: allow more",
                    self.start,
                    self.start.genes_max(test.sockets()),
                    self.max_genes
                )))
            }
            _ => Ok(()),
        }
    }

    fn check_migrants(&self) -> Result<(), Failure> {
        let migrants_max = MIGRANTS_MAX.min(self.population);
        if self.migrants > migrants_max {
            return Err(Failure::usage(format!(
                "{} migrants are more than there can be: take at most {migrants_max}, with a \
                 population of {}",
                self.migrants, self.population
            )));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_sound_and_each_impossible_wish_is_refused() {
        let sound = Config::default();
        assert!(sound.check().is_ok());
        for wrong in [
            Config { islands: 0, ..sound.clone() },
            Config { population: 1, ..sound.clone() },
            Config { migrants: 25, ..sound.clone() },
            Config { migrants: 33, population: 99, ..sound.clone() },
            Config { elites: 24, ..sound.clone() },
            Config { genes: 13, ..sound.clone() },
            Config { genes: 0, ..sound.clone() },
            Config { point_rate: f64::NAN, ..sound.clone() },
            Config { migration_interval: 0, ..sound.clone() },
            Config { threads: Some(0), ..sound.clone() },
            Config { robustness: 101, ..sound.clone() },
            Config { clip_every: Some(0), ..sound.clone() },
            Config { threads: Some(usize::MAX), ..sound.clone() },
            Config { seed: Some(u64::MAX), ..sound.clone() },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
        let none = Config { max_genes: 0, ..sound }.check().expect_err("it is impossible");
        assert_eq!(none.message, "max-genes must be from 1 to 1000, not 0");
    }
}
