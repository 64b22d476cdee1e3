"""What runs, and files of champions, say that a champion is worth."""

import argparse
import csv
import json
import shlex
import sys
import time
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import terrain
from program import Islands
from terrain import Terrain

# What a summary says that its champion is worth, the most careful first: on trials that nothing was selected by, in the
# engine of record, in the engine that evolved it.
_CLAIMS = ("validated", "best_confirmed", "best_fitness")


@dataclass(frozen=True)
class Claim:
    """A champion, and how far it is said to get."""

    name: str
    genome: Path
    claim_m: float
    task: str
    engine: str
    # How its genome is read, as the program takes it.
    options: tuple[str, ...]
    # What it stands on, if that is no plane, and whether that is the course's mountain.
    terrain: Terrain | None
    is_on_mountain: bool
    # What the run took, if it is one.
    seconds: float | None = None


class NoClaim(Exception):
    """Why there is none to check, for people."""


def claimed_m(summary: dict) -> float:
    """What a run claims of its champion. The one place that knows the names in summary.json."""
    found = [summary[name] for name in _CLAIMS if summary.get(name) is not None]
    if not found:
        raise NoClaim(f"summary.json has none of {', '.join(_CLAIMS)}")
    # The most negative number there is says that nothing could be scored.
    return max(0.0, float(found[0]))


def of_run(folder: Path, seconds: float | None = None) -> Claim:
    """The claim of a run that has finished."""
    try:
        config = tomllib.loads((folder / "run.toml").read_text())
        summary = json.loads((folder / "summary.json").read_text())
    except (OSError, ValueError) as error:
        raise NoClaim(f"{folder} is no run that has finished: {error}") from error
    # The file of an old run has no sections.
    config |= config.get("creatures", {})
    if config.get("problem", "creatures") != "creatures":
        raise NoClaim(f"{folder} evolved no creatures but {config['problem']}")
    genome = folder / "champion.csv"
    if not genome.exists():
        raise NoClaim(f"{genome} is missing")
    task = config["task"]
    options = ["--profile", config["profile"], "--max-links", str(config["max-links"])]
    for name, scale in config.get("scales", {}).items():
        options += ["--scale", f"{name}={scale!r}"]
    kept = folder / "terrain.csv" if "terrain" in config else None
    seconds = summary.get("wall_seconds") if seconds is None else seconds
    engine = config.get("engine", "rapier")
    name = folder.resolve().name
    return Claim(name, genome, claimed_m(summary), task, engine, tuple(options), *_ground(task, kept), seconds)


def _ground(task: str, file: Path | None) -> tuple[Terrain | None, bool]:
    """What bodies stand on, and whether it is the mountain."""
    if file is not None:
        return terrain.read(file), False
    return (terrain.mountain(), True) if task == "climb" else (None, False)


def of_new_runs(islands: Islands, seeds: Iterable[int], flags: str, folder: Path) -> list[Claim]:
    """Makes runs one after another, each in a folder of its own; those that are there already are not made again."""
    folder.mkdir(parents=True, exist_ok=True)
    said = folder / "flags.txt"
    if said.exists() and said.read_text() != flags:
        raise NoClaim(f"the runs in {folder} were made with --flags '{said.read_text()}': choose another --out")
    said.write_text(flags)
    return [_new_run(islands, seed, flags, folder / f"seed{seed}") for seed in seeds]


def _new_run(islands: Islands, seed: int, flags: str, out: Path) -> Claim:
    took = out.with_suffix(".seconds")
    if not took.exists():
        print(f"Evolving seed {seed} in {out}", file=sys.stderr)
        begun = time.monotonic()
        islands.evolve("--seed", str(seed), "--out", out, *shlex.split(flags))
        took.write_text(f"{time.monotonic() - begun:.1f}\n")
    return of_run(out, float(took.read_text()))


def of_fixtures(islands: Islands, folder: Path, flags: str) -> list[Claim]:
    """Champions in a folder. What they are worth stands in its claims.csv, or else the program evaluates them."""
    files = sorted(file for file in folder.glob("*.csv") if file.name != "claims.csv")
    if not files:
        raise NoClaim(f"{folder} has no champions: there is no *.csv")
    read = _flags(flags)
    said = folder / "claims.csv"
    try:
        claims_m = _said_m(said, files) if said.exists() else islands.evaluate(files, *shlex.split(flags))
    except (RuntimeError, OSError) as error:
        raise NoClaim(str(error)) from error
    options = ["--profile", read.profile, "--max-links", str(read.max_links)]
    options += [word for scale in read.scale for word in ("--scale", scale)]
    ground = _ground(read.task, read.terrain)
    for file in (file for file, claim_m in zip(files, claims_m) if claim_m is None):
        print(f"{file} is left out: the program refuses it a score", file=sys.stderr)
    return [
        Claim(file.stem, file, claim_m, read.task, read.engine, tuple(options), *ground)
        for file, claim_m in zip(files, claims_m)
        if claim_m is not None
    ]


def _said_m(file: Path, champions: list[Path]) -> list[float]:
    with file.open(newline="") as lines:
        said = {row["file"]: float(row["claim_m"]) for row in csv.DictReader(lines)}
    lost = [champion.name for champion in champions if champion.name not in said]
    lost += [name for name in said if name not in {champion.name for champion in champions}]
    if lost:
        raise NoClaim(f"{file} and the champions beside it do not fit: {', '.join(lost)}")
    return [said[champion.name] for champion in champions]


def _flags(flags: str) -> argparse.Namespace:
    """What flags of the program say of how a genome is read and tried; the rest is the program's own matter."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--task", default="walk")
    parser.add_argument("--profile", default="native")
    parser.add_argument("--engine", default="featherstone")
    parser.add_argument("--max-links", default="16")
    parser.add_argument("--scale", action="append", default=[])
    parser.add_argument("--terrain", type=Path)
    return parser.parse_known_args(shlex.split(flags))[0]


def require_the_same_mountain(islands: Islands, claim: Claim) -> None:
    """The mountain here must be the program's: on both a genome must have the same score to the last bit."""
    ours = islands.folder / "terrain.csv"
    ours.write_text(claim.terrain.text())
    options = (*claim.options, "--task", "climb")
    scores = [islands.evaluate([claim.genome], *options, *more) for more in ((), ("--terrain", str(ours)))]
    if scores[0] != scores[1]:
        raise NoClaim(f"the mountain is another one here than in the program: {claim.genome} gets {scores}")
