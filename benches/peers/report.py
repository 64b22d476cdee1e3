"""Figures as tables, for a terminal or as Markdown."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from agreement import Correlation, HandMade, Moves
from engines import HURRIED, PEERS
from speed import Subset


@dataclass(frozen=True)
class Table:
    """A table; its first column is text."""

    title: str
    head: list[str]
    rows: list[list[str]]

    def markdown(self) -> str:
        """As it goes into a document."""
        lines = [self.head, ["---"] * len(self.head), *self.rows]
        return f"{self.title}\n\n" + "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"

    def text(self) -> str:
        """As a terminal shows it."""
        columns = list(zip(self.head, *self.rows))
        widths = [max(map(len, column)) for column in columns]
        lines = ["  ".join(_aligned(line, widths)) for line in [self.head, *self.rows]]
        return f"{self.title}\n" + "\n".join(line.rstrip() for line in lines) + "\n"


def _aligned(line: Sequence[str], widths: Sequence[int]) -> Iterable[str]:
    yield line[0].ljust(widths[0])
    for cell, width in zip(line[1:], widths[1:]):
        yield cell.rjust(width)


def facts_table(facts: dict[str, str]) -> Table:
    """Machine and versions."""
    return Table("Machine and versions", ["what", "which"], [[what, which] for what, which in facts.items()])


def soundness_table(moves: dict[str, Moves]) -> Table:
    """How many creatures each engine brings to the end of their trial."""
    rows = [[name, str(of.sound.sum()), str(len(of.sound))] for name, of in moves.items()]
    return Table("Trials that ran to their end, in the mixed set", ["engine", "to the end", "of"], rows)


def speed_tables(subsets: list[Subset], rounds: int) -> list[Table]:
    """What was timed: evaluations and steps a second, and ratios."""
    engines = list(subsets[0].seconds)
    peers = [*PEERS, *HURRIED]
    ours = [engine for engine in engines if engine not in peers]
    pairs = [(engine, peer) for engine in ours for peer in peers]
    rows = [[subset.name, str(subset.creatures)] for subset in subsets]
    of_rounds = "1 round" if rounds == 1 else f"{rounds} rounds"
    return [
        Table(
            f"Trials a second, median of {of_rounds}",
            ["creatures", "number", *engines],
            [row + [_three(subset.evaluations_per_s(e)) for e in engines] for row, subset in zip(rows, subsets)],
        ),
        Table(
            f"Steps a second, median of {of_rounds}",
            ["creatures", "number", *engines],
            [row + [f"{subset.steps_per_s(e):,.0f}" for e in engines] for row, subset in zip(rows, subsets)],
        ),
        Table(
            f"How many times as fast, median of the ratios of {of_rounds}, and their range",
            ["creatures", "number", *(f"{engine} : {peer}" for engine, peer in pairs)],
            [row + [_ratio(subset, *pair) for pair in pairs] for row, subset in zip(rows, subsets)],
        ),
    ]


def _ratio(subset: Subset, engine: str, peer: str) -> str:
    least, most = subset.ratio_range(engine, peer)
    return f"{_three(subset.ratio(engine, peer))} ({_three(least)}–{_three(most)})"


def _three(value: float) -> str:
    """Three digits."""
    return f"{value:.0f}" if value >= 100 else f"{value:#.3g}"


def correlation_table(correlations: list[Correlation]) -> Table:
    """What the engines agree on."""

    def cell(value: float | None) -> str:
        return "—" if value is None else f"{value:.3f}"

    return Table(
        "Rank correlation over the mixed set: displacement in space, path over the ground",
        ["engines", "creatures", "displacement", "path"],
        [[" : ".join(c.engines), str(c.creatures), cell(c.displacement), cell(c.path)] for c in correlations],
    )


def hand_made_table(found: list[HandMade]) -> Table:
    """What the peers say of the bodies made by hand."""
    names = list(dict.fromkeys(made.body for made in found))
    by_name = {(made.body, made.peer): made for made in found}

    def row(name: str) -> list[str]:
        of_peers = [by_name[name, peer] for peer in PEERS]
        distances = [f"{made.distance_m:.3f}" for made in of_peers]
        return [name, *distances, *(f"{made.path_m:.3f}" for made in of_peers)]

    return Table(
        "Bodies made by hand: distance over the ground, and path in space, after 10 s",
        ["body", *(f"{peer} distance m" for peer in PEERS), *(f"{peer} path m" for peer in PEERS)],
        [row(name) for name in names],
    )
