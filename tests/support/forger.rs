//! Somebody who writes into a run's shared memory what no island would.

use crate::support::{World, run_id, until};
use iceoryx2::port::publisher::Publisher;
use iceoryx2::prelude::{
    Config, FileName, LogLevel, Node, NodeBuilder, Path, SemanticString, ServiceName,
    SignalHandlingMode, ipc_threadsafe::Service, set_log_level,
};
use islands::creature::Gene;
use islands::transport::Domain;
use islands::transport::wire::{BatchHeader, IndividualHeader, NOBODY, WireGene};

/// Sends as island 0 of the run in the folder `run`, beside the real one.
pub struct Forger {
    outboxes: Publisher<Service, [WireGene<Gene>], BatchHeader>,
    run_id: u64,
    // Last, since the port above is its own.
    _node: Node<Service>,
}

impl Forger {
    pub fn join(world: &World) -> Self {
        let id = run_id(&world.read("run/run.toml"));
        let domain: Domain = id.parse().unwrap();
        // The program has another folder for temporary files than the tests, unless its path is too long.
        let root = world.temporary(domain.root().file_name().unwrap());
        let root = if root.is_dir() { root.as_path() } else { domain.root() };
        // It would be surprised that the run has removed everything before it leaves.
        set_log_level(LogLevel::Error);
        let mut config = Config::default();
        config.global.set_root_path(&Path::new(root.to_str().unwrap().as_bytes()).unwrap());
        config.global.prefix = FileName::new(domain.prefix().as_bytes()).unwrap();
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        let node = NodeBuilder::new().config(&config);
        let node = node.signal_handling_mode(SignalHandlingMode::Disabled).create().unwrap();
        let service = node.service_builder(&ServiceName::new("outboxes/0").unwrap());
        let service = service.publish_subscribe::<[WireGene<Gene>]>().user_header().open().unwrap();
        let outboxes = service.publisher_builder().initial_max_slice_len(99).create().unwrap();
        Self { outboxes, run_id: domain.run_id(), _node: node }
    }

    /// Sends what could be the outbox of `epoch` with one migrant, but for what `forge` does to it. Waits until
    /// there is room for it.
    pub fn send(&self, epoch: u32, forge: impl Fn(&mut BatchHeader, &mut Vec<Gene>)) {
        let migrant = IndividualHeader {
            fitness: 1e9,
            gene_count: 1,
            parents: [NOBODY; 2],
            ..IndividualHeader::default()
        };
        let (run_id, count) = (self.run_id, 1);
        let mut header = BatchHeader { run_id, epoch, count, ..BatchHeader::default() };
        header.migrants[0] = migrant;
        let mut genes = vec![Gene([0.5; 17])];
        forge(&mut header, &mut genes);
        until("there is room for it", || {
            let mut sample = self.outboxes.loan_slice_uninit(genes.len()).unwrap();
            *sample.user_header_mut() = header;
            sample.write_from_fn(|i| WireGene(genes[i])).send().unwrap() > 0
        });
    }
}
