//! The command line of an experiment.

use clap::Args;
use std::path::PathBuf;

/// Comparing settings.
#[derive(Debug, Args)]
#[command(after_help = "The file says what is compared:

  seeds = 10               # 1 to 10; or a list such as [3, 5, 8], or \"11-20\"
  evaluations = 10000      # a run ends when all its islands together have so many
  target = 2.5             # a run is a success if its best fitness gets so far

  [base]                   # what all settings have in common: the settings of a run.toml
  task = \"walk\"
  population = 24

  [grid]                   # every combination is a setting, such as elites=2,selection=rank
  elites = [1, 2]
  selection = [\"tournament:3\", \"rank\"]

  [[setting]]              # beside a grid or instead of one: settings with a name
  name = \"panmictic\"
  islands = 1
  population = 96

With a grid and named settings, every named setting is run at every point of the grid. A run ends
with the first generation by which it has its evaluations, or after its generations. Only
evaluations that were really run are counted.

Every run is the one that `islands run` makes of the same settings, seed and generations, and has
its digest. Finished runs are kept: the same command goes on after Ctrl-C, and after a change of
the file it runs only what is missing.

The folder gets runs.csv (a row for each run), curves.csv (a row for each run and generation),
summary.csv (quartiles, successes), comparisons.csv (Mann-Whitney U, p, p after Holm, effect size
A12), and for people summary.md and convergence.svg.

Exit codes: 0 done, 1 failed, 2 the file makes no sense, 130 interrupted.

Examples:
  islands experiment elites.toml                   into experiments/elites
  islands experiment elites.toml --threads 2 --json | tail -n 1 | jq .comparisons")]
pub struct ExperimentArgs {
    /// The file that says what is compared
    #[arg(value_name = "FILE.toml")]
    pub file: PathBuf,
    /// Folder for the results, new or of this experiment [default: experiments/<name of the file>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Runs at a time, each on a thread of its own; the results do not depend on it [default: all cores]
    #[arg(long, value_name = "T")]
    pub threads: Option<usize>,
    /// Show no progress
    #[arg(long)]
    pub quiet: bool,
    /// Print the result as one JSON object, the last line of standard output
    #[arg(long)]
    pub json: bool,
}
