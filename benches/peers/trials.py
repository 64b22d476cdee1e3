"""Trials of champions in other engines, as `islands` tries its bodies: it begins leaning, comes to rest, and is scored.

Each trial differs from the task's in what `src/simulation/perturbation.rs` lets differ: the friction, the strength of
the motors, the side that the body leans to, a push, and the steps a second. The ranges are the same, the draws are not:
no champion was ever selected by these trials.
"""

import dataclasses
import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import progress
from in_mujoco import DrivenInMuJoCo
from in_pybullet import InPyBullet
from players import GRIP, Motor, Player, Trial, motors_of, moving
from program import Islands, Specimen
from terrain import ROUGHNESS, Terrain

# The trials' own draws; another number, other trials.
SEED = 2_026
FINE_STEPS_PER_S = 1_920
ENGINES = ("PyBullet", "MuJoCo", "MuJoCo 1,920 Hz")

TRACK_SAMPLE_S = 0.1
_FRICTION_SHARE = 0.25
_TORQUE_SHARE = 0.2
_PUSH_M_S_MAX = 0.3
_PUSH_SHARES = (0.5, 0.9)
_STEPS_PER_S = (200, 300)
_TERRAIN_YAW_RAD = 0.2
# 5°, to a side that is neither along a body's axes nor halfway between them: src/simulation/assembly.rs.
_LEAN_RAD = math.tau / 72
_LEAN_AXIS = (1.0, 0.6, 0.0)
# src/simulation/settling.rs.
_ROUNDS_MAX = 10
_REST_M_S = 0.05
_REST_S = 0.1


@dataclass(frozen=True)
class Task:
    """What a body has to do, and how it is tried."""

    gravity_m_s2: float
    settle_s: float
    scored_s: float
    # How high its lowest point begins or, if it is dropped as it is, its root.
    start_m: float
    is_dropped: bool
    score: Callable[["Walk"], float]


@dataclass(frozen=True)
class Walk:
    """What was measured while a body was scored."""

    # Of the root after the very first step and at the end.
    root_first_m: np.ndarray
    root_last_m: np.ndarray
    # Of the centre of mass above the ground, every tenth of a second.
    track_m: np.ndarray
    # Of the lowest point, but at most of the ground below the centre of mass; on a terrain.
    heights_m: np.ndarray
    extent_m: float


TASKS = {
    "walk": Task(9.81, 0.5, 8.0, 0.1, False, lambda walk: progress.away_m(walk.track_m)),
    "travel": Task(9.81, 0.5, 8.0, 0.1, False, lambda walk: progress.travelled_m(walk.track_m, walk.extent_m)),
    "climb": Task(9.81, 0.5, 8.0, 0.1, False, lambda walk: progress.climbed_m(walk.heights_m)),
    "course": Task(10.0, 0.0, 10.0, 2.5, True, lambda walk: math.dist(walk.root_last_m, walk.root_first_m)),
}


@dataclass(frozen=True)
class Perturbation:
    """What differs from the usual."""

    friction: float = 1.0
    torque: float = 1.0
    yaw_rad: float = 0.0
    push_m_s: tuple[float, float, float] = (0.0, 0.0, 0.0)
    # The moment of the push, as a share of the scored time.
    push_share: float = 0.5
    steps_per_s: int = 240


USUAL = Perturbation()


def perturbation(index: int) -> Perturbation:
    """What differs in the trial of an index, for all bodies and engines alike."""
    draw = random.Random(f"{SEED}/{index}")
    friction = 1 + draw.uniform(-_FRICTION_SHARE, _FRICTION_SHARE)
    torque = 1 + draw.uniform(-_TORQUE_SHARE, _TORQUE_SHARE)
    yaw_rad, direction_rad = draw.uniform(0, math.tau), draw.uniform(0, math.tau)
    speed_m_s = draw.uniform(0, _PUSH_M_S_MAX)
    push_m_s = (speed_m_s * math.cos(direction_rad), speed_m_s * math.sin(direction_rad), 0.0)
    share = draw.uniform(*_PUSH_SHARES)
    # A tenth of a second is a whole number of steps.
    steps_per_s = 10 * round(draw.uniform(*_STEPS_PER_S) / 10)
    return Perturbation(friction, torque, yaw_rad, push_m_s, share, steps_per_s)


