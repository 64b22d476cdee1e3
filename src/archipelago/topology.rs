//! Who sends migrants to whom.

use crate::choice;
use crate::rng::{Purpose, Source};
use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::str::FromStr;
use strum::EnumCount;

/// The directed graph of migration. Every way goes both ways but in a ring and in a random graph.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::Display, strum::EnumCount,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(try_from = "String", into = "String")]
pub enum Topology {
    /// Island i sends to island i + 1, the last one to the first.
    Ring,
    /// The same, and the other way round.
    BidirectionalRing,
    /// Every island sends to every other.
    Full,
    /// A grid whose edges are glued together, as square as the number of islands can be divided: each sends to
    /// those above, below, left and right of it. A prime number of islands is one row, a bidirectional ring.
    Torus,
    /// Island 0 in the middle: the others send to it alone, and it to all of them.
    Star,
    /// Islands whose numbers differ in one binary digit. Where their number is no power of two the hypercube is
    /// incomplete, and still connected: Katseff (1988).
    Hypercube,
    /// Every island sends to `degree` others and receives from as many, drawn from the run's seed: a ring through
    /// all of them in random order, so that it is connected, and the other edges at random.
    #[strum(to_string = "random-regular:{degree}")]
    RandomRegular {
        /// From 1; where there are fewer others, all of them.
        degree: u32,
    },
    /// Nobody sends anything.
    None,
}

/// Edges that are tried to be switched for each that a random graph has: as in Milo et al. (2003), who find ten
/// enough times enough.
const SWITCHES: usize = 10;
/// What a random graph has if no degree is said.
const USUAL_DEGREE: u32 = 3;
/// The highest degree that can be said.
const DEGREE_MAX: u32 = 255;

impl Topology {
    /// One of every kind.
    pub const ALL: [Topology; Topology::COUNT] = [
        Topology::Ring,
        Topology::BidirectionalRing,
        Topology::Full,
        Topology::Torus,
        Topology::Star,
        Topology::Hypercube,
        Topology::RandomRegular { degree: USUAL_DEGREE },
        Topology::None,
    ];

    /// Its graph over so many islands; `seed`, the run's, decides a random one.
    pub fn graph(self, islands: u32, seed: u64) -> Graph {
        let out = match self {
            Topology::RandomRegular { degree } => random_regular(islands, degree, seed),
            _ => (0..islands).map(|island| self.neighbours(island, islands)).collect(),
        };
        Graph::new(out)
    }

    /// Whom an island sends to in a graph that is not random, in any order and maybe twice, maybe itself.
    fn neighbours(self, island: u32, islands: u32) -> Vec<u32> {
        let around = |step: u32| (island + step) % islands;
        match self {
            Topology::Ring => vec![around(1)],
            Topology::BidirectionalRing => vec![around(1), around(islands - 1)],
            Topology::Full => (0..islands).collect(),
            Topology::Torus => torus(island, islands).to_vec(),
            Topology::Star if island == 0 => (0..islands).collect(),
            Topology::Star => vec![0],
            Topology::Hypercube => {
                let digits = u32::BITS - islands.leading_zeros();
                (0..digits).map(|k| island ^ 1 << k).filter(|&other| other < islands).collect()
            }
            Topology::RandomRegular { .. } | Topology::None => Vec::new(),
        }
    }
}

/// The neighbours in a grid of as many rows as the largest divisor that is not above the square root.
fn torus(island: u32, islands: u32) -> [u32; 4] {
    let fits = |rows: &u32| islands.is_multiple_of(*rows);
    let rows = (1..=islands.isqrt()).rev().find(fits).expect("1 divides all");
    let columns = islands / rows;
    let (row, column) = (island / columns, island % columns);
    let at = |row: u32, column: u32| (row % rows) * columns + column % columns;
    [
        at(row + rows - 1, column),
        at(row + 1, column),
        at(row, column + columns - 1),
        at(row, column + 1),
    ]
}

