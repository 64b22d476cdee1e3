//! Exclusive or (section 4.1 of the paper): the smallest problem that a network without hidden neurons cannot solve.

use crate::networks::Network;

/// What a network gets besides its score that has all four answers right: above this it has solved it.
pub const SOLVED: f64 = 16.0;

/// The four questions, and the right answer to each.
const TABLE: [([f64; 2], f64); 4] =
    [([0.0, 0.0], 0.0), ([0.0, 1.0], 1.0), ([1.0, 0.0], 1.0), ([1.0, 1.0], 0.0)];

/// The square of 4 less the sum of all errors, 0 to 16, as in the paper; and [`SOLVED`] more where all answers are on the
/// right side of one half. In the paper a run ends there, so that this changes nothing before.
pub fn score(network: &mut Network) -> f64 {
    let (mut errors, mut right) = (0.0, 0);
    for (question, answer) in TABLE {
        network.forget();
        let given = network.step(&question)[0];
        errors += (answer - given).abs();
        right += usize::from((given > 0.5) == (answer > 0.5));
    }
    let score = (4.0 - errors) * (4.0 - errors);
    if right == TABLE.len() { SOLVED + score } else { score }
}
