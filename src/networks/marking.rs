//! Which genes of two genomes mean the same.
//!
//! The paper numbers innovations by a counter. Islands have none in common, and no order of execution may matter, so
//! here a marking says what was done: a link is known by the two neurons that it joins, and a hidden neuron by the link
//! that it split, and by how many had split that link before it in its genome. Equal innovations have equal markings,
//! wherever and whenever they happen; in the paper only those of one generation have.

/// What names a neuron in every genome: inputs, the bias and outputs are counted, hidden neurons are hashed.
pub type Marking = u64;

/// Hidden neurons have this bit, and nobody else.
const HIDDEN: Marking = 1 << 63;

/// Where a network meets its surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sockets {
    /// Numbers that go in, besides the bias, which is always 1.
    pub inputs: u32,
    /// Numbers that come out.
    pub outputs: u32,
}

impl Sockets {
    /// The inputs, in order, and the bias.
    pub fn sources(self) -> impl Iterator<Item = Marking> + Clone {
        (0..=self.inputs).map(Marking::from)
    }

    /// The bias.
    pub fn bias(self) -> Marking {
        Marking::from(self.inputs)
    }

    /// The outputs, in order.
    pub fn outputs(self) -> impl Iterator<Item = Marking> + Clone {
        let first = self.bias() + 1;
        first..first + Marking::from(self.outputs)
    }

    /// How many neurons every genome has.
    pub fn len(self) -> usize {
        self.inputs as usize + 1 + self.outputs as usize
    }

    /// Whether there is no neuron at all, which is never so: there is a bias.
    pub fn is_empty(self) -> bool {
        false
    }

    /// Whether links can lead to this neuron.
    pub fn is_target(self, marking: Marking) -> bool {
        is_hidden(marking) || self.outputs().any(|output| output == marking)
    }
}

/// Whether it is a hidden neuron's.
pub fn is_hidden(marking: Marking) -> bool {
    marking & HIDDEN != 0
}

/// The marking of the neuron that splits the link between two others, the first such one (`nth` = 0) or a later one.
pub fn of_split(from: Marking, to: Marking, nth: u64) -> Marking {
    hidden("split", [from, to, nth])
}

/// The marking of hidden neuron `nth` of a genome that begins with some.
pub fn of_first(nth: u64) -> Marking {
    hidden("first", [nth, 0, 0])
}

fn hidden(what: &str, numbers: [u64; 3]) -> Marking {
    let mut hasher = blake3::Hasher::new();
    hasher.update(what.as_bytes());
    for number in numbers {
        hasher.update(&number.to_le_bytes());
    }
    let hash = hasher.finalize();
    Marking::from_le_bytes(*hash.as_bytes().first_chunk().expect("a hash has 32 bytes")) | HIDDEN
}
