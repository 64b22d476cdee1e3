//! Real services, each test in a domain of its own.

mod claims;
mod deaths;
mod graphs;
mod lives;

use super::ports;
use super::services::{self, Plan};
use super::wire::{BatchHeader, NOBODY, ReportHeader, ResendRequest, WireGene};
use super::*;
use crate::archipelago::{Archipelago, Champion, Inbox, Migration, Outbox, Report, Topology};
use crate::evolution::generation::Effort;
use crate::evolution::{
    Fitness, Gene, Id, Individual, Selection, Spread, Statistics, Strategy, Variation,
};
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(transparent)]
struct TestGene(f64);

impl Gene for TestGene {
    const WIRE_NAME: &'static str = "islands.TestGene.v1";

    fn is_valid(&self) -> bool {
        self.0.is_finite()
    }
}

const GENES_MAX: usize = 5;
const MIGRANTS: usize = 3;

fn archipelago(islands: u32) -> Archipelago {
    Archipelago {
        islands,
        seed: 1,
        topology: Topology::Ring,
        migration: Migration { interval: 1, migrants: MIGRANTS, lag: 1, ..Migration::default() },
        strategy: Strategy {
            population: 4,
            elites: 1,
            selection: Selection::Tournament { size: 2 },
            variation: Variation {
                crossover_rate: 0.5,
                point_rate: 0.1,
                point_amount: 0.1,
                shrink_rate: 0.1,
                grow_rate: 0.1,
                genes_max: GENES_MAX,
                ..Variation::default()
            },
            ..Strategy::default()
        },
    }
}

/// A domain that no other test and no other run of the tests has.
fn domain(test: u32) -> Domain {
    Domain::new(u64::from(test) << 32 | u64::from(std::process::id()))
}

fn launch(test: u32, islands: u32) -> (Domain, Archipelago, ServiceHost<TestGene>) {
    let (domain, archipelago) = (domain(test), archipelago(islands));
    let service_host = ServiceHost::create(&domain, &archipelago).unwrap();
    (domain, archipelago, service_host)
}

fn individual(island: u32, epoch: u32, index: u32) -> Individual<TestGene> {
    let id = Id { island, generation: epoch, index };
    let parent = (index > 0).then_some(Id { index: index - 1, ..id });
    let length = 1 + (epoch + index) as usize % GENES_MAX;
    let gene = |i| TestGene(-0.1 * f64::from(i + 100 * index + 10_000 * epoch));
    Individual {
        id,
        parents: [parent, None],
        origin: 0,
        genome: (0..length as u32).map(gene).collect(),
        fitness: if index == 2 { Fitness::WORST } else { Fitness::new(f64::from(epoch) / 3.0) },
    }
}

fn outbox(island: u32, epoch: u32) -> Outbox<TestGene> {
    let migrants = (0..MIGRANTS as u32).map(|index| individual(island, epoch, index)).collect();
    Outbox { island, epoch, migrants }
}

fn report(island: u32, generation: u32) -> Report {
    let [best, mean, median] = [3.0, 1.5, f64::NEG_INFINITY].map(Fitness::new);
    Report {
        island,
        generation,
        statistics: Statistics {
            best,
            mean,
            median,
            diversity: 0.25,
            phenotype_diversity: 0.125,
            spread: Spread::of(&[1.5, 3.0]),
        },
        effort: Effort { evaluations: 9, reused: 2, outcomes: [3, 1, 1, 1, 1, 1, 1].into() },
        immigrants: 2,
        species: 4,
    }
}

fn epochs(received: Received<TestGene>) -> Vec<u32> {
    assert_eq!(received.rejected, []);
    received.outboxes.iter().map(|outbox| outbox.epoch).collect()
}

