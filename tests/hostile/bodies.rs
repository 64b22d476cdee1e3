//! What must hold of any bytes whatever, a function a kind of input. The suite feeds them seeded inputs,
//! `tests/fuzz` whatever finds new ways through the program. Each says whether the input was accepted: where all of them
//! are refused, nothing was tried.

use super::pieces::{self, Sum, archipelago};
use super::wire;
use islands::archipelago::arrivals::check_record;
use islands::archipelago::{Arrivals, Births, Champion, Outbox, island};
use islands::creature::{Course, Gene, Profile, express};
use islands::evolution::{self, Individual};
use islands::formats::{genome_csv, metrics, urdf};
use islands::problems::Task;
use islands::runs::config::Config;
use islands::simulation::Trial;
use islands::simulation::assembly::Assembly;
use islands::store::{Entry, Logbook, RecordLog, RunDir, Tail, checkpoint};
use islands::transport::Limits;
use serde::{Serialize, de::DeserializeOwned};
use std::fs;
use std::path::Path;

/// A checkpoint: the data is the file, and what the file's checksum makes look whole.
pub fn checkpoint(data: &[u8]) -> bool {
    let path = Path::new("any.ckpt");
    let mut accepted = false;
    for bytes in [data, &pieces::sealed_checkpoint(data)] {
        let Ok(found) = checkpoint::from_bytes::<Gene>(bytes, path) else { continue };
        let again = checkpoint::to_bytes(&found);
        assert_eq!(again.len(), bytes.len());
        // No fitness is NaN, but a gene may be: bytes are compared.
        let found = checkpoint::from_bytes::<Gene>(&again, path).expect("we wrote it");
        assert_eq!(checkpoint::to_bytes(&found), again);
        accepted = true;
    }
    accepted
}

/// The logs of an island: the data is the file, and a record of each log.
pub fn record_logs(data: &[u8]) -> bool {
    let folder = pieces::folder();
    let mut accepted = false;
    for bytes in [data, &pieces::sealed_records(data)] {
        let path = folder.path().join("log");
        fs::write(&path, bytes).expect("it is writable");
        accepted |= is_sound::<Champion<Gene>>(&path).1;
        accepted |= is_sound::<Outbox<Gene>>(&path).1;
        accepted |= is_sound::<Births>(&path).1;
        accepted |= is_sound::<Arrivals>(&path).1;
        if let Ok(contents) = RecordLog::<Arrivals>::read(&path)
            && let Err(reason) = check_record(&contents.records, &archipelago(), 0)
        {
            is_one_sentence(&reason);
        }
        // The last cuts off what is torn.
        let (whole, is_log) = is_sound::<Entry>(&path);
        accepted |= is_log;
        let left = fs::read(&path).expect("it is there");
        assert!(bytes.starts_with(&left));
        let log = RecordLog::<Entry>::open(&path).expect("it is a file");
        assert_eq!(log.len(), whole);
        drop(log);
        let contents = RecordLog::<Entry>::read(&path);
        for Entry { report, seconds } in contents.into_iter().flat_map(|it| it.records) {
            let row = metrics::Row::new(&report, seconds);
            assert!(row.failures <= row.evaluations);
        }
    }
    accepted
}

/// Reads the log in every way, which must agree; how many records it has, and whether there are some and all can be read.
fn is_sound<T: Serialize + DeserializeOwned>(path: &Path) -> (usize, bool) {
    let contents = RecordLog::<T>::read(path);
    let mut tail = Tail::<T>::of(path);
    let mut followed = 0;
    while let Ok(Some(_)) = tail.next_record() {
        followed += 1;
    }
    let log = RecordLog::<T>::open(path).expect("it is a file");
    let last = log.last_that(|_| true);
    match contents {
        Ok(ref contents) => {
            assert_eq!((contents.records.len(), followed), (log.len(), log.len()));
            assert_eq!(last.expect("all are whole").is_some(), !log.is_empty());
        }
        Err(_) => assert!(followed < log.len()),
    }
    (log.len(), contents.is_ok() && !log.is_empty())
}

/// A genome.
pub fn genome_csv(data: &[u8]) -> bool {
    let read = match genome_csv::read(&Course::DEFAULT, data) {
        Ok(read) => read,
        Err(error) => return refused(&error.to_string()),
    };
    assert!(is_valid(&read.genome));
    let mut written = Vec::new();
    genome_csv::write(&read.genome, &mut written).expect("memory takes everything");
    let again = genome_csv::read(&Course::DEFAULT, written.as_slice()).expect("we wrote it");
    assert_eq!(bits(&again.genome), bits(&read.genome));
    assert_eq!(again.clamped, []);
    for profile in Profile::ALL {
        let creature = express(&read.genome, profile, 16);
        assert!(creature.is_ok_and(|it| it.morphology.links.len() <= 16) || !profile.is_cut());
    }
    true
}

/// A body.
pub fn urdf(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    let creature = match urdf::read(text) {
        Ok(body) => body.creature,
        Err(error) => return refused(&error.to_string()),
    };
    let mut written = Vec::new();
    urdf::write(&creature.morphology, &creature.controller, "it", &mut written)
        .expect("memory takes everything");
    let again = urdf::read(str::from_utf8(&written).expect("it is text"));
    let links = &creature.morphology.links;
    // What is as large as a file may say, added up, is more than one may say.
    if creature.morphology.extent_m() < 1e6 && links.iter().all(|link| link.mass_kg < 1e6) {
        assert_eq!(again.expect("we wrote it").creature.morphology.links.len(), links.len());
    }
    let trial = Trial { scored_s: 0.0, settle_s: 0.0, ..Task::Course.trial() };
    let assembly = Assembly::new(&creature, &trial);
    assert!(assembly.parts.iter().all(|part| part.mass_kg > 0.0));
    true
}

