//! How far a body got by going, rather than by one event.
//!
//! Scores of locomotion are won by falling over, by throwing oneself, or by being thrown by a fault of the solver
//! (Sims 1994; Lehman et al. 2020), and each of these happens once. A gait repeats itself. So a body's progress is
//! at most twice what is left of it without its best four seconds: steady going loses nothing by that, and one event
//! that is over in four seconds, whatever it is and whenever it comes, gains nothing. Half of the eight seconds that
//! are scored is the longest time that can be taken away from all gaits alike, and a whole cycle of the slowest
//! native motor.
//!
//! All rules are pure functions of a track: positions of the centre of mass above the ground, or heights, evenly spaced
//! in time, so that the body's size counts for nothing.

use nalgebra::Vector2;

/// The horizontal distance from the first position of a track to the last, in metres, but at most twice what is left
/// of it without its best half.
pub fn away_m(track_m: &[Vector2<f64>]) -> f64 {
    let (Some(first), Some(last)) = (track_m.first(), track_m.last()) else { return 0.0 };
    let whole = last - first;
    let left = without_half(track_m).map(|half| (whole - (half[half.len() - 1] - half[0])).norm());
    left.fold(whole.norm(), |least, left| least.min(2.0 * left))
}

/// The length of a track in metres, measured with a ruler as long as the body reaches from its root, but at most twice
/// what is left of it without its best half.
///
/// A ruler does not see what is shorter than it (Richardson 1961, who measured coasts): however fast a body rocks,
/// trembles or spins in place, it gets no farther than its own reach from where it is.
pub fn travelled_m(track_m: &[Vector2<f64>], ruler_m: f64) -> f64 {
    kept(&lengths_m(track_m, ruler_m)).max(0.0)
}

/// The height that a body gained and kept, in metres, but at most twice what is left of it without its best half.
///
/// `heights_m` is where its lowest point was, at most as high as the ground below its centre: see
/// [`Measurement::heights_m`](crate::simulation::Measurement::heights_m). So a tall body gains nothing by its size, one
/// that rises on its toes or leans on a wall nothing by that, and one in the air is where its shadow is. A moment's
/// height is what is left of it until the end: what slides back has kept nothing. And who is thrown up the hill, draws
/// in a limb that hung down it, or falls over uphill has done so once, which is worth nothing without its best half.
pub fn climbed_m(heights_m: &[f64]) -> f64 {
    let Some(first) = heights_m.first() else { return 0.0 };
    let mut kept_m: Vec<f64> = heights_m.iter().map(|height| height - first).collect();
    for i in (1..kept_m.len()).rev() {
        kept_m[i - 1] = kept_m[i - 1].min(kept_m[i]);
    }
    kept_m.iter_mut().for_each(|height| *height = height.max(0.0));
    kept(&kept_m)
}

/// What a series gains from its first moment to its last, in its unit, but at most twice what is left of that without
/// its best half; below zero for what falls.
pub fn kept(series: &[f64]) -> f64 {
    let (Some(first), Some(last)) = (series.first(), series.last()) else { return 0.0 };
    let whole = last - first;
    let left = without_half(series).map(|half| whole - (half[half.len() - 1] - half[0]));
    left.fold(whole, |least, left| least.min(2.0 * left))
}

/// Every run of half of a track's legs.
fn without_half<T>(track: &[T]) -> std::slice::Windows<'_, T> {
    track.windows(track.len() / 2 + 1)
}

