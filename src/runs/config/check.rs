//! What makes a configuration one that can be run.

use super::*;

impl Config {
    /// Says what is wrong with the configuration, if anything.
    ///
    /// # Errors
    /// One sentence that says what to change.
    pub fn check(&self) -> Result<(), Failure> {
        self.check_dimensions()?;
        self.check_ranges()?;
        self.check_genes()?;
        self.check_migrants()?;
        self.terrain.as_ref().map_or(Ok(()), KeptTerrain::check)?;
        self.scales.check(self.profile).map_err(|error| Failure::usage(error.to_string()))?;
        match self.seed {
            Some(seed) if seed > SEED_MAX => {
                Err(Failure::usage(format!("seed must be at most {SEED_MAX}")))
            }
            _ => self.check_use(),
        }
    }

    fn check_ranges(&self) -> Result<(), Failure> {
        let within = |name, value: f64, least: f64, most: f64| {
            let fine = (least..=most).contains(&value);
            fine.then_some(()).ok_or_else(|| {
                Failure::usage(format!("{name} must be from {least} to {most}, not {value}"))
            })
        };
        within("islands (--n)", f64::from(self.islands), 1.0, f64::from(ISLANDS_MAX))?;
        within("population", self.population as f64, 2.0, POPULATION_MAX as f64)?;
        within("max-genes", self.max_genes as f64, 1.0, GENES_MAX as f64)?;
        within("genes", self.genes as f64, 1.0, self.max_genes as f64)?;
        within("max-links", self.max_links as f64, 1.0, LINKS_MAX as f64)?;
        within("robustness", f64::from(self.robustness), 0.0, f64::from(Robustness::TRIALS_MAX))?;
        within("elites", self.elites as f64, 0.0, self.population as f64 - 1.0)?;
        within("crossover-rate", self.crossover_rate, 0.0, 1.0)?;
        within("point-rate", self.point_rate, 0.0, 1.0)?;
        within("point-amount", self.point_amount, 0.0, 1.0)?;
        within("shrink-rate", self.shrink_rate, 0.0, 1.0)?;
        within("grow-rate", self.grow_rate, 0.0, 1.0)?;
        within("duplicate-rate", self.duplicate_rate, 0.0, 1.0)?;
        within("migration-interval", f64::from(self.migration_interval), 1.0, 1e9)?;
        within("migration-lag", f64::from(self.migration_lag), 0.0, 1e3)?;
        within("checkpoint-interval", f64::from(self.checkpoint_interval), 1.0, 1e9)?;
        within("clip-every", f64::from(self.clip_every.unwrap_or(1)), 1.0, 1e9)?;
        within("generations", f64::from(self.generations), 0.0, 1e9)?;
        let threads = self.threads.unwrap_or(1);
        within("threads", threads as f64, 1.0, THREADS_MAX as f64)
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
        Ok(())
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
    }
}
