"""What islands exports, and what it says of it."""

import json
import random
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

PROFILES = ("native", "lecture", "coursework")
PARAMETERS = 17


@dataclass(frozen=True)
class Specimen:
    """A genome or a body, and how islands reads it."""

    file: Path
    options: tuple[str, ...] = ()


class Islands:
    """The program, writing into a folder."""

    def __init__(self, program: Path, folder: Path) -> None:
        """The program at a path."""
        self.program = program
        self.folder = folder

    def export(self, specimen: Specimen, form: str, *options: str) -> Path:
        """Writes a specimen in a format."""
        out = self.folder / f"{specimen.file.stem}.exported.{form}"
        self._run("export", specimen.file, *specimen.options, *options, "--format", form, "--out", out)
        return out

    def inspect(self, body: Path) -> dict:
        """What islands itself says of a body."""
        return json.loads(self._run("inspect", body, "--json"))

    def motion(self, specimen: Specimen, task: str) -> np.ndarray:
        """How it moves in islands: the poses of all links, 60 times a second."""
        table = np.loadtxt(self.export(specimen, "motion", "--task", task), delimiter=",", skiprows=1, ndmin=2)
        links = int(table[:, 1].max()) + 1
        return table[:, 2:].reshape(-1, links, 7)

    def builds(self, specimen: Specimen) -> bool:
        """Whether a genome describes no more than may be built."""
        command = [self.program, "inspect", specimen.file, *specimen.options]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    def _run(self, *arguments: str | Path) -> str:
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"islands {' '.join(map(str, arguments))}: {done.stderr.strip()}")
        return done.stdout


def random_genomes(islands: Islands, count: int) -> list[Specimen]:
    """Random genomes of one to six genes, of each profile in turn, that can be built."""
    chance = random.Random(67)
    specimens: list[Specimen] = []
    while len(specimens) < count:
        number = len(specimens)
        lines = (
            ",".join(repr(chance.random()) for _ in range(PARAMETERS)) for _ in range(1 + number // len(PROFILES) % 6)
        )
        file = islands.folder / f"random_{number}.csv"
        file.write_text("\n".join(lines))
        specimen = Specimen(file, ("--profile", PROFILES[number % len(PROFILES)]))
        if islands.builds(specimen):
            specimens.append(specimen)
    return specimens


def genomes_of_the_course(fixtures: Path) -> list[Specimen]:
    """The course's genomes."""
    return [Specimen(file, ("--profile", "coursework")) for file in sorted((fixtures / "course").glob("genome_*.csv"))]


def walkers(folder: Path) -> list[Specimen]:
    """Champions that were evolved to walk."""
    files = sorted(folder.glob("*.csv"), key=lambda file: int(file.stem.split("_")[-1]))
    return [Specimen(file) for file in files]
