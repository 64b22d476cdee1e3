//! When what is on screen: the film clock.
//!
//! A film is cut into slots of equal length. In slot k every island's view shows, at the same time, the
//! champion that the island had in generation `k * generations_per_slot`. So film time and generation are
//! proportional, curves and creatures belong together at every moment of the film, and every creature of a
//! finished recording moves.

use super::Clip;

/// How fast generations pass in the film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// The length of a slot in seconds: a champion's trajectory is cut to it.
    pub slot_s: f64,
    /// The generations that pass in a slot, at least 1.
    pub generations_per_slot: u32,
}

impl Pace {
    /// About how many slots [`Pace::for_run`] makes if nothing else is wished: two minutes of film with trials of
    /// ten seconds.
    pub const SLOTS: u32 = 12;
    /// A pace that gives a run of `generations` a watchable film, or a slot every `clip_every` generations;
    /// `slot_s` is the length of a trial.
    pub fn for_run(generations: u32, clip_every: Option<u32>, slot_s: f64) -> Self {
        let usual = generations.div_ceil(Self::SLOTS);
        Self { slot_s, generations_per_slot: clip_every.unwrap_or(usual).max(1) }
    }

    /// Whether a slot starts with this generation: only its champion has to be simulated again to be shown.
    pub fn opens_slot(self, generation: u32) -> bool {
        generation.is_multiple_of(self.generations_per_slot.max(1))
    }

    /// The film time of a generation in seconds.
    pub fn film_s(self, generation: u32) -> f64 {
        f64::from(generation) * self.slot_s / f64::from(self.generations_per_slot.max(1))
    }

    /// The number of slots that have opened by a generation.
    fn opened(self, generation: u32) -> u32 {
        generation / self.generations_per_slot.max(1) + 1
    }
}

/// The first generations all have a row of curves and news; of later ones every second, fourth, eighth, … has: so many
/// between a generation and twice that generation.
const ROWS: u32 = 256;

/// Whether a generation has a row of curves and news. So the film of a long run costs little more than that of a short
/// one, and a longer run has all rows of a shorter one. The last generation that there is has a row in any case.
pub fn opens_row(generation: u32) -> bool {
    let doublings = (generation / ROWS).max(1).ilog2();
    generation.is_multiple_of(1 << doublings)
}

/// A clip that is to be shown now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screening<'a> {
    /// What to show.
    pub clip: &'a Clip,
    /// The film time at which it starts.
    pub start_s: f64,
    /// The generation that it stands for: its champion may be older.
    pub generation: u32,
    /// The slot of the film.
    pub slot: u32,
    /// How many lanes the film has.
    pub lanes: u32,
}

/// Which clip comes when: one reel an island.
#[derive(Debug, Clone)]
pub struct Film {
    pace: Pace,
    reels: Vec<Reel>,
}

#[derive(Debug, Clone, Default)]
struct Reel {
    clip: Option<Clip>,
    /// Whether `clip` has not been shown.
    fresh: bool,
    /// The last generation that was reported.
    generation: u32,
    /// The slots that have opened.
    opened: u32,
    /// The slots that have been filled.
    filled: u32,
}

impl Film {
    /// An empty film.
    pub fn new(lanes: u32, pace: Pace) -> Self {
        Self { pace, reels: vec![Reel::default(); lanes as usize] }
    }

    /// Its pace.
    pub fn pace(&self) -> Pace {
        self.pace
    }

    /// From now on `clip` is the champion of its island. A clip of an island that the film does not have is
    /// ignored.
    pub fn champion(&mut self, clip: Clip) {
        if let Some(reel) = self.reels.get_mut(clip.lane as usize) {
            reel.clip = Some(clip);
            reel.fresh = true;
        }
    }

    /// An island has reached a generation.
    pub fn reached(&mut self, island: u32, generation: u32) {
        let opened = self.pace.opened(generation);
        if let Some(reel) = self.reels.get_mut(island as usize) {
            reel.generation = reel.generation.max(generation);
            reel.opened = reel.opened.max(opened);
        }
    }

