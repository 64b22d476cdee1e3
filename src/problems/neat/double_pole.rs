//! Two poles of different lengths on a cart (sections 4.2 and 4.3 of the paper).

use super::cart::Cart;
use crate::evolution::Fitness;
use crate::networks::Network;

/// A network that balances for so many steps of 0.02 s has solved it.
pub const LONG_STEPS: u32 = 100_000;
/// What a blind network gets that has solved it, besides the number of other starts that it holds.
pub const SOLVED: f64 = 1_000.0;
/// From so many of the 625 starts a blind network has to balance.
pub const STARTS_NEEDED: usize = 200;

/// What goes in with velocities.
pub const INPUTS: [&str; 6] =
    ["cart", "cart speed", "long pole", "long pole speed", "short pole", "short pole speed"];
/// What goes in without them.
pub const BLIND_INPUTS: [&str; 3] = ["cart", "long pole", "short pole"];

/// Where the long pole stands at first, in radians: 4°, as the paper's program has it.
const START_RAD: f64 = 0.07;
/// Steps of a blind trial, and of each of the 625 starts.
const SHORT_STEPS: u32 = 1_000;
/// Steps over which a blind network's shaking is summed up.
const SHAKING_STEPS: usize = 100;
/// What positions, speeds, angles and their speeds are divided by, so that a network gets about −1 to 1.
const SCALES: [f64; 6] = [4.8, 2.0, 0.52, 2.0, 0.52, 2.0];
/// The values that each part of the 625 starts has, as shares of its range.
const SHARES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];
/// The ranges of the starts: metres, m/s, radians and rad/s of the long pole, from minus this to this.
const RANGES: [f64; 4] = [2.16, 1.35, 0.062_831_52, 0.150_097_52];

/// The test of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Poles {
    /// Whether velocities are hidden from it.
    pub is_blind: bool,
}

impl Poles {
    /// How many steps a network balances, at most `most`.
    pub fn steps_balanced(self, network: &mut Network, most: u32) -> u32 {
        self.balance(network, start(), most, |_, _| ())
    }

    /// What a network without velocities gets (Gruau, Whitley & Pyeatt 1996): a tenth of its time, as a share of 1,000
    /// steps, and nine tenths of how little it shook in its last 100 steps. Who would be better than `best` so is tried
    /// further: a network that balances 100,000 steps and then from at least 200 of 625 starts has solved it, and gets
    /// [`SOLVED`] and the number of these starts.
    pub fn score_blind(self, network: &mut Network, best: Fitness) -> f64 {
        let score = self.short_score(network);
        if Fitness::new(score) <= best || self.steps_balanced(network, LONG_STEPS) < LONG_STEPS {
            return score;
        }
        let starts = self.starts_held(network);
        if starts >= STARTS_NEEDED { SOLVED + starts as f64 } else { score }
    }

    fn short_score(self, network: &mut Network) -> f64 {
        let mut shaking = [0.0; SHAKING_STEPS];
        let steps = self.balance(network, start(), SHORT_STEPS, |step, cart| {
            shaking[step as usize % SHAKING_STEPS] = cart.0[..4].iter().map(|it| it.abs()).sum();
        });
        let calm = match steps as usize {
            ..SHAKING_STEPS => 0.0,
            _ => 0.75 / shaking.iter().sum::<f64>(),
        };
        // Who stands still to the last bit is not worth more than who has solved it.
        let score = 0.1 * f64::from(steps) / f64::from(SHORT_STEPS) + 0.9 * calm;
        score.min(SOLVED)
    }

    /// From how many of the 625 starts a network balances 1,000 steps: positions and speeds of the cart and of the long
    /// pole, each of which has five values.
    pub fn starts_held(self, network: &mut Network) -> usize {
        let cart = |number: usize| {
            let part = |part: usize| {
                let share = SHARES[number / 5_usize.pow(part as u32) % 5];
                RANGES[part] * (2.0 * share - 1.0)
            };
            Cart([part(0), part(1), part(2), part(3), 0.0, 0.0])
        };
        let starts = SHARES.len().pow(4);
        let is_held =
            |number| self.balance(network, cart(number), SHORT_STEPS, |_, _| ()) == SHORT_STEPS;
        (0..starts).map(is_held).filter(|held| *held).count()
    }

    /// Lets a network balance until something falls, and says after how many steps that was. `observe` sees the number of
    /// each step and the cart after it.
    fn balance(
        self,
        network: &mut Network,
        mut cart: Cart,
        most: u32,
        mut observe: impl FnMut(u32, &Cart),
    ) -> u32 {
        network.forget();
        for step in 0..most {
            let seen: [f64; 6] = std::array::from_fn(|i| cart.0[i] / SCALES[i]);
            let output = match self.is_blind {
                true => network.step(&[seen[0], seen[2], seen[4]])[0],
                false => network.step(&seen)[0],
            };
            cart.push((output - 0.5) * 20.0);
            if !cart.stands() {
                return step;
            }
            observe(step, &cart);
        }
        most
    }
}

fn start() -> Cart {
    Cart([0.0, 0.0, START_RAD, 0.0, 0.0, 0.0])
}
