//! The largest values that may be asked for.

/// The most islands of a run.
pub const ISLANDS_MAX: u32 = 256;
/// The largest seed: what a TOML file can hold.
pub const SEED_MAX: u64 = i64::MAX as u64;
/// The most individuals of an island.
pub const POPULATION_MAX: usize = 100_000;
/// The longest genome that may be asked for, in genes.
pub const GENES_MAX: usize = 1_000;
/// The most genes that the genomes of an island may have together: its checkpoint must be readable.
pub const GENES_OF_ISLAND_MAX: usize = 5_000_000;
/// The largest body that may be asked for, in links.
pub const LINKS_MAX: usize = 512;
/// The most threads.
pub const THREADS_MAX: usize = 4_096;