fn random_regular(islands: u32, degree: u32, seed: u64) -> Vec<Vec<u32>> {
    let degree = degree.min(islands.saturating_sub(1));
    // No island has this address.
    let everywhere = Source { seed, island: u32::MAX };
    let mut rng = everywhere.stream(0, 0, Purpose::Topology);
    let mut order: Vec<u32> = (0..islands).collect();
    order.shuffle(&mut rng);
    let at = |place: u32| order[(place % islands) as usize];
    let mut has = vec![vec![false; islands as usize]; islands as usize];
    let mut others = Vec::new();
    for (place, step) in (0..islands).flat_map(|place| (1..=degree).map(move |step| (place, step)))
    {
        let (from, to) = (at(place), at(place + step));
        has[from as usize][to as usize] = true;
        // The ring stays.
        others.extend((step > 1).then_some([from, to]));
    }
    for _ in 0..SWITCHES * others.len() {
        let [i, j] = [(); 2].map(|()| rng.random_range(0..others.len()));
        let ([a, b], [c, d]) = (others[i], others[j]);
        let is_free = |from: u32, to: u32| from != to && !has[from as usize][to as usize];
        if is_free(a, d) && is_free(c, b) {
            for ([from, to], there) in
                [([a, b], false), ([c, d], false), ([a, d], true), ([c, b], true)]
            {
                has[from as usize][to as usize] = there;
            }
            (others[i], others[j]) = ([a, d], [c, b]);
        }
    }
    let sends = |row: Vec<bool>| (0..).zip(row).filter(|(_, has)| *has).map(|(to, _)| to).collect();
    has.into_iter().map(sends).collect()
}

/// Who sends to whom, and who receives from whom, island by island.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Graph {
    out: Vec<Vec<u32>>,
    into: Vec<Vec<u32>>,
}

impl Graph {
    fn new(mut out: Vec<Vec<u32>>) -> Self {
        let mut into = vec![Vec::new(); out.len()];
        for (from, all) in (0..).zip(&mut out) {
            all.sort_unstable();
            all.dedup();
            all.retain(|&to| to != from);
            all.iter().for_each(|&to| into[to as usize].push(from));
        }
        Self { out, into }
    }

    /// Whom an island sends to, ascending; never itself.
    pub fn out_neighbours(&self, island: u32) -> &[u32] {
        self.out.get(island as usize).map_or(&[], Vec::as_slice)
    }

    /// Whom an island receives from, ascending: by definition those that send to it.
    pub fn in_neighbours(&self, island: u32) -> &[u32] {
        self.into.get(island as usize).map_or(&[], Vec::as_slice)
    }

    /// How many edges there are.
    pub fn edges(&self) -> usize {
        self.out.iter().map(Vec::len).sum()
    }

    /// The length of the longest of the shortest ways back from a receiver to its sender, in edges: how many times
    /// as far as from one island to the next a sender that never waits for its reader can get ahead of it. None if
    /// there is no way back, 0 if nobody sends.
    pub fn longest_way_back(&self) -> Option<u32> {
        let back = |reader: u32| {
            let lengths = self.lengths_from(reader);
            let senders = self.in_neighbours(reader).iter();
            senders.map(|&sender| lengths[sender as usize]).max().unwrap_or(Some(0))
        };
        let islands = self.out.len() as u32;
        (0..islands).map(back).try_fold(0, |longest, length| Some(length?.max(longest)))
    }

    /// The lengths of the shortest ways from an island to all, in edges.
    fn lengths_from(&self, start: u32) -> Vec<Option<u32>> {
        let mut lengths = vec![None; self.out.len()];
        lengths[start as usize] = Some(0);
        let mut open = VecDeque::from([(start, 0)]);
        while let Some((island, length)) = open.pop_front() {
            for &next in self.out_neighbours(island) {
                if lengths[next as usize].is_none() {
                    lengths[next as usize] = Some(length + 1);
                    open.push_back((next, length + 1));
                }
            }
        }
        lengths
    }
}

impl FromStr for Topology {
    type Err = String;

    /// Reads what `Display` writes; a random graph without a degree has the usual one.
    fn from_str(text: &str) -> Result<Self, String> {
        let (usual, scheme) = choice::Scheme::of("topology", &Self::ALL, text)?;
        match usual {
            Topology::RandomRegular { degree } => {
                Ok(Topology::RandomRegular { degree: scheme.whole(degree, 1, DEGREE_MAX)? })
            }
            plain => scheme.plain(plain),
        }
    }
}

