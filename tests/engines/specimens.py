"""The genomes that the checks are made with."""

import random
from pathlib import Path

from program import Islands, Specimen

PROFILES = ("native", "lecture", "coursework")
PARAMETERS = 17


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
