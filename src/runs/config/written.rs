//! What the program writes into a configuration, and nobody says.

use serde::{Deserialize, Serialize};

/// What launched a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Launch {
    /// The version of the program.
    pub version: String,
    /// Names the run's shared memory, in hexadecimal; another one at each launch.
    pub run_id: String,
}

/// What a configuration says of the genomes that its run begins with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SeedGenomes {
    /// How many there are.
    pub count: usize,
    /// The BLAKE3 hash of the copy in the run's folder.
    pub digest: String,
}
