//! Every topology carries what it should.

use super::*;
use crate::archipelago::ExchangeMode;

/// Opens all islands of an archipelago at once, lets each send one outbox, and checks who got it.
fn exchange_all(test: u32, archipelago: &Archipelago) {
    let (domain, graph) = (domain(test), archipelago.graph());
    let service_host = ServiceHost::<TestGene>::create(&domain, archipelago).unwrap();
    let islands = 0..archipelago.islands;
    let open = |island| Exchange::open(&domain, archipelago, island).unwrap();
    let exchanges: Vec<Exchange<TestGene>> = islands.clone().map(open).collect();
    // Who was opened early learns of the others.
    for exchange in &exchanges {
        exchange.wait(Duration::ZERO).unwrap();
    }
    for (island, exchange) in islands.clone().zip(&exchanges) {
        let reached = exchange.publish(&outbox(island, 0)).unwrap();
        assert_eq!(reached, graph.out_neighbours(island).len(), "{}", archipelago.topology);
        graph.in_neighbours(island).iter().for_each(|&source| exchange.request(source, 3));
    }
    for (island, exchange) in islands.zip(&exchanges) {
        let received = exchange.receive();
        let sources: Vec<u32> = received.outboxes.iter().map(|outbox| outbox.island).collect();
        assert_eq!(sources, graph.in_neighbours(island), "{}", archipelago.topology);
        let asked = (!graph.out_neighbours(island).is_empty()).then_some(3);
        assert_eq!(exchange.requests(), asked, "{}", archipelago.topology);
    }
    drop(exchanges);
    service_host.close().unwrap();
    assert_eq!(remains(&domain), [""; 0]);
}

#[test]
fn every_topology_carries_each_outbox_to_whom_it_should_and_each_request_back() {
    for topology in Topology::ALL {
        exchange_all(40, &Archipelago { topology, ..archipelago(6) });
    }
}

#[test]
fn a_process_has_no_more_files_open_than_were_asked_for() {
    let archipelago = Archipelago { topology: Topology::Full, ..archipelago(12) };
    let domain = domain(41);
    let plan = Plan::new(&domain, &archipelago).unwrap();
    let service_host = ServiceHost::<TestGene>::create(&domain, &archipelago).unwrap();
    let open = |island| Exchange::<TestGene>::open(&domain, &archipelago, island).unwrap();
    let files = || fs::read_dir("/proc/self/fd").unwrap().count();
    let before = files();
    let exchanges: Vec<_> = (0..12).map(open).collect();
    for exchange in &exchanges {
        exchange.wait(Duration::ZERO).unwrap();
    }
    // Other tests have some open, too.
    let taken = files().saturating_sub(before) as u64 / 12;
    assert!(taken < plan.files(), "{taken} of {}", plan.files());
    assert!(2 * taken > plan.files() - 128, "{taken} of {}", plan.files());
    drop((exchanges, service_host));
}

#[test]
fn a_topology_with_more_edges_than_can_be_opened_is_refused() {
    let all = |islands| Archipelago { topology: Topology::Full, ..archipelago(islands) };
    assert!(Plan::new(&domain(42), &all(64)).is_ok());
    let error = Plan::new(&domain(42), &all(65)).unwrap_err().to_string();
    assert!(error.starts_with("the topology has 4160 edges, and 4032 is the most"), "{error}");
    for topology in Topology::ALL.into_iter().filter(|&t| t != Topology::Full) {
        assert!(Plan::new(&domain(42), &Archipelago { topology, ..archipelago(256) }).is_ok());
    }
}

#[test]
fn where_nobody_waits_the_newest_outboxes_push_older_ones_out() {
    let domain = domain(43);
    let mut archipelago = archipelago(2);
    archipelago.migration.exchange = ExchangeMode::Async;
    let _host = ServiceHost::<TestGene>::create(&domain, &archipelago).unwrap();
    let open = |island| Exchange::<TestGene>::open(&domain, &archipelago, island).unwrap();
    let [sender, reader] = [0, 1].map(open);
    sender.wait(Duration::ZERO).unwrap();
    for epoch in 0..30 {
        sender.publish(&outbox(0, epoch)).unwrap();
    }
    assert_eq!(epochs(reader.receive()).last(), Some(&29));
}
