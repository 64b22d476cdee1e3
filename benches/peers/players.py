"""What plays a body's motor programme in another engine: see `in_pybullet` and `in_mujoco`.

A player has a body from a file that islands exported, advances it by steps, and tells where its links are: the centres
of their solids, in the order of the body. Its motors are driven as islands drives them.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol
from xml.etree import ElementTree

import numpy as np

from terrain import Terrain

STEPS_PER_S = 240
# Of ground and body each. PyBullet multiplies them; MuJoCo is given their product.
FRICTION = 0.5
GRIP = FRICTION**2


@dataclass
class Motor:
    """A motor and the phase that it is at."""

    joint: str
    waveform: str
    amplitude_rad_s: float
    phase_rad: float
    phase_step_rad: float
    torque_nm_max: float

    def update(self) -> float:
        """The target speed that follows, in rad/s."""
        self.phase_rad = math.fmod(self.phase_rad + self.phase_step_rad, math.tau)
        if self.waveform == "sine":
            return self.amplitude_rad_s * math.sin(self.phase_rad)
        if self.waveform == "pulse":
            return self.amplitude_rad_s * (1.0 if self.phase_rad < math.pi else -1.0)
        return self.amplitude_rad_s * (self.phase_rad / math.pi - 1.0)


@dataclass(frozen=True)
class Trial:
    """How a body is tried: as `islands` does in its tasks."""

    gravity_m_s2: float
    settle_s: float
    scored_s: float
    steps_per_s: int = STEPS_PER_S
    # Friction between ground and body.
    grip: float = GRIP
    # What the body stands on; none is a plane.
    terrain: Terrain | None = None


WALK = Trial(9.81, 0.5, 8.0)
COURSE = Trial(10.0, 0.0, 10.0)

# Where a root may begin: x, y, z in metres, and its rotation x, y, z, w.
UPRIGHT = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class Player(Protocol):
    """An engine with a body in it."""

    motors: list[Motor]

    def step(self) -> None:
        """Advances by a step."""

    def halt(self) -> None:
        """Takes all speed from the body."""

    def push(self, velocity_m_s: np.ndarray) -> None:
        """Gives the whole body a velocity on top of its own."""

    def is_sound(self) -> bool:
        """Whether the engine has kept to numbers so far."""

    def drive(self, targets_rad_s: list[float]) -> None:
        """Sets the speeds that the motors aim at."""

    def poses(self) -> np.ndarray:
        """A row a link: x, y, z in metres, and its rotation, a unit quaternion x, y, z, w."""

    def masses_kg(self) -> np.ndarray:
        """The mass of each link."""


def motors_of(urdf: Path) -> tuple[float, list[Motor]]:
    """The seconds between two motor updates, and the motors of a body that islands exported."""
    robot = ElementTree.parse(urdf).getroot()
    extension = robot.find("islands")
    if extension is None:
        return 1.0, []
    joints = {joint.get("name"): joint for joint in robot.iter("joint")}

    def motor(element: Any) -> Motor:
        limit = joints[element.get("joint")].find("limit")
        numbers = (float(element.get(name)) for name in ("amplitude", "phase-start", "phase-step"))
        return Motor(element.get("joint"), element.get("waveform"), *numbers, float(limit.get("effort")))

    return float(extension.get("control-period", "1")), [motor(element) for element in extension.iter("motor")]


def moving(player: Player, steps: int, update_steps: int) -> Iterator[int]:
    """Advances a body by so many steps, its motors driven as islands drives them; yields how many steps are done."""
    for step in range(steps):
        player.step()
        if step % update_steps == 0:
            player.drive([motor.update() for motor in player.motors])
        yield step + 1


def play(player: Player, trial: Trial, period_s: float, frame_steps: int = 4) -> np.ndarray:
    """Plays a trial; returns the poses of all links at its start and after every few steps."""
    frames = [player.poses()]

    def film(step: int) -> None:
        if step % frame_steps == 0:
            frames.append(player.poses())

    settle = round(trial.settle_s * trial.steps_per_s)
    for step in range(settle):
        player.step()
        film(step + 1)
    update_steps = max(1, round(period_s * trial.steps_per_s))
    for step in moving(player, round(trial.scored_s * trial.steps_per_s), update_steps):
        film(settle + step)
    return np.array(frames)
