//! What it costs to hand one epoch's outbox over: through shared memory, as islands do it, or encoded and
//! copied through a socket, as it is mostly done.
//!
//! Both ends are in one thread, so this is the work of a handover without the scheduler's delay, which
//! is the same for all. Every way begins with an outbox and ends with an equal one that the receiver owns:
//!
//! - `shared memory`: publish, wake up, receive, with every check of what was received;
//! - `socket and codec`: encoded as in the journal, through a Unix socket, decoded; nothing is checked;
//! - `socket alone`: the genes' bytes as they are, nobody's name or fitness: what any codec would have to beat;
//! - `journal`: what is done before an outbox is sent, to put the others into proportion. It waits for the disk.
//!
//! `cargo bench --bench migration`

use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput, measurement::WallTime};
use islands::archipelago::{Archipelago, Migration, Outbox, Topology};
use islands::creature::Gene;
use islands::evolution::{Fitness, Id, Individual, Selection, Strategy, Variation};
use islands::rng::{Purpose, Source};
use islands::store::{self, Journal};
use islands::transport::{Domain, Exchange, ServiceHost, TICK};
use rand::RngExt;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::time::Duration;

const MIGRANTS: [usize; 2] = [5, 20];
const GENES: usize = 10;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("migration");
    group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3));
    for migrants in MIGRANTS {
        let outbox = outbox(migrants);
        group.throughput(Throughput::Bytes((migrants * GENES * size_of::<Gene>()) as u64));
        shared_memory(&mut group, &outbox);
        socket_and_codec(&mut group, &outbox);
        socket_alone(&mut group, &outbox);
        journal(&mut group, &outbox);
    }
    group.finish();
    criterion.final_summary();
}

type Group<'a> = BenchmarkGroup<'a, WallTime>;

fn shared_memory(group: &mut Group<'_>, outbox: &Outbox<Gene>) {
    let archipelago = archipelago(outbox.migrants.len());
    let domain = Domain::new(0xbe_0000_0000 | u64::from(std::process::id()));
    let service_host =
        ServiceHost::<Gene>::create(&domain, &archipelago).expect("there is shared memory");
    let [from, to] = [0, 1].map(|island| {
        Exchange::<Gene>::open(&domain, &archipelago, island).expect("the service host is there")
    });
    let hand_over = || {
        from.publish(outbox).expect("it keeps the limits");
        to.wait(TICK).expect("nobody interrupts");
        to.receive().outboxes.pop().expect("it has arrived")
    };
    assert_eq!(hand_over(), *outbox);
    group.bench_function(id("shared memory", outbox), |bencher| bencher.iter(hand_over));
    drop((from, to));
    service_host.close().expect("nothing of it is left");
}

fn socket_and_codec(group: &mut Group<'_>, outbox: &Outbox<Gene>) {
    let mut socket = Socket::new();
    let mut hand_over = || -> Outbox<Gene> {
        let bytes = socket.pass(&store::encode(outbox));
        store::decode(&bytes).expect("a socket does not change what it carries")
    };
    assert_eq!(hand_over(), *outbox);
    group.bench_function(id("socket and codec", outbox), |bencher| bencher.iter(&mut hand_over));
}

fn socket_alone(group: &mut Group<'_>, outbox: &Outbox<Gene>) {
    let genomes = outbox.migrants.iter().map(|migrant| migrant.genome.as_slice());
    let genes: Vec<Gene> = genomes.collect::<Vec<_>>().concat();
    let mut socket = Socket::new();
    let mut hand_over = || -> Vec<Gene> {
        let bytes = socket.pass(bytemuck::cast_slice(&genes));
        bytemuck::pod_collect_to_vec(&bytes)
    };
    assert_eq!(hand_over(), genes);
    group.bench_function(id("socket alone", outbox), |bencher| bencher.iter(&mut hand_over));
}

fn journal(group: &mut Group<'_>, outbox: &Outbox<Gene>) {
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    let mut journal = Journal::open(&folder.path().join("log")).expect("it is writable");
    group.bench_function(id("journal", outbox), |bencher| {
        bencher.iter(|| journal.append(outbox).expect("the disk has room"));
    });
}

fn id(way: &str, outbox: &Outbox<Gene>) -> BenchmarkId {
    BenchmarkId::new(way, format!("{} migrants", outbox.migrants.len()))
}

/// A pair of sockets, and messages with their length before them.
struct Socket {
    from: UnixStream,
    to: UnixStream,
}

impl Socket {
    fn new() -> Self {
        let (from, to) = UnixStream::pair().expect("there are sockets");
        Self { from, to }
    }

    /// A message must fit into the socket's buffer, since nobody reads while it is written.
    fn pass(&mut self, message: &[u8]) -> Vec<u8> {
        let works = "both ends are open";
        self.from.write_all(&message.len().to_le_bytes()).expect(works);
        self.from.write_all(message).expect(works);
        let mut length = [0; size_of::<usize>()];
        self.to.read_exact(&mut length).expect(works);
        let mut received = vec![0; usize::from_le_bytes(length)];
        self.to.read_exact(&mut received).expect(works);
        received
    }
}

fn outbox(migrants: usize) -> Outbox<Gene> {
    let source = Source { seed: 7, island: 0 };
    let migrant = |index: u32| {
        let mut stream = source.stream(0, index, Purpose::Genesis);
        let gene = |_| Gene(std::array::from_fn(|_| stream.random()));
        Individual {
            id: Id { island: 0, generation: 5, index },
            parents: [Some(Id { island: 1, generation: 4, index }), None],
            origin: 0,
            genome: (0..GENES).map(gene).collect(),
            fitness: Fitness::new(f64::from(index)),
        }
    };
    Outbox { island: 0, epoch: 0, migrants: (0..migrants as u32).map(migrant).collect() }
}

fn archipelago(migrants: usize) -> Archipelago {
    Archipelago {
        islands: 2,
        seed: 7,
        topology: Topology::Ring,
        migration: Migration { interval: 5, migrants, lag: 1, ..Migration::default() },
        strategy: Strategy {
            population: 24,
            elites: 2,
            selection: Selection::Tournament { size: 3 },
            variation: Variation {
                crossover_rate: 0.7,
                point_rate: 0.1,
                point_amount: 0.2,
                shrink_rate: 0.1,
                grow_rate: 0.1,
                genes_max: GENES,
                ..Variation::default()
            },
            ..Strategy::default()
        },
    }
}
