#!/usr/bin/env python3
"""Says whether what runs claim of their champions holds in other engines.

    cargo build --release
    python3 benches/peers/truth.py runs/walk-seed7 runs/walk-seed8     runs that have finished
    python3 benches/peers/truth.py --seeds 1-20 --flags "--n 4" --out truth    makes twenty runs first, keeps them
    python3 benches/peers/truth.py --fixtures tests/fixtures/mean-walkers     files of champions

Needs Python 3.11 or newer, Linux, and the network when run for the first time: PyBullet and MuJoCo are installed in a
virtual environment of their own (requirements.txt).

Claim     What summary.json says that the champion is worth: `validated`, else `best_confirmed`, else `best_fitness`. Of
          --fixtures what stands in the folder's claims.csv (`file,claim_m`), else what `islands evaluate` says.
Engines   The champion is exported, and tried in PyBullet, in MuJoCo, and in MuJoCo with 1,920 steps a second, as
          islands tries it: it begins leaning by 5°, settles until it is at rest, and is scored by the task's rule.
Trials    Each figure is the mean of --trials perturbed trials (0: one trial as it is). They differ in friction (±25 %),
          the strength of the motors (±20 %), the side of the lean, a push of up to 0.3 m/s and the steps a second (200
          to 300, but always 1,920 in the third column), as with --robustness. They are drawn from a seed of their own:
          no champion was selected by them. All champions and engines face the same ones.
Ratio     The median of the three figures, as a share of the claim. Near 1 the claim is true; far below it the score was
          luck, or a fault of the engine that gave it.

A trial in which an engine's numbers break down, or the body leaves its terrain, counts as 0 m.

Settings  PyBullet: its defaults, the exported inertias, no damping, motors by VELOCITY_CONTROL of the exported torque,
          friction 0.5 × 0.5. MuJoCo: the exported model (implicitfast, elliptic cones, Newton, default contacts: a box
          on a slope half as steep as friction holds creeps by 0.3 mm/s) without its servos. Those give torque only for
          an error of the speed, so that motors are weaker than in islands and PyBullet; instead each motor is a
          constraint of bounded torque, as a joint's dry friction is, that aims at the motor's speed. No link touches
          another.
Terrains  Of --task climb and --terrain both engines get the grid of heights with the same triangles, walls, friction.
          The course's mountain is built here by its formula; that it is the program's own is checked by the program,
          which must give a champion the same score on both. Climbing is less certain than walking: neither engine
          smooths the edges between triangles, which islands' engines do.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import environment

ROOT = Path(__file__).resolve().parents[2]


def main() -> int:
    """Does what the command line asks for."""
    arguments = _arguments()
    try:
        environment.enter(arguments.venv.absolute())
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"error: PyBullet and MuJoCo cannot be installed in {arguments.venv}: {error}")
    # Only the virtual environment has what these import.
    import claims
    import verdicts
    from program import Islands

    with tempfile.TemporaryDirectory() as folder:
        islands = Islands(arguments.islands.absolute(), Path(folder))
        try:
            if arguments.seeds:
                made = (arguments.out or Path(folder)) / "runs"
                found = claims.of_new_runs(islands, arguments.seeds, arguments.flags, made)
            elif arguments.fixtures:
                found = claims.of_fixtures(islands, arguments.fixtures, arguments.flags)
            else:
                found = [claims.of_run(run) for run in arguments.runs]
            judged = verdicts.judge(islands, found, arguments.trials, arguments.jobs)
        except (claims.NoClaim, RuntimeError) as error:
            sys.exit(f"error: {error}")
    tables = verdicts.tables(judged, arguments.trials)
    print("\n".join(table.text() for table in tables))
    if arguments.out:
        verdicts.write(arguments.out, judged, tables)
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    what = parser.add_argument_group("what to check: one of these")
    what.add_argument("runs", nargs="*", type=Path, default=[], metavar="RUN_DIR", help="folders of finished runs")
    what.add_argument("--seeds", type=_seeds, metavar="A-B", help="make runs first: seeds such as 1-20 or 3,5,8")
    what.add_argument("--fixtures", type=Path, metavar="DIR", help="a folder of champions as CSV")
    add("--flags", default="", help="of --seeds: more flags of `islands run`; of --fixtures: of `islands evaluate`")
    add("--out", type=Path, metavar="DIR", help="write truth.md and truth.csv there, and keep the runs of --seeds")
    add("--trials", type=int, default=8, metavar="N", help="perturbed trials in each engine (default 8)")
    add("--jobs", type=int, default=os.cpu_count(), metavar="N", help="plays at a time (default: a core each)")
    add("--islands", type=Path, default=ROOT / "target/release/islands", metavar="PROGRAM", help="the program")
    add("--venv", type=Path, default=ROOT / "target/peers-venv", metavar="DIR", help="the virtual environment")
    arguments = parser.parse_args()
    if sum(map(bool, (arguments.runs, arguments.seeds, arguments.fixtures))) != 1:
        parser.error("say what to check: run folders, --seeds or --fixtures")
    if arguments.trials < 0 or arguments.jobs < 1:
        parser.error("--trials must be at least 0, and --jobs at least 1")
    if not os.access(arguments.islands, os.X_OK):
        parser.error(f"{arguments.islands} is not there: cargo build --release, or name it with --islands")
    return arguments


def _seeds(text: str) -> list[int]:
    """Numbers and ranges, such as 1-5,9."""
    seeds: list[int] = []
    try:
        for part in text.split(","):
            first, _, last = part.partition("-")
            seeds += range(int(first), int(last or first) + 1)
    except ValueError:
        seeds = []
    if not seeds:
        raise argparse.ArgumentTypeError(f"'{text}' names no seeds: say 1-20 or 3,5,8")
    return seeds


if __name__ == "__main__":
    sys.exit(main())
