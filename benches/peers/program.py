"""The program itself: what it exports, what it says of bodies, and what it scores."""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np


# One trial of a body as it is, which nobody judges.
PLAIN = ("--robustness", "0", "--judged=false")


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

    def evaluate(self, files: Sequence[Path], *options: str) -> list[float | None]:
        """The scores of genomes that are read and tried alike; none for those that are refused."""
        genomes = json.loads(self._run("evaluate", *files, *options, "--json").splitlines()[-1])["genomes"]
        return [genome["fitness"] if genome["outcome"] == "scored" else None for genome in genomes]

    def motion(self, specimen: Specimen, task: str) -> np.ndarray:
        """How it moves in islands in one trial as it is: the poses of all links, 60 times a second."""
        file = self.export(specimen, "motion", "--task", task, *PLAIN)
        table = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
        links = int(table[:, 1].max()) + 1
        return table[:, 2:].reshape(-1, links, 7)

    def builds(self, specimen: Specimen) -> bool:
        """Whether a genome describes no more than may be built."""
        command = [self.program, "inspect", specimen.file, *specimen.options]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    def evolve(self, *options: str | Path) -> None:
        """Makes a run, which is neither watched nor filmed."""
        self._run("run", *options, "--no-monitor", "--quiet")

    def _run(self, *arguments: str | Path) -> str:
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"islands {' '.join(map(str, arguments))}: {done.stderr.strip()}")
        return done.stdout
