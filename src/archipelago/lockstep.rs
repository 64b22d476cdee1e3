//! A whole archipelago in one process: the reference that the processes must equal to the last bit.

use super::island::{self, Island, Step};
use super::topology::Graph;
use super::{Archipelago, Outbox};
use crate::evolution::Problem;
use std::collections::BTreeMap;

/// Runs every island to `generations`, in step, and returns them in order. `observe` sees each step.
pub fn run<P: Problem>(
    problem: &P,
    archipelago: &Archipelago,
    generations: u32,
    mut observe: impl FnMut(&Step<P::Gene>),
) -> Vec<Island<P::Gene>> {
    let mut sent: BTreeMap<(u32, u32), Outbox<P::Gene>> = BTreeMap::new();
    let mut islands: Vec<Island<P::Gene>> = (0..archipelago.islands)
        .map(|index| {
            let step = island::genesis(problem, archipelago, index);
            observe(&step);
            step.island
        })
        .collect();
    let graph = archipelago.graph();
    for generation in 1..=generations {
        let mut outboxes = Vec::new();
        islands = islands
            .into_iter()
            .map(|island| {
                let immigrants = immigrants(&sent, archipelago, &graph, island.index, generation);
                let step = island::step(island, &immigrants, problem, archipelago);
                observe(&step);
                outboxes.extend(step.outbox);
                step.island
            })
            .collect();
        sent.extend(outboxes.into_iter().map(|outbox| ((outbox.epoch, outbox.island), outbox)));
    }
    islands
}

fn immigrants<G: Clone>(
    sent: &BTreeMap<(u32, u32), Outbox<G>>,
    archipelago: &Archipelago,
    graph: &Graph,
    island: u32,
    generation: u32,
) -> Vec<Outbox<G>> {
    let Some(epoch) = archipelago.migration.immigration(generation) else { return Vec::new() };
    let sources = graph.in_neighbours(island);
    sources.iter().filter_map(|&source| sent.get(&(epoch, source)).cloned()).collect()
}