/// The length of a track up to each of its positions: ruler by ruler, then straight on.
fn lengths_m(track_m: &[Vector2<f64>], ruler_m: f64) -> Vec<f64> {
    let mut mark_m = track_m.first().copied().unwrap_or_default();
    let mut marked_m = 0.0;
    let length_m = |position_m: &Vector2<f64>| {
        let beyond_m = (position_m - mark_m).norm();
        let length_m = marked_m + beyond_m;
        if beyond_m >= ruler_m {
            (mark_m, marked_m) = (*position_m, length_m);
        }
        length_m
    };
    track_m.iter().map(length_m).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A track of 81 positions.
    fn track(at: impl Fn(f64) -> (f64, f64)) -> Vec<Vector2<f64>> {
        (0..81).map(|i| at(f64::from(i) * 0.1)).map(|(x, y)| Vector2::new(x, y)).collect()
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }

    #[test]
    fn a_steady_gait_is_worth_its_distance() {
        let steady = track(|t| (0.3 * t, 0.4 * t));
        assert_near(away_m(&steady), 4.0);
        assert_near(travelled_m(&steady, 0.5), 4.0);
    }

    #[test]
    fn one_event_gains_nothing_whenever_it_comes() {
        for start in 0..=40 {
            let start = 0.1 * f64::from(start);
            let leap = track(|t| ((t - start).clamp(0.0, 4.0), 0.0));
            assert_near(away_m(&leap), 0.0);
            assert_near(travelled_m(&leap, 0.5), 0.0);
        }
    }

    #[test]
    fn a_gait_with_a_lurch_is_worth_no_more_than_twice_the_gait() {
        let lurch = track(|t| (0.1 * t + if t > 3.0 { 5.0 } else { 0.0 }, 0.0));
        assert_near(away_m(&lurch), 0.8);
        assert_near(travelled_m(&lurch, 0.01), 0.8);
    }

    #[test]
    fn no_score_is_more_than_the_real_distance() {
        // The halves alone would be worth 8 m each.
        let corner = track(|t| (t.min(4.0), (t - 4.0).max(0.0)));
        assert_near(away_m(&corner), libm::sqrt(32.0));
        assert_near(travelled_m(&corner, 0.05), 8.0);
    }

    #[test]
    fn what_stays_within_a_ruler_travels_no_farther_than_that() {
        let trembling = track(|t| (0.4 * libm::cos(25.0 * t), 0.4 * libm::sin(25.0 * t)));
        let path: f64 = trembling.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        assert!(path > 60.0, "{path}");
        assert!(travelled_m(&trembling, 0.9) <= 0.8);
        assert!(away_m(&trembling) <= 0.8);
    }

    /// Heights of 81 moments.
    fn heights(at: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..81).map(|i| at(f64::from(i) * 0.1)).collect()
    }

    #[test]
    fn a_steady_climb_is_worth_its_height_wherever_it_began() {
        for start in [-3.0, 0.0, 4.0] {
            assert_near(climbed_m(&heights(|t| start + 0.2 * t)), 1.6);
        }
    }

    #[test]
    fn height_that_is_not_kept_is_worth_nothing() {
        assert_near(climbed_m(&heights(|t| t.min(8.0 - t))), 0.0);
        assert_near(climbed_m(&heights(|t| -0.3 * t)), 0.0);
        // What slid back halfway, and was climbed again, counts once.
        let twice = heights(|t| if t < 4.0 { 0.2 * t } else { 0.2 * t - 0.4 });
        assert_near(climbed_m(&twice), 0.8);
    }

    #[test]
    fn one_event_is_no_climb_whenever_it_comes() {
        for start in 0..=80 {
            let start = 0.1 * f64::from(start);
            // A limb that is drawn in, a fall uphill, a throw: over within four seconds.
            assert_near(climbed_m(&heights(|t| ((t - start) / 4.0).clamp(0.0, 1.0))), 0.0);
        }
        // Who leaps again and again, and is in the air at the end.
        assert!(climbed_m(&heights(|t| libm::sin(t * 1.9).abs())) < 0.03);
    }

    #[test]
    fn a_climb_of_hops_is_worth_the_height_that_lasts() {
        let hops = heights(|t| 0.2 * t + 0.3 * libm::sin(9.0 * t).abs());
        let climbed = climbed_m(&hops);
        assert!((1.3..1.9).contains(&climbed), "{climbed}");
    }

    #[test]
    fn an_empty_track_is_worth_nothing() {
        assert_eq!((away_m(&[]), travelled_m(&[], 1.0), climbed_m(&[])), (0.0, 0.0, 0.0));
    }
}