@dataclass(frozen=True)
class Body:
    """A champion as other engines read it."""

    urdf: Path
    mjcf: Path
    # What `islands inspect --json` says of its links.
    links: list[dict]
    task: str
    terrain: Terrain | None

    def masses_kg(self) -> np.ndarray:
        """The mass of each link."""
        return np.array([link["mass"] for link in self.links])

    def rest_m(self) -> np.ndarray:
        """Where the links are at rest, from the root."""
        return np.array([link["rest_xyz"] for link in self.links])

    def extent_m(self) -> float:
        """How far it reaches from its root at rest."""
        halves_m = np.array([link["size"] for link in self.links]) / 2
        return float((np.linalg.norm(self.rest_m(), axis=1) + np.linalg.norm(halves_m, axis=1)).max())

    def reaches_m(self, rotations: np.ndarray) -> np.ndarray:
        """How far each link reaches from its centre along x, y and z, given its rotation as a matrix."""
        return np.array([_reach_m(link, rotation) for link, rotation in zip(self.links, rotations)])


def exported(islands: Islands, specimen: Specimen, task: str, terrain: Terrain | None) -> Body:
    """A champion, written for other engines."""
    urdf, mjcf = islands.export(specimen, "urdf"), islands.export(specimen, "mjcf")
    return Body(urdf, mjcf, islands.inspect(urdf)["links"], task, terrain)


def _reach_m(link: dict, rotation: np.ndarray) -> np.ndarray:
    half_m = np.array(link["size"]) / 2
    # A row for each of the world's axes, in the link's own.
    local = np.abs(rotation)
    if link["shape"] == "box":
        return local @ half_m
    radius_m = half_m[0]
    if link["shape"] == "sphere":
        return np.full(3, radius_m)
    if link["shape"] == "capsule":
        return radius_m + local[:, 2] * (half_m[2] - radius_m)
    return radius_m * np.hypot(local[:, 0], local[:, 1]) + local[:, 2] * half_m[2]


def score_m(body: Body, engine: str, differs: Perturbation) -> float:
    """What a body is worth in a trial in an engine; nothing if its numbers break down or it leaves its terrain."""
    task = TASKS[body.task]
    is_fine = engine == "MuJoCo 1,920 Hz"
    rough = 1.0 if body.terrain is None else ROUGHNESS
    trial = Trial(
        gravity_m_s2=task.gravity_m_s2,
        settle_s=task.settle_s,
        scored_s=task.scored_s,
        steps_per_s=FINE_STEPS_PER_S if is_fine else differs.steps_per_s,
        grip=GRIP * rough * differs.friction,
        terrain=body.terrain,
    )
    period_s, motors = motors_of(body.urdf)
    motors = [dataclasses.replace(motor, torque_nm_max=motor.torque_nm_max * differs.torque) for motor in motors]
    player = _player(engine, body, trial, motors, differs)
    walk = _walked(player, body, trial, period_s, differs)
    return 0.0 if walk is None else task.score(walk)


def _player(engine: str, body: Body, trial: Trial, motors: list[Motor], differs: Perturbation) -> Player:
    root = _root(body, differs)
    if engine == "PyBullet":
        return InPyBullet(body.urdf, trial, motors, root)
    return DrivenInMuJoCo(body.mjcf, trial, motors, root)


def _root(body: Body, differs: Perturbation) -> np.ndarray:
    """Where the root begins, and its rotation: turned about the vertical, then leaning."""
    task = TASKS[body.task]
    yaw_rad = differs.yaw_rad
    if body.terrain is not None and differs is not USUAL:
        # There the hill stays ahead.
        yaw_rad = (yaw_rad / math.pi - 1) * _TERRAIN_YAW_RAD
    turn = _about((0.0, 0.0, 1.0), yaw_rad)
    if not task.is_dropped:
        turn = _times(_about(_LEAN_AXIS, _LEAN_RAD), turn)
    turns = [_times(turn, np.array(link["rest_xyzw"])) for link in body.links]
    places_m = body.rest_m() @ _matrix(turn).T
    reaches_m = body.reaches_m(np.array([_matrix(it) for it in turns]))
    at_m = np.array([0.0, 0.0, task.start_m])
    if body.terrain is not None and task.is_dropped:
        at_m = np.array([*body.terrain.start_m, body.terrain.height_m(*body.terrain.start_m) + task.start_m])
    elif body.terrain is not None:
        at_m = body.terrain.root_start_m(places_m - reaches_m, places_m + reaches_m, task.start_m)
    elif not task.is_dropped:
        at_m[2] -= min(0.0, (places_m - reaches_m)[:, 2].min())
    return np.array([*at_m, *turns[0]])