choice::as_text!(Topology);

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: [u32; 12] = [1, 2, 3, 4, 5, 6, 8, 9, 12, 13, 30, 256];

    fn out(topology: Topology, islands: u32, island: u32) -> Vec<u32> {
        topology.graph(islands, 7).out_neighbours(island).to_vec()
    }

    #[test]
    fn each_topology_sends_where_it_says() {
        for (topology, islands, island, expected) in [
            (Topology::Ring, 4, 3, vec![0]),
            (Topology::BidirectionalRing, 5, 0, vec![1, 4]),
            (Topology::BidirectionalRing, 2, 0, vec![1]),
            (Topology::Full, 4, 2, vec![0, 1, 3]),
            (Topology::Torus, 12, 5, vec![1, 4, 6, 9]),
            (Topology::Torus, 12, 0, vec![1, 3, 4, 8]),
            (Topology::Torus, 6, 0, vec![1, 2, 3]),
            (Topology::Torus, 7, 0, vec![1, 6]),
            (Topology::Star, 4, 0, vec![1, 2, 3]),
            (Topology::Star, 4, 2, vec![0]),
            (Topology::Hypercube, 8, 5, vec![1, 4, 7]),
            (Topology::Hypercube, 6, 5, vec![1, 4]),
            (Topology::None, 6, 5, vec![]),
        ] {
            assert_eq!(out(topology, islands, island), expected, "{topology} of {islands}");
        }
    }

    #[test]
    fn every_island_is_reached_from_every_other_and_none_is_its_own_neighbour() {
        for (topology, islands) in Topology::ALL.into_iter().flat_map(|t| COUNTS.map(|n| (t, n))) {
            let graph = topology.graph(islands, 7);
            let name = format!("{topology} of {islands}");
            for island in 0..islands {
                let to = graph.out_neighbours(island);
                assert!(to.is_sorted_by(|a, b| a < b) && !to.contains(&island), "{name}: {to:?}");
                assert!(to.iter().all(|&to| graph.in_neighbours(to).contains(&island)), "{name}");
                let is_reached = graph.lengths_from(island).iter().all(Option::is_some);
                assert!(is_reached || topology == Topology::None, "{name}");
            }
            assert!(graph.longest_way_back().is_some(), "{name}");
        }
    }

    #[test]
    fn a_random_graph_is_regular_and_the_seeds_own() {
        for (islands, degree) in COUNTS.into_iter().flat_map(|n| [1, 2, 3, 7, 255].map(|d| (n, d)))
        {
            let graph = Topology::RandomRegular { degree }.graph(islands, 7);
            let expected = degree.min(islands - 1) as usize;
            for island in 0..islands {
                let degrees = [graph.out_neighbours(island), graph.in_neighbours(island)];
                assert_eq!(degrees.map(<[u32]>::len), [expected; 2], "{degree} of {islands}");
            }
        }
        let graph = |seed| Topology::RandomRegular { degree: 3 }.graph(30, seed);
        assert_eq!(graph(7), graph(7));
        assert_ne!(graph(7), graph(8));
        let circulant = |island: u32, to: &[u32]| to.iter().all(|to| (to + 30 - island) % 30 <= 3);
        assert!(!(0..30).all(|island| circulant(island, graph(7).out_neighbours(island))));
    }

    #[test]
    fn a_way_back_is_as_long_as_the_graph_makes_it() {
        for (topology, expected) in [
            (Topology::Ring, 7),
            (Topology::BidirectionalRing, 1),
            (Topology::Full, 1),
            (Topology::Star, 1),
            (Topology::None, 0),
        ] {
            assert_eq!(topology.graph(8, 7).longest_way_back(), Some(expected), "{topology}");
        }
        assert_eq!(Graph::new(vec![vec![1], vec![]]).longest_way_back(), None);
    }

    #[test]
    fn a_topology_is_read_as_it_is_written() {
        for topology in Topology::ALL {
            assert_eq!(topology.to_string().parse(), Ok(topology));
        }
        assert_eq!("random-regular".parse(), Ok(Topology::RandomRegular { degree: 3 }));
        for wrong in ["", "rings", "ring:3", "random-regular:0", "random-regular:x", "none:3"] {
            assert!(wrong.parse::<Topology>().is_err(), "{wrong}");
        }
    }
}