/// What is in shared memory and in the file system of a run.
fn remains(domain: &Domain) -> Vec<String> {
    let names = fs::read_dir("/dev/shm").unwrap().map(|entry| entry.unwrap().file_name());
    let names = names.map(|name| name.into_string().unwrap());
    let root = domain.root().exists().then(|| domain.root().display().to_string());
    names.filter(|name| name.starts_with(&domain.prefix())).chain(root).collect()
}

#[test]
fn outboxes_arrive_with_the_same_bits() {
    let (domain, archipelago, _host) = launch(1, 2);
    let sender = Exchange::open(&domain, &archipelago, 0).unwrap();
    let receiver = Exchange::open(&domain, &archipelago, 1).unwrap();
    let nobody = Outbox { migrants: Vec::new(), ..outbox(0, 2) };
    for sent in [outbox(0, 0), outbox(0, 1), nobody] {
        assert_eq!(sender.publish(&sent).unwrap(), 1);
        assert!(receiver.wait(Duration::from_secs(1)).unwrap(), "it is woken up");
        assert_eq!(receiver.receive(), Received { outboxes: vec![sent], rejected: vec![] });
    }
    assert!(!receiver.wait(Duration::ZERO).unwrap());
    assert_eq!(epochs(sender.receive()), [0; 0], "nobody hears himself");
}

#[test]
fn who_opens_late_gets_what_was_sent_before() {
    let (domain, archipelago, _host) = launch(2, 2);
    let sender = Exchange::open(&domain, &archipelago, 0).unwrap();
    for epoch in 0..3 {
        assert_eq!(sender.publish(&outbox(0, epoch)).unwrap(), 0);
    }
    let receiver = Exchange::<TestGene>::open(&domain, &archipelago, 1).unwrap();
    sender.wait(Duration::ZERO).unwrap();
    assert_eq!(epochs(receiver.receive()), [0, 1, 2]);
}

#[test]
fn a_reader_that_is_full_holds_nobody_up_and_gets_the_rest_when_it_asks() {
    let (domain, archipelago, _host) = launch(3, 2);
    let sender = Exchange::open(&domain, &archipelago, 0).unwrap();
    let receiver = Exchange::<TestGene>::open(&domain, &archipelago, 1).unwrap();
    let room = 2 * Plan::new(&domain, &archipelago).unwrap().history as u32;
    let reached = |epoch| sender.publish(&outbox(0, epoch)).unwrap();
    assert_eq!((0..room + 50).map(reached).sum::<usize>(), room as usize);
    assert_eq!(epochs(receiver.receive()), (0..room).collect::<Vec<_>>());

    receiver.request(0, room + 7);
    receiver.request(0, room);
    receiver.request(1, 3);
    assert!(sender.wait(Duration::from_secs(1)).unwrap());
    assert_eq!(sender.requests(), Some(room));
    assert_eq!(sender.requests(), None);
    assert_eq!(receiver.requests(), None);
    assert_eq!((room..room + 3).map(reached).sum::<usize>(), 3);
    assert_eq!(epochs(receiver.receive()), [room, room + 1, room + 2]);
}

#[test]
fn requests_that_cannot_be_meant_are_ignored() {
    let (domain, archipelago, _host) = launch(4, 3);
    let asked = Exchange::<TestGene>::open(&domain, &archipelago, 0).unwrap();
    let plan = Plan::new(&domain, &archipelago).unwrap();
    let node = services::join(&domain).unwrap();
    let asker = ports::request_outlet(&plan, &node, 0).unwrap();
    let request = ResendRequest { run_id: domain.run_id(), asker: 1, epoch: 5 };
    asker.send_copy(ResendRequest { run_id: 0, epoch: 1, ..request }).unwrap();
    asker.send_copy(ResendRequest { asker: 2, epoch: 2, ..request }).unwrap();
    asker.send_copy(request).unwrap();
    assert_eq!(asked.requests(), Some(5));
}

