"""What bodies climb: a grid of heights with walls around it, the same triangles as in islands.

A cell is two triangles that meet along the diagonal from its south-west to its north-east corner.
"""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

_HEADER = "islands-terrain-1,"
# Walls are so high above the highest point of the edge, and stop so far below the lowest point.
_WALL_M = 1.0
_WALL_THICKNESS_M = 1.0
# Bodies begin with so much room to the walls.
_ROOM_M = 0.05
# How many times as rough as a plane a terrain is.
ROUGHNESS = 4.0

# The course's mountain: src/simulation/terrain/mountain.rs.
_POINTS = 41
_STEP_M = 0.5
_HILL_M = 5.0
_WIDTH_M2 = 18.0
_ROCK_M = 0.1
_ROCKY_M = 1.0
_ROCKS_SEED = 20
_ROCKS_PURPOSE = 12


@dataclass(frozen=True)
class Wall:
    """A box."""

    centre_m: tuple[float, float, float]
    half_m: tuple[float, float, float]


@dataclass(frozen=True)
class Terrain:
    """Heights row by row from the south, each from the west, the middle of the grid at the origin."""

    heights_m: np.ndarray
    step_m: float
    start_m: tuple[float, float]

    @property
    def half_m(self) -> np.ndarray:
        """Half of its size along x and y."""
        rows, columns = self.heights_m.shape
        return np.array([columns - 1, rows - 1]) * self.step_m / 2

    def vertices_m(self) -> np.ndarray:
        """The points of the grid, row by row."""
        rows, columns = self.heights_m.shape
        y, x = np.mgrid[0:rows, 0:columns] * self.step_m
        return np.stack([x - self.half_m[0], y - self.half_m[1], self.heights_m], axis=-1).reshape(-1, 3)

    def triangles(self) -> np.ndarray:
        """Indices of vertices, seen counter-clockwise from above."""
        rows, columns = self.heights_m.shape
        south_west = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
        south_east, north_west, north_east = south_west + 1, south_west + columns, south_west + columns + 1
        lower = np.stack([south_west, south_east, north_east], axis=1)
        upper = np.stack([south_west, north_east, north_west], axis=1)
        return np.stack([lower, upper], axis=1).reshape(-1, 3)

    def walls(self) -> list[Wall]:
        """The four walls, their inner faces at the edge."""
        edge = (self.heights_m[0], self.heights_m[-1], self.heights_m[:, 0], self.heights_m[:, -1])
        top_m, bottom_m = max(map(np.max, edge)) + _WALL_M, self.heights_m.min() - _WALL_M
        middle_m, tall_m = (top_m + bottom_m) / 2, (top_m - bottom_m) / 2
        thick_m = _WALL_THICKNESS_M / 2
        walls = []
        for axis in (0, 1):
            half_m = self.half_m + 2 * thick_m
            half_m[axis] = thick_m
            for side in (-1, 1):
                centre_m = np.zeros(2)
                centre_m[axis] = side * (self.half_m[axis] + thick_m)
                walls.append(Wall((*centre_m, middle_m), (*half_m, tall_m)))
        return walls

    def height_m(self, x_m: float, y_m: float) -> float:
        """The height at a place; beyond the edge that of the nearest place within."""
        rows, columns = self.heights_m.shape
        column, u = _cell((x_m + self.half_m[0]) / self.step_m, columns)
        row, v = _cell((y_m + self.half_m[1]) / self.step_m, rows)
        south_west, north_east = self.heights_m[row, column], self.heights_m[row + 1, column + 1]
        if u >= v:
            corner = self.heights_m[row, column + 1]
            return float(south_west + u * (corner - south_west) + v * (north_east - corner))
        corner = self.heights_m[row + 1, column]
        return float(south_west + u * (north_east - corner) + v * (corner - south_west))

    def holds(self, place_m: np.ndarray) -> bool:
        """Whether a place is within the walls."""
        return bool((np.abs(place_m[:2]) <= self.half_m).all())

    def root_start_m(self, lows_m: np.ndarray, highs_m: np.ndarray, above_m: float) -> np.ndarray:
        """Where a root begins, given the boxes around all links from it: src/simulation/terrain/standing.rs."""
        low_m, high_m = lows_m.min(axis=0).clip(max=0.0), highs_m.max(axis=0).clip(min=0.0)
        least_m = _ROOM_M - self.half_m - low_m[:2]
        most_m = self.half_m - _ROOM_M - high_m[:2]
        # What is wider than the arena stands in its middle.
        at_m = np.where(least_m < most_m, np.clip(self.start_m, least_m, most_m), 0.0)
        boxes = zip(lows_m, highs_m)
        lifts_m = [self._highest_m(at_m + low[:2], at_m + high[:2]) - low[2] for low, high in boxes]
        return np.array([*at_m, max(lifts_m) + above_m])

    def _highest_m(self, low_m: np.ndarray, high_m: np.ndarray) -> float:
        rows, columns = self.heights_m.shape
        (west, south), (east, north) = (
            [_cell(place / self.step_m, points)[0] for place, points in zip(at_m + self.half_m, (columns, rows))]
            for at_m in (low_m, high_m)
        )
        return float(self.heights_m[south : north + 2, west : east + 2].max())

    def text(self) -> str:
        """As a run keeps it and the program reads it."""
        rows, columns = self.heights_m.shape
        head = f"{_HEADER}{columns},{rows},{self.step_m!r},{self.start_m[0]!r},{self.start_m[1]!r}"
        return "\n".join([head, *(",".join(str(np.float32(it)) for it in row) for row in self.heights_m)]) + "\n"