fn bits(genome: &[Gene]) -> Vec<u64> {
    genome.iter().flat_map(|gene| gene.0.map(f64::to_bits)).collect()
}

fn is_valid(genome: &[Gene]) -> bool {
    !genome.is_empty() && genome.iter().all(evolution::Gene::is_valid)
}

/// What is refused is refused in a sentence.
fn refused(message: &str) -> bool {
    is_one_sentence(message);
    false
}

fn is_one_sentence(message: &str) {
    let is_short = message.len() < 2_000 && !message.contains(char::is_control);
    assert!(is_short && !message.is_empty(), "{message:?}");
}

/// A configuration.
pub fn config(data: &[u8]) -> bool {
    let folder = pieces::folder();
    let path = folder.path().join("run.toml");
    fs::write(&path, data).expect("it is writable");
    let config = match Config::read(&path) {
        Ok(config) => config,
        Err(failure) => return refused(&failure.message),
    };
    if let Err(failure) = config.check() {
        return refused(&failure.message);
    }
    fs::write(&path, config.to_toml()).expect("it is writable");
    assert_eq!(Config::read(&path).as_ref(), Ok(&config));
    assert!(!config.settings().is_empty());
    let archipelago = config.archipelago();
    assert!(archipelago.in_neighbours(0).iter().all(|&island| island < archipelago.islands));
    for generation in [0, 1, config.generations] {
        let _ = archipelago.migration.immigration(generation);
        let _ = archipelago.migration.emigration(generation);
    }
    let Course { genes, links_max, .. } = config.locomotion().encoding;
    assert!((1..=config.max_genes).contains(&genes) && links_max >= 1);
    true
}

/// The metrics of a run.
pub fn metrics_csv(data: &[u8]) -> bool {
    let Ok(rows) = metrics::read(data) else { return false };
    let mut written = Vec::new();
    metrics::write(rows.into_iter().map(Ok), true, &mut written).expect("memory takes everything");
    let again = metrics::read(written.as_slice()).expect("we wrote it");
    let mut twice = Vec::new();
    metrics::write(again.into_iter().map(Ok), true, &mut twice).expect("memory takes everything");
    assert_eq!(written, twice);
    true
}

/// A run directory, made of the data as [`pieces::lay_out`] says: an island either goes on from it, which is to accept it,
/// or begins anew.
pub fn logbook(data: &[u8]) -> bool {
    let folder = pieces::folder();
    let dir = RunDir::at(folder.path().join("run"));
    let claim = dir.create().expect("it is new");
    claim.make_folders(2).expect("the folder is writable");
    pieces::lay_out(&dir, data);
    let opened = Logbook::<Gene>::open(&dir, &archipelago(), 0, pieces::SETTINGS);
    drop(claim);
    let restored = match opened {
        Ok(restored) => restored,
        Err(error) => return refused(&error.to_string()),
    };
    restored.warnings.iter().for_each(|warning| is_one_sentence(warning));
    for epoch in 0..restored.logbook.epochs() {
        let _ = restored.logbook.outbox(epoch);
    }
    let Some(island) = restored.island else { return false };
    assert_eq!(island.population.len(), archipelago().strategy.population);
    assert!(island.population.iter().all(|one| is_valid(&one.genome)));
    let next = island::step(island, &[], &Sum, &archipelago());
    let _ = next.island.effort.failures();
    true
}

/// An outbox from shared memory: header and payload.
pub fn outbox(data: &[u8]) -> bool {
    let ((header, genes), limits) = (wire::batch(data), limits());
    let Ok(outbox) = limits.outbox(header.island, header, &genes) else { return false };
    assert!(outbox.island < limits.islands && outbox.migrants.len() <= limits.migrants);
    outbox.migrants.iter().for_each(|migrant| is_sound_individual(migrant, &limits));
    let again = limits.batch(&outbox).expect("what may arrive may be sent");
    assert_eq!(limits.outbox(header.island, again, &genes), Ok(outbox));
    true
}

/// A report from shared memory: header and payload.
pub fn report(data: &[u8]) -> bool {
    let ((header, genes), limits) = (wire::report(data), limits());
    let Ok(sighting) = limits.sighting(header, &genes) else { return false };
    let champion = sighting.champion.as_ref();
    champion.into_iter().for_each(|champion| is_sound_individual(&champion.individual, &limits));
    let effort = sighting.report.effort;
    assert!(sighting.seconds.is_finite() && effort.failures() <= effort.evaluations);
    let again = limits.report(&sighting.report, sighting.seconds, champion);
    let again = again.expect("what may arrive may be sent");
    assert_eq!(limits.sighting(again, &genes), Ok(sighting));
    true
}

fn limits() -> Limits {
    Limits::of(pieces::RUN_ID, &archipelago())
}

fn is_sound_individual(one: &Individual<Gene>, limits: &Limits) {
    assert!(is_valid(&one.genome) && one.genome.len() <= limits.genes_max);
    assert!(one.parents.iter().flatten().chain([&one.id]).all(|id| id.island < limits.islands));
    assert!(!one.fitness.get().is_nan());
}