#[test]
fn reports_arrive_with_and_without_a_champion() {
    let (domain, archipelago, _host) = launch(5, 2);
    let report_reader = ReportReader::<TestGene>::open(&domain, &archipelago).unwrap();
    let exchange = Exchange::open(&domain, &archipelago, 1).unwrap();
    let validated = Some(Fitness::new(0.25));
    let champion = Champion { generation: 7, individual: individual(0, 3, 1), validated };
    exchange.report(&report(1, 7), 0.5, Some(&champion)).unwrap();
    exchange.report(&report(1, 8), 0.25, None).unwrap();
    let first = Sighting { report: report(1, 7), seconds: 0.5, champion: Some(champion) };
    let second = Sighting { report: report(1, 8), seconds: 0.25, champion: None };
    assert_eq!(report_reader.receive(), [first, second]);
    assert_eq!(report_reader.receive(), []);
}

#[test]
fn who_does_not_look_misses_the_oldest_reports_and_holds_nobody_up() {
    let (domain, archipelago, _host) = launch(6, 1);
    let report_reader = ReportReader::<TestGene>::open(&domain, &archipelago).unwrap();
    let exchange = Exchange::<TestGene>::open(&domain, &archipelago, 0).unwrap();
    for generation in 0..1_000 {
        exchange.report(&report(0, generation), 0.0, None).unwrap();
    }
    let seen: Vec<u32> = report_reader.receive().iter().map(|s| s.report.generation).collect();
    assert!(!seen.is_empty() && seen == (1_000 - seen.len() as u32..1_000).collect::<Vec<_>>());

    let late = ReportReader::<TestGene>::open(&domain, &archipelago).unwrap();
    exchange.wait(Duration::ZERO).unwrap();
    let seen = late.receive();
    assert_eq!(seen.last().unwrap().report.generation, 999, "who comes late sees where it is");
}

fn limits() -> Limits {
    Limits::of(7, &archipelago(4))
}

fn sample() -> (BatchHeader, Vec<WireGene<TestGene>>) {
    let outbox = outbox(1, 6);
    let genes = outbox.migrants.iter().flat_map(|m| &m.genome).map(|&g| WireGene(g)).collect();
    (limits().batch(&outbox).unwrap(), genes)
}

#[test]
fn every_malformed_outbox_is_rejected() {
    let (header, genes) = sample();
    assert_eq!(limits().outbox(1, header, &genes).unwrap(), outbox(1, 6));
    let spoilt = |spoil: &dyn Fn(&mut BatchHeader, &mut Vec<WireGene<TestGene>>)| {
        let (mut header, mut genes) = sample();
        spoil(&mut header, &mut genes);
        limits().outbox(1, header, &genes).unwrap_err()
    };
    assert_eq!(spoilt(&|h, _| h.run_id = 8), Rejection::Run);
    assert_eq!(spoilt(&|h, _| h.island = 2), Rejection::Island);
    assert_eq!(spoilt(&|h, _| h.count = MIGRANTS as u32 + 1), Rejection::Count);
    assert_eq!(spoilt(&|h, _| h.count = u32::MAX), Rejection::Count);
    assert_eq!(spoilt(&|h, _| h.count = 2), Rejection::Length);
    assert_eq!(spoilt(&|h, _| h.migrants[0].gene_count = 0), Rejection::Length);
    assert_eq!(spoilt(&|h, _| h.migrants[0].gene_count += 1), Rejection::Length);
    assert_eq!(spoilt(&|h, _| h.migrants[2].gene_count = GENES_MAX as u32 + 1), Rejection::Length);
    assert_eq!(spoilt(&|h, _| h.migrants[2].gene_count = u32::MAX), Rejection::Length);
    assert_eq!(spoilt(&|_, g| g.truncate(1)), Rejection::Length);
    assert_eq!(spoilt(&|_, g| g.push(g[0])), Rejection::Length);
    assert_eq!(spoilt(&|_, g| g[3] = WireGene(TestGene(f64::NAN))), Rejection::Gene);
    assert_eq!(spoilt(&|h, _| h.migrants[1].fitness = f64::NAN), Rejection::Number);
    assert_eq!(spoilt(&|h, _| h.migrants[1].fitness = f64::INFINITY), Rejection::Number);
    assert_eq!(spoilt(&|h, _| h.migrants[1].id[0] = 4), Rejection::Lineage);
    assert_eq!(spoilt(&|h, _| h.migrants[1].id = NOBODY), Rejection::Lineage);
    assert_eq!(spoilt(&|h, _| h.migrants[1].parents[0][0] = u32::MAX), Rejection::Lineage);
    assert_eq!(
        limits().outbox(4, BatchHeader { island: 4, ..header }, &genes),
        Err(Rejection::Island)
    );
}

