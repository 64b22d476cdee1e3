"""How far champions get in other engines, and what that makes of what is claimed of them."""

import csv
import multiprocessing
import statistics
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import claims
import trials
from claims import Claim
from program import Islands, Specimen
from report import Table
from trials import ENGINES, USUAL, Body


@dataclass(frozen=True)
class Verdict:
    """A claim, and how far the champion got in each trial of each engine."""

    claim: Claim
    trials_m: dict[str, list[float]]

    def mean_m(self, engine: str) -> float:
        """How far it gets in an engine."""
        return statistics.fmean(self.trials_m[engine])

    @property
    def median_m(self) -> float:
        """How far it gets elsewhere: the median of the engines."""
        return statistics.median(map(self.mean_m, ENGINES))

    @property
    def ratio(self) -> float:
        """What of the claim holds."""
        return _share(self.median_m, self.claim.claim_m)


def _share(found_m: float, claim_m: float) -> float:
    """A claim of nothing is kept by whatever is found."""
    return found_m / claim_m if claim_m > 0 else 1.0


def judge(islands: Islands, found: Sequence[Claim], count: int, jobs: int) -> list[Verdict]:
    """Tries champions in all engines: in so many perturbed trials, or in one as it is."""
    if any(claim.is_on_mountain for claim in found):
        claims.require_the_same_mountain(islands, next(claim for claim in found if claim.is_on_mountain))
    bodies = [_body(islands, claim, index) for index, claim in enumerate(found)]
    indices: Sequence[int | None] = range(count) if count else [None]
    print(f"Trying {len(bodies)} champions, {max(1, count)} times in each engine", file=sys.stderr)
    plays = [(body, engine, index) for engine in reversed(ENGINES) for body in bodies for index in indices]
    # Engines have a state of their own, so every process is a fresh one.
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn")) as pool:
        scores = iter(list(pool.map(_play, *zip(*plays))))
    scored = {engine: [[next(scores) for _ in indices] for _ in bodies] for engine in reversed(ENGINES)}
    return [Verdict(claim, {engine: scored[engine][i] for engine in ENGINES}) for i, claim in enumerate(found)]


def _body(islands: Islands, claim: Claim, index: int) -> Body:
    folder = islands.folder / str(index)
    folder.mkdir()
    specimen = Specimen(claim.genome, claim.options)
    return trials.exported(Islands(islands.program, folder), specimen, claim.task, claim.terrain)


def _play(body: Body, engine: str, index: int | None) -> float:
    return trials.score_m(body, engine, USUAL if index is None else trials.perturbation(index))


def tables(found: Sequence[Verdict], count: int) -> list[Table]:
    """A row for each claim, and what they come to."""
    how = f"means of {count} perturbed trials" if count else "one trial as it is"
    head = ["champion", "task", "evolved in", "claim", *ENGINES, "median", "ratio", "seconds"]
    each = Table(f"How far champions get, in metres: {how}", head, [_row(verdict) for verdict in found])
    return [each, _summary(found)]


def _row(verdict: Verdict) -> list[str]:
    claim = verdict.claim
    numbers = [claim.claim_m, *map(verdict.mean_m, ENGINES), verdict.median_m, verdict.ratio]
    seconds = "—" if claim.seconds is None else f"{claim.seconds:.0f}"
    return [claim.name, claim.task, claim.engine, *(f"{number:.2f}" for number in numbers), seconds]


def _summary(found: Sequence[Verdict]) -> Table:
    figures = {"claim, m": [verdict.claim.claim_m for verdict in found]}
    figures |= {f"{engine}, m": [verdict.mean_m(engine) for verdict in found] for engine in ENGINES}
    figures["median of the three, m"] = [verdict.median_m for verdict in found]
    for engine in ENGINES:
        figures[f"ratio {engine}"] = [_share(verdict.mean_m(engine), verdict.claim.claim_m) for verdict in found]
    figures["ratio of the median"] = [verdict.ratio for verdict in found]
    seconds = [verdict.claim.seconds for verdict in found if verdict.claim.seconds is not None]
    if seconds:
        figures["seconds"] = seconds
    shares = {"least": 0.0, "first quartile": 0.25, "median": 0.5, "third quartile": 0.75, "greatest": 1.0}
    rows = [[name, *(f"{np.quantile(of, share):.2f}" for share in shares.values())] for name, of in figures.items()]
    return Table(f"Of {len(found)} champions", ["", *shares], rows)


def write(folder: Path, found: Sequence[Verdict], shown: Sequence[Table]) -> None:
    """Writes truth.md, the tables, and truth.csv, with all trials."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "truth.md").write_text("\n".join(table.markdown() for table in shown))
    lines = [_line(verdict) for verdict in found]
    with (folder / "truth.csv").open("w", newline="") as file:
        out = csv.DictWriter(file, lines[0])
        out.writeheader()
        out.writerows(lines)


def _line(verdict: Verdict) -> dict[str, str | float | None]:
    """A line of truth.csv, by the names of its columns."""
    claim = verdict.claim
    names = {engine: engine.lower().replace(",", "").replace(" ", "_") for engine in ENGINES}
    said = {"champion": claim.name, "task": claim.task, "engine": claim.engine, "claim_m": claim.claim_m}
    means = {f"{name}_m": verdict.mean_m(engine) for engine, name in names.items()}
    comes_to = {"median_m": verdict.median_m, "ratio": verdict.ratio, "seconds": claim.seconds}
    each = {f"{name}_trials_m": " ".join(map(str, verdict.trials_m[engine])) for engine, name in names.items()}
    return said | means | comes_to | each
