//! Islands that die and are born again, and channels that lose.

use super::*;

const CHILD: &str = "ISLANDS_TEST_CHILD";
const CHILD_ISLAND: &str = "ISLANDS_TEST_CHILD_ISLAND";

/// Not a test but a process of others, which start it by this name.
#[test]
#[ignore = "other tests start it"]
fn child() {
    let [run_id, island] = [CHILD, CHILD_ISLAND].map(|name| std::env::var(name).unwrap());
    // A test that fails leaves nobody behind.
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL)).unwrap();
    let island = island.parse().unwrap();
    let exchange = Exchange::open(&run_id.parse().unwrap(), &archipelago(2), island).unwrap();
    for epoch in 0.. {
        exchange.publish(&outbox(island, epoch)).unwrap();
        exchange.receive();
        exchange.wait(TICK).unwrap();
    }
}

/// Starts a process that is one of two islands and exchanges until it is killed.
pub fn give_birth(domain: &Domain, island: u32) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["transport::tests::lives::child", "--exact", "--ignored"]).stdout(Stdio::null());
    command.env(CHILD, domain.to_string()).env(CHILD_ISLAND, island.to_string());
    command.spawn().unwrap()
}

/// Waits until the first epochs of island 0 have reached island 1. The third needs a neighbour that sees ports
/// that were opened after its own.
pub fn hear(exchange: &Exchange<TestGene>) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !epochs(exchange.receive()).contains(&2) {
        assert!(Instant::now() < deadline, "nothing came");
        exchange.publish(&outbox(1, 0)).unwrap();
        exchange.wait(TICK).unwrap();
    }
}

pub fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn an_island_that_is_killed_can_be_born_again_and_again() {
    let (domain, archipelago, service_host) = launch(14, 2);
    let exchange = Exchange::open(&domain, &archipelago, 1).unwrap();
    for life in 0..6 {
        let child = give_birth(&domain, 0);
        hear(&exchange);
        kill(child);
        assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 1, "in life {life}");
    }
    drop(exchange);
    service_host.close().unwrap();
    assert_eq!(remains(&domain), [""; 0]);
}

/// An island that does nothing but exchange, as the real one does it.
fn evolve(
    domain: &Domain,
    archipelago: &Archipelago,
    island: u32,
    ends: u32,
    loses: u32,
) -> Vec<u32> {
    let exchange = Exchange::<TestGene>::open(domain, archipelago, island).unwrap();
    let mut inbox = Inbox::new(archipelago.in_neighbours(island), 0);
    let mut taken = Vec::new();
    let mut published = 0;
    let mut quiet = 0;
    while taken.len() < ends as usize {
        let epoch = taken.len() as u32;
        // It may be two epochs ahead of what it has taken in.
        if published < ends.min(epoch + 2) {
            if published % loses != loses - 1 {
                exchange.publish(&outbox(island, published)).unwrap();
            }
            published += 1;
        }
        for outbox in exchange.receive().outboxes {
            inbox.accept(outbox);
        }
        if let Some(outboxes) = inbox.take(epoch) {
            let sources = archipelago.in_neighbours(island).into_iter();
            assert_eq!(outboxes, sources.map(|i| outbox(i, epoch)).collect::<Vec<_>>());
            taken.push(epoch);
            quiet = 0;
            continue;
        }
        quiet += 1;
        if quiet % 4 == 0 {
            inbox.missing(epoch).into_iter().for_each(|source| exchange.request(source, epoch));
        }
        answer(&exchange, island, published);
        exchange.wait(TICK).unwrap();
    }
    // Finished, but others may still need what it sent.
    for _ in 0..100 {
        answer(&exchange, island, published);
        exchange.wait(TICK).unwrap();
    }
    taken
}

fn answer(exchange: &Exchange<TestGene>, island: u32, published: u32) {
    for epoch in exchange.requests().map_or(0..0, |epoch| epoch..published) {
        exchange.publish(&outbox(island, epoch)).unwrap();
    }
}

#[test]
fn every_epoch_is_taken_exactly_once_though_every_seventh_outbox_is_lost() {
    let (domain, archipelago, _host) = launch(13, 3);
    let expected: Vec<u32> = (0..200).collect();
    std::thread::scope(|scope| {
        let sail = |island| {
            let (domain, archipelago) = (&domain, &archipelago);
            scope.spawn(move || evolve(domain, archipelago, island, 200, 7))
        };
        for island in [0, 1, 2].map(sail) {
            assert_eq!(island.join().unwrap(), expected);
        }
    });
}