#[test]
fn every_malformed_report_is_rejected() {
    let champion = Champion { generation: 6, individual: individual(1, 6, 1), validated: None };
    let genes: Vec<_> = champion.individual.genome.iter().map(|&gene| WireGene(gene)).collect();
    let header = limits().report(&report(1, 6), 0.5, Some(&champion)).unwrap();
    assert!(limits().sighting(header, &genes).is_ok());
    let spoilt = |header: ReportHeader| limits().sighting(header, &genes).unwrap_err();
    assert_eq!(spoilt(ReportHeader { run_id: 8, ..header }), Rejection::Run);
    assert_eq!(spoilt(ReportHeader { island: 4, ..header }), Rejection::Island);
    assert_eq!(spoilt(ReportHeader { has_champion: 0, ..header }), Rejection::Length);
    assert_eq!(spoilt(ReportHeader { has_champion: 2, ..header }), Rejection::Count);
    assert_eq!(spoilt(ReportHeader { seconds: -1.0, ..header }), Rejection::Number);
    assert_eq!(spoilt(ReportHeader { best: f64::NAN, ..header }), Rejection::Number);
    assert_eq!(spoilt(ReportHeader { diversity: f64::NAN, ..header }), Rejection::Number);
    assert_eq!(spoilt(ReportHeader { evaluations: 8, ..header }), Rejection::Number);
    assert_eq!(spoilt(ReportHeader { outcomes: [u64::MAX; 7], ..header }), Rejection::Number);
}

#[test]
fn a_malformed_outbox_in_shared_memory_is_rejected_and_does_not_harm_the_next() {
    let (domain, archipelago, _host) = launch(7, 2);
    let receiver = Exchange::<TestGene>::open(&domain, &archipelago, 1).unwrap();
    let plan = Plan::new(&domain, &archipelago).unwrap();
    let node = services::join(&domain).unwrap();
    let outlet = ports::outbox_outlet::<TestGene>(&plan, &node, 0).unwrap();
    let genes = outbox(0, 0).migrants.into_iter().flat_map(|migrant| migrant.genome);
    let genes: Vec<TestGene> = genes.collect();
    let good = plan.limits.batch(&outbox(0, 0)).unwrap();
    for header in [BatchHeader { count: 99, ..good }, good] {
        ports::send(&outlet, header, genes.len(), genes.iter()).unwrap();
    }
    let received = receiver.receive();
    assert_eq!(
        received,
        Received { outboxes: vec![outbox(0, 0)], rejected: vec![(0, Rejection::Count)] }
    );
}

#[test]
fn what_breaks_the_limits_is_not_sent() {
    let (domain, archipelago, _host) = launch(8, 2);
    let exchange = Exchange::open(&domain, &archipelago, 0).unwrap();
    let refused = |outbox: Outbox<TestGene>| exchange.publish(&outbox).unwrap_err().to_string();
    assert!(refused(outbox(1, 0)).contains("island"));
    let mut crowded = outbox(0, 0);
    crowded.migrants.extend(outbox(0, 0).migrants);
    assert!(refused(crowded).contains("migrants"));
    let mut long = outbox(0, 0);
    long.migrants[0].genome = vec![TestGene(0.0); GENES_MAX + 1];
    assert!(refused(long).contains("too long"));

    let migration = Migration { migrants: 33, ..archipelago.migration };
    let crowded = Archipelago { migration, ..archipelago };
    let error = Exchange::<TestGene>::open(&domain, &crowded, 0).unwrap_err().to_string();
    assert_eq!(error, "33 migrants do not fit in one outbox: take 32 at most");
}

