//! A channel that loses, repeats, delays and reorders, and has room for so much only.

use crate::rng::Stream;
use rand::RngExt;
use std::time::Duration;

/// How bad a channel is.
#[derive(Debug, Clone, Copy)]
pub struct Weather {
    /// Probability that a message is lost, below 1.
    pub loss: f64,
    /// Probability that it is there twice.
    pub repetition: f64,
    /// The most that it takes, in ms.
    pub delay_ms_max: u64,
    /// Messages from one island to another, under way or unread, beyond which no other is delivered.
    pub room: usize,
}

/// What is under way between islands, and what is unread.
pub struct Sea<M> {
    weather: Weather,
    parcels: Vec<Parcel<M>>,
}

struct Parcel<M> {
    arrives: Duration,
    from: u32,
    to: u32,
    message: M,
}

impl<M: Clone> Sea<M> {
    pub fn new(weather: Weather) -> Self {
        Self { weather, parcels: Vec::new() }
    }

    /// Sends a message; nobody knows whether it will arrive.
    pub fn send(&mut self, now: Duration, [from, to]: [u32; 2], message: &M, rng: &mut Stream) {
        let copies = match () {
            () if rng.random_bool(self.weather.loss) => 0,
            () if rng.random_bool(self.weather.repetition) => 2,
            () => 1,
        };
        for _ in 0..copies {
            let on_the_way = self.parcels.iter().filter(|p| [p.from, p.to] == [from, to]).count();
            let delay = Duration::from_millis(rng.random_range(0..=self.weather.delay_ms_max));
            if on_the_way < self.weather.room {
                let message = message.clone();
                self.parcels.push(Parcel { arrives: now + delay, from, to, message });
            }
        }
    }

    /// Takes out what has arrived at an island, in the order of arrival.
    pub fn collect(&mut self, now: Duration, island: u32) -> Vec<M> {
        let is_there = |parcel: &mut Parcel<M>| parcel.to == island && parcel.arrives <= now;
        let mut there: Vec<Parcel<M>> = self.parcels.extract_if(.., is_there).collect();
        there.sort_by_key(|parcel| parcel.arrives);
        there.into_iter().map(|parcel| parcel.message).collect()
    }

    /// Drops what was under way to an island that died, and some of what was under way from it.
    pub fn bury(&mut self, island: u32, rng: &mut Stream) {
        self.parcels.retain(|parcel| {
            parcel.to != island && (parcel.from != island || rng.random_bool(0.5))
        });
    }
}
