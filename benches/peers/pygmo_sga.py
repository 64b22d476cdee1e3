#!/usr/bin/env python3
"""Compares the default genetic algorithm of `islands` with pygmo's `sga` in an archipelago of four, at equal budget.

    cargo build --release
    python3 benches/peers/pygmo_sga.py

Minimises Rastrigin and Ackley of 30 variables, ten seeds each, 500,000 evaluations a run, four islands
of 50 individuals that exchange on a ring every five generations. A run has succeeded when its error is at most 0.01;
how many evaluations that took is known of `islands` to a generation (200) and of pygmo to an exchange (1,000). pygmo's `sga` is run as it is by default, and
with the operators that ours has by default (simulated binary crossover, eta 15, of nine couples in ten; polynomial
mutation, eta 20, of one variable in 30; tournaments of 5); each island keeps its best, as sga does.

pygmo's own functions have their optimum in the middle of the domain, and its `translate` moves both together; that of
`islands` lies anywhere in the middle 80 %. None of the operators knows of a middle, so that this is a gift to pygmo only in
as far as random points are nearer to it. Needs the network when run for the first time, and some minutes.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import environment

ROOT = Path(__file__).resolve().parents[2]
BUDGET = 500_000
TARGET = 0.01
SEEDS = range(1, 11)
DIMENSIONS = 30
ISLANDS, POPULATION, INTERVAL = 4, 50, 5
FUNCTIONS = ("rastrigin", "ackley")
SETTINGS = {
    "sga, its defaults": {},
    "sga, our operators": {
        "cr": 0.9,
        "crossover": "sbx",
        "eta_c": 15.0,
        "m": 1 / DIMENSIONS,
        "mutation": "polynomial",
        "param_m": 20.0,
        "selection": "tournament",
        "param_s": 5,
    },
}


def evolve(task):
    """A run of pygmo: its least error, and after how many evaluations that was small enough."""
    import pygmo

    name, setting, seed = task
    pygmo.set_global_rng_seed(seed)
    algorithm = pygmo.algorithm(pygmo.sga(gen=INTERVAL, seed=seed, **SETTINGS[setting]))
    problem = pygmo.problem(getattr(pygmo, name)(DIMENSIONS))
    ring = pygmo.topology(pygmo.ring(w=1.0))
    archipelago = pygmo.archipelago(n=ISLANDS, algo=algorithm, prob=problem, pop_size=POPULATION, seed=seed, t=ring)
    best, reached, evaluations = float("inf"), None, ISLANDS * POPULATION
    while evaluations < BUDGET:
        archipelago.evolve()
        archipelago.wait_check()
        best = min(champion[0] for champion in archipelago.get_champions_f())
        evaluations = sum(island.get_population().problem.get_fevals() for island in archipelago)
        if reached is None and best <= TARGET:
            reached = evaluations
    return best, reached


def ours(program, name):
    """Our runs: their least errors, and after how many evaluations those were small enough."""
    definition = (
        f'seeds = {len(SEEDS)}\nevaluations = {BUDGET}\ntarget = {-TARGET}\n'
        f'[base]\nproblem = "{name}"\ndimensions = {DIMENSIONS}\n'
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "experiment.toml")
        file.write_text(definition)
        out = Path(folder, "out")
        subprocess.run([program, "experiment", file, "--out", out, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        rows = [line.split(",") for line in (out / "runs.csv").read_text().splitlines()]
    best, reached = (rows[0].index(column) for column in ("best", "evaluations_to_target"))
    return [(-float(row[best]), int(row[reached]) if row[reached] else None) for row in rows[1:]]


def row(name, algorithm, runs):
    """A row of the table."""
    reached = sorted(run[1] for run in runs if run[1] is not None)
    median = f"{statistics.median(reached):,.0f}" if len(reached) > len(runs) / 2 else "–"
    errors = statistics.median(run[0] for run in runs)
    return f"| {name} | {algorithm} | {len(reached)} of {len(runs)} | {median} | {errors:.2g} |"


def main():
    """Runs everything and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--venv", type=Path, default=ROOT / "target/peers-venv", help="the virtual environment")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/islands", help="the program")
    parser.add_argument("--processes", type=int, default=None, help="runs of pygmo at a time [default: all cores]")
    arguments = parser.parse_args()
    environment.enter(arguments.venv.absolute())
    print(json.dumps(environment.machine()))
    print("| function | algorithm | runs within 0.01 | evaluations that took, median | error in the end, median |")
    print("|---|---|---|---|---|")
    for name in FUNCTIONS:
        print(row(name, "islands", ours(arguments.program, name)), flush=True)
        with ProcessPoolExecutor(arguments.processes) as pool:
            for setting in SETTINGS:
                runs = list(pool.map(evolve, [(name, setting, seed) for seed in SEEDS]))
                print(row(name, setting, runs), flush=True)


if __name__ == "__main__":
    main()