#[test]
fn without_a_launcher_nothing_opens_and_the_error_says_so() {
    let (domain, archipelago) = (domain(9), archipelago(2));
    let error = Exchange::<TestGene>::open(&domain, &archipelago, 0).unwrap_err().to_string();
    assert!(error.contains("launcher is running"), "{error}");
    assert_eq!(remains(&domain), [""; 0]);
}

#[test]
fn a_harbour_leaves_nothing_behind() {
    let (domain, archipelago, service_host) = launch(10, 3);
    let exchange = Exchange::open(&domain, &archipelago, 0).unwrap();
    exchange.publish(&outbox(0, 0)).unwrap();
    assert!(remains(&domain).len() > 3);
    let again = ServiceHost::<TestGene>::create(&domain, &archipelago).unwrap_err().to_string();
    assert!(again.contains("File exists"), "{again}");
    assert_eq!(service_host.cleanup_dead_nodes().unwrap(), 0, "nobody is dead");
    drop(exchange);
    service_host.close().unwrap();
    assert_eq!(remains(&domain), [""; 0]);
    drop(ServiceHost::<TestGene>::create(&domain, &archipelago).unwrap());
    assert_eq!(remains(&domain), [""; 0]);
}

#[test]
fn folder_and_objects_are_for_this_user_only() {
    use std::os::unix::fs::PermissionsExt;
    let (domain, archipelago, _host) = launch(11, 2);
    let exchange = |island| Exchange::<TestGene>::open(&domain, &archipelago, island).unwrap();
    let exchanges = [0, 1].map(exchange);
    exchanges[0].wait(Duration::ZERO).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!(mode(domain.root()), 0o700);
    let names = remains(&domain).into_iter().filter(|name| !name.starts_with('/'));
    let modes: Vec<_> = names.map(|name| mode(&Path::new("/dev/shm").join(name))).collect();
    assert!(modes.len() > 10 && modes.iter().all(|&mode| mode == 0o600), "{modes:?}");
}

#[test]
fn an_island_knows_how_much_to_publish_again() {
    let (domain, archipelago, _host) = launch(17, 3);
    let exchange = Exchange::<TestGene>::open(&domain, &archipelago, 0).unwrap();
    // Both others may be two epochs ahead; and two more.
    assert_eq!(exchange.history(), 6);
}

#[test]
fn a_run_takes_no_more_shared_memory_than_was_asked_for() {
    let (domain, archipelago, _host) = launch(12, 3);
    let report_reader = ReportReader::<TestGene>::open(&domain, &archipelago).unwrap();
    let exchange = |island| Exchange::<TestGene>::open(&domain, &archipelago, island).unwrap();
    let exchanges: Vec<_> = (0..3).map(exchange).collect();
    let size = |name| fs::metadata(format!("/dev/shm/{name}")).map_or(0, |status| status.len());
    let taken: u64 = remains(&domain).into_iter().map(size).sum();
    let asked = ServiceHost::<TestGene>::bytes_needed(&domain, &archipelago).unwrap();
    assert!(taken > 0 && 2 * taken <= asked, "{taken} of {asked} bytes, without any successor");
    assert!(asked < 10 * taken, "{taken} of {asked} bytes: small machines must not be turned away");
    drop((exchanges, report_reader));
}

#[test]
fn an_end_can_be_lent_to_another_thread() {
    fn sendable<T: Send + Sync>() {}
    sendable::<Exchange<TestGene>>();
    sendable::<ReportReader<TestGene>>();
    sendable::<ServiceHost<TestGene>>();
}
