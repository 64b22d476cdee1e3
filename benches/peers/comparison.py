"""The parts of the comparison, put together: figures, and the tables that show them."""

import dataclasses
import math
import subprocess
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import agreement
import creatures
import engines
import environment
import report
import speed
from agreement import Moves
from creatures import Creature
from report import Table


@dataclass(frozen=True)
class Plan:
    """What is to be compared."""

    islands: Path
    seed: int
    rounds: int
    # Of "speed", "agreement" and "hand".
    parts: tuple[str, ...]
    # The folder of the bodies made by hand.
    hand_made: Path


def compare(plan: Plan, folder: Path) -> tuple[dict[str, Any], list[Table]]:
    """All figures and their tables; genomes are written into a folder."""
    facts = environment.machine() | _versions(plan.islands)
    figures: dict[str, Any] = {"machine": facts, "seed": plan.seed, "rounds": plan.rounds}
    tables = [report.facts_table(facts)]
    if "speed" in plan.parts or "agreement" in plan.parts:
        _add_mixed_set(plan, folder, figures, tables)
    if "hand" in plan.parts:
        made = agreement.hand_made(plan.hand_made)
        figures["hand_made"] = _plain(made)
        tables.append(report.hand_made_table(made))
    return figures, tables


def _add_mixed_set(plan: Plan, folder: Path, figures: dict[str, Any], tables: list[Table]) -> None:
    programs = engines.engines_of(plan.islands)
    mixed = creatures.mixed_set(plan.islands, folder, plan.seed)
    moves = agreement.moves(mixed, programs)
    figures["creatures"] = [_creature(creature, moves, i) for i, creature in enumerate(mixed)]
    tables.append(report.soundness_table(moves))
    if "speed" in plan.parts:
        whole = [c for i, c in enumerate(mixed) if all(of.sound[i] for of in moves.values())]
        subsets = speed.measure(speed.batches(whole), engines.timed_of(plan.islands), plan.rounds)
        figures["speed"] = _plain(subsets)
        tables += report.speed_tables(subsets, plan.rounds)
    if "agreement" in plan.parts:
        correlations = agreement.correlations(moves)
        figures["correlations"] = _plain(correlations)
        tables.append(report.correlation_table(correlations))


def _creature(creature: Creature, moves: dict[str, Moves], index: int) -> dict[str, Any]:
    def of(engine: Moves) -> dict[str, Any]:
        values = {"displacement_m": engine.displacement_m[index], "path_m": engine.path_m[index]}
        numbers = {key: float(value) if math.isfinite(value) else None for key, value in values.items()}
        return numbers | {"sound": bool(engine.sound[index])}

    facts = {"genome": creature.genome.name, "genes": creature.genes, "links": creature.links}
    return facts | {name: of(engine) for name, engine in moves.items()}


def _plain(found: list[Any]) -> list[dict[str, Any]]:
    return [dataclasses.asdict(one) for one in found]


def _versions(islands: Path) -> dict[str, str]:
    printed = subprocess.run([islands, "--version"], capture_output=True, text=True, check=True).stdout
    return {"islands": printed.split()[-1]} | {name: version(name) for name in ("pybullet", "mujoco", "numpy")}
