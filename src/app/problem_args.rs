//! The flags that say what is evolved.

use crate::runs::Failure;
use crate::runs::catalogue::{Kind, Wish};
use crate::runs::config::Config;
use clap::Args;

/// What is evolved.
#[derive(Debug, Clone, Copy, Args)]
pub struct ProblemArgs {
    /// What is evolved: creatures; points of a function (sphere, rastrigin, rosenbrock, ackley, schwefel,
    /// griewank); bits (onemax, trap, royal-road). All but creatures have other defaults than those said
    /// here: a run's run.toml says them [default: creatures]
    #[arg(long)]
    pub problem: Option<Kind>,
    /// Variables of a function, or bits (of onemax and trap 100, of royal-road 64) [default: 30]
    #[arg(long, value_name = "N")]
    pub dimensions: Option<usize>,
    /// Number of the shift and the rotation that a function has [default: 1]
    #[arg(long, value_name = "I")]
    pub instance: Option<u64>,
    /// Rotate the function, so that its variables depend on each other [default: false]
    #[arg(long, value_name = "BOOL", num_args = 0..=1, default_missing_value = "true", require_equals = true)]
    pub rotated: Option<bool>,
    /// Bits of a block of trap, or of royal-road (8) [default: 5]
    #[arg(long, value_name = "K")]
    pub block: Option<usize>,
}

impl ProblemArgs {
    /// What of them decides the defaults of all other settings.
    pub fn wish(&self) -> Wish {
        Wish { problem: self.problem, dimensions: self.dimensions, ..Wish::default() }
    }

    /// Lays the flags over a configuration.
    pub fn over(&self, config: Config) -> Config {
        Config {
            problem: self.problem.unwrap_or(config.problem),
            dimensions: self.dimensions.unwrap_or(config.dimensions),
            instance: self.instance.unwrap_or(config.instance),
            rotated: self.rotated.unwrap_or(config.rotated),
            block: self.block.unwrap_or(config.block),
            ..config
        }
    }

    /// Makes sure that no other problem is wished for than a run has, whose defaults would be other ones.
    ///
    /// # Errors
    /// If one is.
    pub fn require_same(&self, own: &Config) -> Result<(), Failure> {
        let wished = self.over(own.clone());
        let name = |config: &Config| match config.problem {
            Kind::Creatures => "creatures".to_owned(),
            other => format!("{other} of {}", config.dimensions),
        };
        if (wished.problem, wished.dimensions) == (own.problem, own.dimensions) {
            return Ok(());
        }
        Err(Failure::usage(format!(
            "a run cannot go on with another problem: it is {}, not {}; leave that out, or start a new run",
            name(own),
            name(&wished)
        )))
    }
}
