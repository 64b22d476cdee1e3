//! Islands that die at the worst of times.

use super::super::shared_memory::SharedMemory;
use super::lives::{give_birth, hear, kill};
use super::*;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::collections::BTreeSet;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;

/// What two islands have in shared memory that exchange: each an event and three senders' memory, and a
/// connection for outboxes and one for requests, there and back.
const OBJECTS_OF_TWO: usize = 2 * (1 + 3) + 2 * 2;

fn objects(domain: &Domain) -> BTreeSet<PathBuf> {
    let objects = SharedMemory::own().objects(domain.run_id()).into_iter();
    objects.map(|object| object.path).collect()
}

/// Lets two islands be born, exchange and be killed; returns what they leave.
fn live_and_die(domain: &Domain, before: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
    let children = [0, 1].map(|island| give_birth(domain, island));
    let deadline = Instant::now() + Duration::from_secs(60);
    let is_open = |path: &PathBuf| fs::metadata(path).is_ok_and(|status| status.len() > 0);
    loop {
        let left: Vec<_> = objects(domain).difference(before).cloned().collect();
        if left.len() == OBJECTS_OF_TWO && left.iter().all(is_open) {
            children.into_iter().for_each(kill);
            return left;
        }
        assert!(Instant::now() < deadline, "they do not find each other: {left:?}");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn whatever_object_an_island_is_killed_over_its_place_becomes_free() {
    let (domain, _, service_host) = launch(15, 2);
    let before = objects(&domain);
    for victim in 0..=OBJECTS_OF_TWO {
        let left = live_and_die(&domain, &before);
        // At last, all of them.
        let victims = left.get(victim).map_or(&left[..], std::slice::from_ref);
        for path in victims {
            fs::File::create(path).unwrap();
        }
        assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 2, "over {victims:?}");
        assert_eq!(objects(&domain), before, "over {victims:?}");
    }
    live_and_die(&domain, &before);
}

#[test]
fn an_island_may_be_killed_at_any_instant() {
    let (domain, archipelago, service_host) = launch(16, 2);
    let exchange = Exchange::<TestGene>::open(&domain, &archipelago, 1).unwrap();
    let before = objects(&domain);
    let mut instants = ChaCha8Rng::seed_from_u64(16);
    for life in 0..60 {
        let child = give_birth(&domain, 0);
        let death = Instant::now() + Duration::from_micros(instants.random_range(0..40_000));
        while let Some(left) = death.checked_duration_since(Instant::now()) {
            exchange.wait(left.min(TICK)).unwrap();
            exchange.publish(&outbox(1, life)).unwrap();
            exchange.receive();
        }
        kill(child);
        assert!(service_host.cleanup_dead_nodes().unwrap() <= 1, "in life {life}");
        assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 0, "in life {life}");
        // A connection stays until what came through it is read.
        exchange.receive();
        exchange.wait(Duration::ZERO).unwrap();
        exchange.receive();
        assert_eq!(objects(&domain), before, "in life {life}");
    }
    let last = give_birth(&domain, 0);
    hear(&exchange);
    kill(last);
}

#[test]
fn what_was_only_begun_at_death_is_cleaned_up_too() {
    let (domain, _, service_host) = launch(18, 2);
    let before = objects(&domain);
    live_and_die(&domain, &before);
    let files = |folder: &Path| -> Vec<PathBuf> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let nodes = domain.root().join("nodes");
    let homes = files(&nodes).into_iter().filter(|path| path.is_dir());
    // The service host has no port.
    let tag = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "port_tag");
    let tags: Vec<_> = homes.filter_map(|home| files(&home).into_iter().find(tag)).collect();
    assert_eq!(tags.len(), 2);
    for tag in tags {
        // A tag is made empty, and becomes read-only when it is finished.
        let unfinished = tag.with_file_name(domain.prefix() + "1.port_tag");
        fs::write(&unfinished, []).unwrap();
        fs::set_permissions(&unfinished, PermissionsExt::from_mode(0o600)).unwrap();
        let port = tag.file_stem().unwrap().to_str().unwrap();
        let port = port.strip_prefix(&domain.prefix()).unwrap();
        for name in [format!("x_{port}.event_mgmt"), format!("x_7_{port}.connection")] {
            fs::write(Path::new("/dev/shm").join(domain.prefix() + &name), [1]).unwrap();
        }
    }
    assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 2);
    assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 0);
    assert_eq!(objects(&domain), before);
}
