"""How far a body got by going: the rules of `src/problems/progress.rs`, which says why they are so.

A track has positions above the ground, or heights, a tenth of a second apart. All rules are pure.
"""

import numpy as np


def away_m(track_m: np.ndarray) -> float:
    """The distance from the first position to the last, but at most twice what is left without the best half."""
    whole = track_m[-1] - track_m[0]
    left = np.linalg.norm(whole - _halves(track_m), axis=1)
    return float(min(np.linalg.norm(whole), 2 * left.min()))


def travelled_m(track_m: np.ndarray, ruler_m: float) -> float:
    """The length of a track by a ruler, but at most twice what is left without the best half."""
    return _without_the_best_half(_lengths_m(track_m, ruler_m))


def climbed_m(heights_m: np.ndarray) -> float:
    """The height that was gained and kept, but at most twice what is left without the best half."""
    gained_m = heights_m - heights_m[0]
    kept_m = np.minimum.accumulate(gained_m[::-1])[::-1].clip(0.0)
    return _without_the_best_half(kept_m)


def _without_the_best_half(values: np.ndarray) -> float:
    left = values[-1] - _halves(values)
    return float(max(0.0, min(values[-1], 2 * left.min())))


def _halves(values: np.ndarray) -> np.ndarray:
    """By how much a track goes on in every run of half of its legs."""
    half = len(values) // 2
    return values[half:] - values[: len(values) - half]


def _lengths_m(track_m: np.ndarray, ruler_m: float) -> np.ndarray:
    """The length of a track up to each of its positions: ruler by ruler, then straight on."""
    mark_m, marked_m, lengths_m = track_m[0], 0.0, []
    for position_m in track_m:
        beyond_m = float(np.linalg.norm(position_m - mark_m))
        lengths_m.append(marked_m + beyond_m)
        if beyond_m >= ruler_m:
            mark_m, marked_m = position_m, lengths_m[-1]
    return np.array(lengths_m)
