"""How far the engines agree on what creatures do, and what the peers say of the bodies made by hand."""

import itertools
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import bodies
from creatures import Creature
from engines import PEERS, Islands, Trial


@dataclass(frozen=True)
class Moves:
    """What an engine says of each creature, NaN where it says nothing."""

    # Of the root, in space, from after the first step to the end: the course's fitness.
    displacement_m: np.ndarray
    # Of the root, over the ground, sampled every 0.1 s.
    path_m: np.ndarray
    # Whether the trial ran soundly to its end.
    sound: np.ndarray


@dataclass(frozen=True)
class Correlation:
    """Spearman's rank correlation of two engines, over the creatures that are sound in both."""

    engines: tuple[str, str]
    creatures: int
    displacement: float | None
    path: float | None


@dataclass(frozen=True)
class HandMade:
    """What a peer says of a body made by hand."""

    body: str
    peer: str
    # Of the root, over the ground, from after the first step to the end.
    distance_m: float
    # The length of the root's way in space, sampled at every step.
    path_m: float


def moves(creatures: Sequence[Creature], programs: Sequence[Islands]) -> dict[str, Moves]:
    """Tries all creatures once in all engines."""
    found = {}
    for name, try_in in PEERS.items():
        print(f"Trying {len(creatures)} creatures in {name}", file=sys.stderr)
        found[name] = _peer_moves([try_in(creature.body) for creature in creatures])
    for program in programs:
        print(f"Trying {len(creatures)} creatures in {program.name}", file=sys.stderr)
        _, scores = program.evaluate(creatures)
        found[program.name] = Moves(
            np.array([score.displacement_m for score in scores]),
            np.array([math.nan if score.path_m is None else score.path_m for score in scores]),
            np.array([score.sound for score in scores]),
        )
    return found


def _peer_moves(trials: list[Trial]) -> Moves:
    return Moves(
        np.array([float(np.linalg.norm(trial.positions_m[-1] - trial.positions_m[0])) for trial in trials]),
        np.array([_length(trial.positions_m[:, :2]) for trial in trials]),
        np.array([trial.sound for trial in trials]),
    )


def _length(positions_m: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(positions_m, axis=0), axis=1).sum())


def correlations(found: dict[str, Moves]) -> list[Correlation]:
    """Compares every pair of engines."""
    return [_correlation((a, b), found[a], found[b]) for a, b in itertools.combinations(found, 2)]


def _correlation(engines: tuple[str, str], a: Moves, b: Moves) -> Correlation:
    both = a.sound & b.sound
    return Correlation(
        engines,
        int(both.sum()),
        _spearman(a.displacement_m[both], b.displacement_m[both]),
        _spearman(a.path_m[both], b.path_m[both]),
    )


def _spearman(a: np.ndarray, b: np.ndarray) -> float | None:
    if len(a) < 3 or np.isnan(a).any() or np.isnan(b).any():
        return None
    return float(np.corrcoef(_ranks(a), _ranks(b))[0, 1])


def _ranks(values: np.ndarray) -> np.ndarray:
    """Ranks from 0; equal values share the mean of theirs."""
    below = (values[:, None] > values).sum(axis=1)
    equal = (values[:, None] == values).sum(axis=1)
    return below + (equal - 1) / 2


def hand_made(folder: Path) -> list[HandMade]:
    """Tries the bodies in a folder in the peers."""
    entries = json.loads((folder / "manifest.json").read_text())
    driven = [body for body in map(bodies.from_manifest, entries) if body.driven()]
    return [_hand_made(body, peer) for body in driven for peer in PEERS]


def _hand_made(body: bodies.Body, peer: str) -> HandMade:
    walked = PEERS[peer](body, every_step=True).positions_m
    distance_m = float(np.linalg.norm((walked[-1] - walked[0])[:2]))
    return HandMade(body.name, peer, distance_m, _length(walked))
