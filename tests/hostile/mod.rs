//! Files and messages of any content: none makes the program panic, ask for memory without bound, or write where
//! it should not.
//!
//! The suite tries a fixed set of inputs of each kind; `ISLANDS_FUZZ_ROUNDS=100000` makes it so many, and
//! `ISLANDS_FUZZ_CORPUS=tests/fuzz/corpus` leaves the sound ones for cargo-fuzz to begin with.

mod bodies;
mod files;
pub mod memory;
pub mod pieces;
mod restart;
mod seeds;
mod time;
mod wire;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;

/// The most memory that an input may cost: a fixed part, and so many times its own length.
const BYTES_MAX: i64 = 4 << 20;
const BYTES_PER_BYTE_MAX: i64 = 64;

/// Who refuses everything proves nothing: of the damaged inputs, at least one of so many is accepted.
const ACCEPTED_OF: u32 = 200;

/// What is tried: whether an input was accepted.
type Body = fn(&[u8]) -> bool;

/// Tries sound inputs, damaged ones and noise. `rounds` says how many, unless the environment does. Some are accepted.
fn attack(name: &str, body: Body, sound: &[Vec<u8>], rounds: u32) {
    if let Some(corpus) = std::env::var_os("ISLANDS_FUZZ_CORPUS") {
        plant(&Path::new(&corpus).join(name), sound);
    }
    let wish = std::env::var("ISLANDS_FUZZ_ROUNDS").ok();
    let rounds = wish.map_or(rounds, |rounds| rounds.parse().expect("it is a number"));
    let mut rng = ChaCha8Rng::seed_from_u64(41);
    let sound_ones = sound.iter().filter(|input| survive(body, input)).count();
    assert!(2 * sound_ones >= sound.len(), "{sound_ones} of {} sound ones", sound.len());
    let mut accepted = 0;
    for round in 0..rounds as usize {
        let damaged = seeds::damage(&sound[round % sound.len()], &mut rng);
        accepted += u32::from(survive(body, &damaged));
        if round % 8 == 0 {
            survive(body, &seeds::noise(&mut rng));
        }
    }
    assert!(accepted * ACCEPTED_OF >= rounds, "only {accepted} of {rounds} were accepted");
}

/// Leaves inputs for cargo-fuzz to begin with.
fn plant(folder: &Path, inputs: &[Vec<u8>]) {
    fs::create_dir_all(folder).unwrap();
    for (i, input) in inputs.iter().enumerate() {
        fs::write(folder.join(format!("sound-{i}")), input).unwrap();
    }
}

fn survive(body: Body, input: &[u8]) -> bool {
    let mut ended = Ok(false);
    let most = memory::peak_of(|| ended = catch_unwind(AssertUnwindSafe(|| body(input))));
    let accepted = ended.unwrap_or_else(|panic| {
        eprintln!("the input is {}", input.escape_ascii());
        resume_unwind(panic)
    });
    let bound = BYTES_MAX + BYTES_PER_BYTE_MAX * input.len() as i64;
    assert!(most <= bound, "{most} bytes of memory for {}", input.escape_ascii());
    accepted
}

#[test]
fn any_checkpoint_is_refused_or_read_back_to_the_same_bytes() {
    attack("checkpoint", bodies::checkpoint, &seeds::checkpoints(), 20_000);
}

#[test]
fn any_log_is_read_the_same_in_every_way() {
    attack("record_logs", bodies::record_logs, &seeds::logs(), 2_000);
}

#[test]
fn any_genome_file_is_refused_in_a_sentence_or_valid() {
    attack("genome_csv", bodies::genome_csv, &seeds::genomes(), 10_000);
}

#[test]
fn any_urdf_is_refused_in_a_sentence_or_a_body_that_can_be_written_and_simulated() {
    attack("urdf", bodies::urdf, &seeds::urdfs(), 4_000);
}

#[test]
fn any_configuration_is_refused_in_a_sentence_or_can_be_run_and_written() {
    attack("config", bodies::config, &seeds::configs(), 4_000);
}

#[test]
fn any_run_directory_is_refused_or_leads_to_an_island_that_can_evolve() {
    attack("logbook", bodies::logbook, &seeds::run_dirs(), 2_000);
}

#[test]
fn any_metrics_are_refused_or_written_back_as_they_were_read() {
    attack("metrics_csv", bodies::metrics_csv, &seeds::tables(), 4_000);
}

#[test]
fn any_outbox_from_shared_memory_is_rejected_or_sound() {
    attack("outbox", bodies::outbox, &seeds::outboxes(), 20_000);
}

#[test]
fn any_report_from_shared_memory_is_rejected_or_sound() {
    attack("report", bodies::report, &seeds::reports(), 20_000);
}