    /// The run is over: opens one more slot for champions that came after the last one, and lets all reels
    /// end together.
    pub fn end(&mut self) {
        let opened = self.reels.iter().map(|reel| reel.opened).max().unwrap_or(0);
        let late = self.reels.iter().any(|reel| reel.fresh && reel.filled == reel.opened);
        for reel in &mut self.reels {
            reel.opened = opened + u32::from(late);
        }
    }

    /// The next clip of a lane to show, if a slot of it has opened; call until there is none.
    pub fn next(&mut self, lane: u32) -> Option<Screening<'_>> {
        let lanes = self.lanes();
        let reel = self.reels.get_mut(lane as usize)?;
        let clip = reel.clip.as_ref().filter(|_| reel.filled < reel.opened)?;
        let slot = reel.filled;
        reel.filled += 1;
        reel.fresh = false;
        let generation = (slot * self.pace.generations_per_slot).min(reel.generation);
        Some(Screening {
            clip,
            start_s: f64::from(slot) * self.pace.slot_s,
            generation,
            slot,
            lanes,
        })
    }

    /// The number of lanes.
    pub fn lanes(&self) -> u32 {
        self.reels.len() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::{Controller, Creature, Morphology};
    use crate::simulation::Ground;
    use crate::simulation::trajectory::Trajectory;
    use nalgebra::UnitQuaternion;

    const PACE: Pace = Pace { slot_s: 2.0, generations_per_slot: 10 };

    #[test]
    fn a_champion_that_comes_too_late_gets_a_slot_of_its_own() {
        let mut film = Film::new(2, PACE);
        for island in 0..2 {
            film.champion(clip(island, 0));
            film.reached(island, 0);
            assert_eq!(shown(&mut film, island), [(0, 0.0)]);
        }
        film.champion(clip(1, 7));
        film.reached(1, 7);
        film.end();
        assert_eq!(shown(&mut film, 0), [(0, 2.0)]);
        assert_eq!(shown(&mut film, 1), [(7, 2.0)]);
    }

    #[test]
    fn of_champions_within_a_slot_the_last_one_is_shown() {
        let mut film = Film::new(1, PACE);
        for generation in 0..=10 {
            film.champion(clip(0, generation));
            film.reached(0, generation);
            let expected: &[(u32, f64)] = match generation {
                0 => &[(0, 0.0)],
                10 => &[(10, 2.0)],
                _ => &[],
            };
            assert_eq!(shown(&mut film, 0), expected);
        }
        film.end();
        assert_eq!(shown(&mut film, 0), []);
    }

    #[test]
    fn a_run_of_any_length_makes_a_film_of_about_twelve_slots() {
        for generations in [0, 1, 12, 100, 5_000] {
            let pace = Pace::for_run(generations, None, 10.0);
            assert!(pace.film_s(generations) <= 120.0, "{pace:?}");
            assert!(pace.opens_slot(0));
        }
    }

    #[test]
    fn a_short_run_has_all_rows_and_a_long_one_some_thousands() {
        let rows =
            |generations| (0..=generations).filter(|&generation| opens_row(generation)).count();
        assert_eq!([0, 1, 140, 511].map(rows), [1, 2, 141, 512]);
        assert_eq!([1_023, 2_047, 100_000, 1_000_000].map(rows), [768, 1_024, 2_439, 3_305]);
        assert!(opens_row(1 << 31));
    }

    fn shown(film: &mut Film, island: u32) -> Vec<(u32, f64)> {
        let mut shown = Vec::new();
        while let Some(screening) = film.next(island) {
            shown.push((screening.clip.generation, screening.start_s));
        }
        shown
    }

    fn clip(lane: u32, generation: u32) -> Clip {
        let trajectory = Trajectory {
            bodies: vec![],
            shapes: vec![],
            times_s: vec![],
            poses: vec![],
            scoring_from_s: 0.0,
            ground: Ground::Plane,
        };
        Clip {
            lane,
            hue: lane,
            generation,
            label: String::new(),
            short_label: String::new(),
            creature: Creature {
                morphology: Morphology { links: vec![], root_rotation: UnitQuaternion::identity() },
                controller: Controller::of_waves(0.1, []),
            },
            others: vec![],
            trajectory,
        }
    }
}