def _walked(player: Player, body: Body, trial: Trial, period_s: float, differs: Perturbation) -> Walk | None:
    _settle(player, trial)
    sample_steps = round(TRACK_SAMPLE_S * trial.steps_per_s)
    steps = round(trial.scored_s * trial.steps_per_s)
    is_pushed = not TASKS[body.task].is_dropped and any(differs.push_m_s)
    push_step = round(differs.push_share * steps / sample_steps) * sample_steps
    poses = [player.poses()]
    root_first_m = poses[0][0, :3]
    for step in moving(player, steps, max(1, round(period_s * trial.steps_per_s))):
        if step == 1 and trial.settle_s == 0:
            root_first_m = player.poses()[0, :3]
        if step % sample_steps == 0:
            poses.append(player.poses())
        if step == push_step and is_pushed:
            player.push(np.array(differs.push_m_s))
    filmed = np.array(poses)
    if not (player.is_sound() and np.isfinite(filmed).all()):
        return None
    return measured(body, filmed, root_first_m)


def measured(body: Body, poses: np.ndarray, root_first_m: np.ndarray) -> Walk | None:
    """What its poses, a tenth of a second apart, say of a body; nothing if it has left its terrain."""
    masses_kg = body.masses_kg()
    centres_m = np.einsum("tlx,l->tx", poses[:, :, :3], masses_kg) / masses_kg.sum()
    if body.terrain is not None and not all(map(body.terrain.holds, centres_m)):
        return None
    heights_m = np.array([_height_m(body, at, centre_m) for at, centre_m in zip(poses, centres_m)])
    return Walk(root_first_m, poses[-1, 0, :3], centres_m[:, :2], heights_m, body.extent_m())


def _height_m(body: Body, poses: np.ndarray, centre_m: np.ndarray) -> float:
    """How high a body is on its terrain, as src/simulation/mod.rs measures it."""
    if body.terrain is None:
        return 0.0
    reaches_m = body.reaches_m(np.array([_matrix(rotation) for rotation in poses[:, 3:]]))
    return min(float((poses[:, 2] - reaches_m[:, 2]).min()), body.terrain.height_m(centre_m[0], centre_m[1]))


def _settle(player: Player, trial: Trial) -> None:
    """Lets the body come to rest, as src/simulation/settling.rs does, but that all links are looked at, not parts."""
    steps, rest_steps = (round(time_s * trial.steps_per_s) for time_s in (trial.settle_s, _REST_S))
    if steps == 0:
        return
    for _ in range(_ROUNDS_MAX):
        for _ in range(steps - rest_steps):
            player.step()
        places_m = [player.poses()[:, :3]]
        for _ in range(rest_steps):
            player.step()
            places_m.append(player.poses()[:, :3])
        ways_m = np.linalg.norm(np.diff(places_m, axis=0), axis=2)
        if (ways_m * trial.steps_per_s < _REST_M_S).all():
            break
    player.halt()


def _about(axis: tuple[float, float, float], angle_rad: float) -> np.ndarray:
    """A rotation about an axis, as x, y, z, w."""
    unit = np.array(axis) / np.linalg.norm(axis)
    return np.array([*(unit * math.sin(angle_rad / 2)), math.cos(angle_rad / 2)])


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """First b, then a."""
    xyz = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.array([*xyz, a[3] * b[3] - a[:3] @ b[:3]])


def _matrix(rotation: np.ndarray) -> np.ndarray:
    """A rotation as a matrix."""
    x, y, z, w = rotation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
