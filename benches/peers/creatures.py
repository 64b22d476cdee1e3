"""The creatures that all engines are given."""

import json
import random
import subprocess
from dataclasses import dataclass
from pathlib import Path

import bodies

PARAMETERS = 17
LINKS_MAX = 30
# Genes of a creature, and how many such creatures there are.
MIXED_SET = ((3, 30), (6, 10), (10, 10))


@dataclass(frozen=True)
class Creature:
    """A genome in a file, and its body."""

    genome: Path
    genes: int
    body: bodies.Body

    @property
    def links(self) -> int:
        """The number of its links."""
        return len(self.body.links)


def mixed_set(islands: Path, folder: Path, seed: int) -> list[Creature]:
    """Random creatures of the course, drawn until there are enough of at most 30 links."""
    draw = random.Random(seed)
    creatures = []
    for genes, count in MIXED_SET:
        found = 0
        while found < count:
            creature = _draw(draw, islands, folder / f"{genes}-genes-{found}.csv", genes)
            if creature is not None:
                creatures.append(creature)
                found += 1
    return creatures


def _draw(draw: random.Random, islands: Path, path: Path, genes: int) -> Creature | None:
    lines = ("".join(f"{draw.random()!r}," for _ in range(PARAMETERS)) for _ in range(genes))
    path.write_text("\n".join(lines) + "\n")
    inspect: list[str | Path] = [islands, "inspect", "--profile", "coursework", "--json", path]
    result = subprocess.run(inspect, capture_output=True, text=True, check=False)
    if result.returncode == 2:
        # More links than the program builds.
        return None
    result.check_returncode()
    body = bodies.from_inspection(json.loads(result.stdout))
    return Creature(path, genes, body) if len(body.links) <= LINKS_MAX else None
