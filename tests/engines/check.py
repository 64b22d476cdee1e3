"""Checks what islands exports in other programs: PyBullet and ROS's parser read the URDF, MuJoCo the MJCF.

    cargo build --release && python3 tests/engines/check.py

The peers are installed into a virtual environment in the cache folder. It is checked that

- 200 random genomes and those of the course are bodies of the same links, masses, inertias and poses there, and valid
  by the rules of ROS's parser;
- bodies whose motion is not chaotic move alike: within 2 % in free fall, as a pendulum, with a driven hinge in the
  air, and sliding to rest;
- the rules that distances elsewhere are scored by are those of islands: they give its own films its own scores;
- what runs claim holds elsewhere: of the champions in tests/fixtures/truth three engines leave at least 75 % of what
  its claims.csv says, and 90 % in the median, as `benches/peers/truth.py --help` explains;

and reported how far walkers get in each engine. They are champions of twenty runs each of one island of 24, with
--engine featherstone:

- walkers: 40 generations, one trial a genome;
- long-walkers: 160 generations, one trial a genome;
- robust-walkers: 40 generations, four trials a genome, of which the worst counts: as many generations as the first,
  and as many trials as the second;
- mean-walkers: the same, but that the mean of the four counts.

Exits with 1 if a check fails.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "tests" / "fixtures"

sys.path.insert(0, str(ROOT / "benches" / "peers"))

import environment  # noqa: E402


def _arguments() -> argparse.Namespace:
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    cache = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=target / "release" / "islands")
    parser.add_argument("--env", type=Path, default=cache / "islands-ci" / "engines", help="the virtual environment")
    parser.add_argument("--genomes", type=int, default=200, help="random genomes to try")
    return parser.parse_args()


def _enter(folder: Path) -> None:
    try:
        environment.enter(folder)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"SKIPPED, NOTHING WAS CHECKED: the other programs cannot be installed in {folder}: {error}")
        sys.exit(0)


def main() -> int:
    """Runs every check."""
    arguments = _arguments()
    _enter(arguments.env)
    # Only in the environment there is something to import.
    import checks
    from program import Islands
    from specimens import genomes_of_the_course, random_genomes, walkers

    with tempfile.TemporaryDirectory() as folder:
        islands = Islands(arguments.program.resolve(), Path(folder))
        specimens = genomes_of_the_course(FIXTURES) + random_genomes(islands, arguments.genomes)
        failures = checks.same_bodies(islands, specimens)
        failures += checks.same_motion(islands)
        failures += checks.same_scores(islands, walkers(FIXTURES / "long-walkers")[:5])
        failures += checks.claims_hold(islands, FIXTURES / "truth", os.cpu_count() or 1)
        for kind in ("walkers", "long-walkers", "robust-walkers", "mean-walkers"):
            checks.report_walkers(islands, kind, walkers(FIXTURES / kind))
    for failure in failures:
        print(f"FAILED: {failure}")
    print(f"engines: {len(failures)} checks failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
