"""How fast the engines are, in interleaved rounds.

A batch is a few creatures with as many genes and about as many links. All engines take a batch in turn, the first one
another in each round, so that what else the machine does hits them alike; ratios are taken within a round.
"""

import statistics
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bodies
from creatures import Creature
from engines import HURRIED, PEERS, Islands, Trial

# The largest number of links of each class that tables show.
CLASSES = ((1, 2), (3, 4), (5, 6), (7, 9), (10, 14), (15, 21), (22, 30))


@dataclass(frozen=True)
class Batch:
    """Creatures that are tried together."""

    genes: int
    links: tuple[int, int]
    creatures: tuple[Creature, ...]


@dataclass(frozen=True)
class Subset:
    """A row of the tables."""

    name: str
    creatures: int
    # Seconds of each engine in each round.
    seconds: dict[str, list[float]]

    def evaluations_per_s(self, engine: str) -> float:
        """The median over the rounds."""
        return statistics.median(self.creatures / seconds for seconds in self.seconds[engine])

    def steps_per_s(self, engine: str) -> float:
        """The median over the rounds."""
        return self.evaluations_per_s(engine) * bodies.STEPS

    def ratio(self, engine: str, to: str) -> float:
        """How many times as fast as another: the median of the rounds' ratios."""
        return statistics.median(b / a for a, b in zip(self.seconds[engine], self.seconds[to]))

    def ratio_range(self, engine: str, to: str) -> tuple[float, float]:
        """The least and the greatest of the rounds' ratios."""
        ratios = [b / a for a, b in zip(self.seconds[engine], self.seconds[to])]
        return min(ratios), max(ratios)


def batches(creatures: list[Creature]) -> list[Batch]:
    """Sorts creatures into batches."""
    all_genes = sorted({creature.genes for creature in creatures})
    found = [
        Batch(genes, links, tuple(c for c in creatures if c.genes == genes and links[0] <= c.links <= links[1]))
        for genes in all_genes
        for links in CLASSES
    ]
    return [batch for batch in found if batch.creatures]


def measure(work: list[Batch], programs: list[Islands], rounds: int) -> list[Subset]:
    """Times every engine on every batch, and sums it up by sets and by numbers of links."""
    timers = {name: _peer_timer(peer) for name, peer in (PEERS | HURRIED).items()}
    timers |= {program.name: _program_timer(program) for program in programs}
    seconds: dict[tuple[Batch, str], list[float]] = {(b, name): [] for b in work for name in timers}
    for round_number in range(rounds):
        print(f"Round {round_number + 1} of {rounds}", file=sys.stderr)
        names = _rotated(list(timers), round_number)
        for batch in work:
            for name in names:
                seconds[batch, name].append(timers[name](batch))
    return [_subset(name, chosen, seconds, list(timers)) for name, chosen in _rows(work)]


def _peer_timer(peer: Callable[..., Trial]) -> Callable[[Batch], float]:
    return lambda batch: sum(peer(creature.body).seconds for creature in batch.creatures)


def _program_timer(program: Islands) -> Callable[[Batch], float]:
    return lambda batch: program.seconds_a_trial(batch.creatures)


def _rotated(names: list[str], by: int) -> list[str]:
    by %= len(names)
    return names[by:] + names[:by]


def _rows(work: list[Batch]) -> Iterator[tuple[str, list[Batch]]]:
    yield "mixed set", work
    yield "3-gene set", [batch for batch in work if batch.genes == 3]
    for links in CLASSES:
        chosen = [batch for batch in work if batch.links == links]
        if chosen:
            yield f"{links[0]}–{links[1]} links", chosen


def _subset(
    name: str, chosen: list[Batch], seconds: dict[tuple[Batch, str], list[float]], engines: list[str]
) -> Subset:
    def sums(engine: str) -> list[float]:
        return [sum(of_round) for of_round in zip(*(seconds[batch, engine] for batch in chosen))]

    count = sum(len(batch.creatures) for batch in chosen)
    return Subset(name, count, {engine: sums(engine) for engine in engines})