def _cell(at: float, points: int) -> tuple[int, float]:
    """The cell of a place that is measured in cells, and where in it: from 0 to 1."""
    at = min(max(at, 0.0), points - 1.0)
    index = min(int(at), points - 2)
    return index, at - index


def read(file: Path) -> Terrain:
    """The terrain that a run keeps."""
    head, *rows = file.read_text().splitlines()
    if not head.startswith(_HEADER):
        raise ValueError(f"{file} is no grid of heights as runs keep them")
    _, _, step_m, x_m, y_m = map(float, head.removeprefix(_HEADER).split(","))
    return Terrain(np.array([[float(height) for height in row.split(",")] for row in rows]), step_m, (x_m, y_m))


def mountain() -> Terrain:
    """The course's mountain with its rocks, as the program builds it."""
    place_m = (np.arange(_POINTS) - (_POINTS - 1) / 2) * _STEP_M
    x_m, y_m = np.meshgrid(place_m, place_m)
    hill_m = _HILL_M * np.exp(-(x_m**2 + y_m**2) / _WIDTH_M2)
    rocks = _drawn(_ROCKS_SEED, _ROCKS_PURPOSE, _POINTS**2).reshape(hill_m.shape)
    heights_m = hill_m + _ROCK_M * rocks * (hill_m / _ROCKY_M).clip(max=1.0)
    return Terrain(heights_m.astype(np.float32).astype(float), _STEP_M, (0.0, -0.35 * (_POINTS - 1) * _STEP_M))


def _drawn(seed: int, purpose: int, count: int) -> np.ndarray:
    """Numbers from 0 to 1, as the program draws them at this address: ChaCha with 8 rounds, see src/rng.rs."""
    key = struct.unpack("<8I", struct.pack("<QIIII", seed, 0, 0, 0, purpose) + b"islands1")
    blocks = np.arange(-(-count // 8), dtype=np.uint32)
    words = [*struct.unpack("<4I", b"expand 32-byte k"), *key, None, 0, 0, 0]
    first = [blocks if word is None else np.full_like(blocks, word) for word in words]
    state = list(first)
    for _ in range(4):
        for a in range(4):
            _quarter_round(state, a, a + 4, a + 8, a + 12)
        for a in range(4):
            _quarter_round(state, a, (a + 1) % 4 + 4, (a + 2) % 4 + 8, (a + 3) % 4 + 12)
    drawn = np.stack([end + begin for end, begin in zip(state, first)], axis=1).astype(np.uint64).reshape(-1, 2)
    return ((drawn[:, 1] << np.uint64(32) | drawn[:, 0]) >> np.uint64(11)).astype(float)[:count] * 2.0**-53


def _quarter_round(state: list[np.ndarray], a: int, b: int, c: int, d: int) -> None:
    for to, add, turned, bits in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        state[to] = state[to] + state[add]
        mixed = state[turned] ^ state[to]
        state[turned] = mixed << np.uint32(bits) | mixed >> np.uint32(32 - bits)
