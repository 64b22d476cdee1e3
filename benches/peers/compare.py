#!/usr/bin/env python3
"""Compares `islands` with PyBullet and MuJoCo: the same creatures, in turn, on one core.

    cargo build --release
    python3 benches/peers/compare.py

Needs Python 3.11 or newer, Linux, and the network when run for the first time. A run takes two minutes or more.

Installs the peers (requirements.txt) in a virtual environment of its own, draws random creatures of the course from a
fixed seed (30 of 3 genes, 10 of 6, 10 of 10, none with more than 30 links: the mixed set; the first 30 are the 3-gene
set), and has every engine simulate each for 2,400 steps of 1/240 s: dropped from 2.5 m on a plane, gravity 10 m/s²,
each hinge driven at up to 1 rad/s with up to 5 N·m, a new target speed every 24 steps, links that touch the ground
(friction 0.5 × 0.5) and not each other.

Each is used as its users use it:

PyBullet  As the course teaches it: DIRECT, loadURDF, default settings of the engine, a call of stepSimulation a step,
          setJointMotorControl2(VELOCITY_CONTROL, force=5) for each joint at each motor update, and the root's position
          asked for after every step.
MuJoCo    The implicitfast integrator, which its manual recommends for velocity servos; otherwise its default solver
          (Newton, up to 100 iterations, pyramidal cones) and contacts. Velocity servos of gain {gain} N·m·s/rad
          whose force is limited, joints without friction or damping, an armature of {armature} kg·m². From one motor
          update to the next is a single call of mj_step with nstep=24, so that Python costs nothing.
          Hurried, it has half as many steps, and few iterations: only its speed is compared.
islands   `islands evaluate --profile coursework --task course --threads 1`, with each engine that it has;
          of its own one also the speed of trials that go side by side: eight of a body, each perturbed (`--robustness`).

Only the simulation is timed: neither the start of processes, nor the reading of files. Of the peers it is the loop of
steps alone; of islands the `wall_seconds` that it prints, which include making the body out of the genome. A trial that
an engine ends early (islands ends one that blows up, with a named outcome; MuJoCo puts such a body back to the start;
PyBullet goes on with numbers that are none) takes less time than a whole one: so a first round without a clock tries
all creatures in all engines, and those that one of them does not bring to the end are left out of the speed of all.

The rounds are interleaved, batch by batch, and ratios are taken within a round, so that a busy machine disturbs them
little; nevertheless let it rest.

Agreement is told by Spearman's rank correlation between each pair of engines over the mixed set, of the root's
displacement (in space, from after the first step, as the course has it) and of the length of its path over the ground
(sampled every 0.1 s; of islands it is in `cargo bench --bench survey -- engines`). The bodies made by hand (tests/fixtures/physics/hand) start at their
own height; their distance is over the ground, their path in space and sampled at every step.
"""

import argparse
import json
import os
import tempfile
from pathlib import Path

import bodies
import environment

ROOT = Path(__file__).resolve().parents[2]
HAND_MADE = ROOT / "tests/fixtures/physics/hand"
PARTS = ("speed", "agreement", "hand")


def main() -> None:
    """Does what the command line asks for."""
    arguments = _arguments()
    environment.enter(arguments.venv.absolute())
    environment.stay_on(arguments.core)
    # Only the virtual environment has what this imports.
    import comparison

    # The peers write files where they are.
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        plan = comparison.Plan(
            arguments.islands.absolute(), arguments.seed, arguments.rounds, tuple(arguments.parts), HAND_MADE
        )
        figures, tables = comparison.compare(plan, Path(folder))
        os.chdir(ROOT)
    if arguments.json:
        print(json.dumps(figures))
    else:
        print("\n".join(table.markdown() if arguments.markdown else table.text() for table in tables))


def _arguments() -> argparse.Namespace:
    description = (__doc__ or "").format(gain=bodies.MUJOCO_GAIN, armature=bodies.MUJOCO_ARMATURE)
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--islands", type=Path, default=ROOT / "target/release/islands", metavar="PROGRAM", help="the program")
    add("--venv", type=Path, default=ROOT / "target/peers-venv", metavar="FOLDER", help="the virtual environment")
    add("--rounds", type=int, default=5, metavar="N", help="rounds that are timed (default 5)")
    add("--seed", type=int, default=1, metavar="N", help="seed of the creatures (default 1)")
    add("--core", type=int, default=environment.last_core(), metavar="N", help="the core (default: the last one)")
    add("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what to compare (default: everything)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--markdown", action="store_true", help="print tables as they go into a document")
    form.add_argument("--json", action="store_true", help="print all figures as one JSON object")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds must be at least 1")
    if not os.access(arguments.islands, os.X_OK):
        parser.error(f"{arguments.islands} is not there: cargo build --release, or name it with --islands")
    return arguments


if __name__ == "__main__":
    main()
