"""The same motor programme, played in PyBullet and in MuJoCo.

A player has a body from a file that islands exported, advances it by steps of 1/240 s, and tells where its links are:
the centres of their solids, in the order of the body. Its motors are driven as islands drives them.
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol
from xml.etree import ElementTree

import mujoco
import numpy as np
import pybullet

STEPS_PER_S = 240
# Of ground and body each. PyBullet multiplies them; the exported MJCF has their product.
FRICTION = 0.5


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


WALK = Trial(9.81, 0.5, 8.0)
COURSE = Trial(10.0, 0.0, 10.0)

# Where a root may begin: x, y, z in metres, and its rotation x, y, z, w.
UPRIGHT = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


class Player(Protocol):
    """An engine with a body in it."""

    motors: list[Motor]

    def step(self) -> None:
        """Advances by 1/240 s."""

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


class InPyBullet:
    """A body in PyBullet."""

    def __init__(self, urdf: Path, trial: Trial, motors: list[Motor], root: np.ndarray | None = None) -> None:
        """Puts a body where its root begins, or where the file says."""
        if not pybullet.isConnected():
            pybullet.connect(pybullet.DIRECT)
        pybullet.resetSimulation()
        pybullet.setPhysicsEngineParameter(enableFileCaching=0, fixedTimeStep=1 / STEPS_PER_S)
        pybullet.setGravity(0, 0, -trial.gravity_m_s2)
        ground = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
        pybullet.changeDynamics(ground, -1, lateralFriction=FRICTION)
        # Without this flag PyBullet makes inertias from bounding boxes.
        self.robot = pybullet.loadURDF(str(urdf), flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
        if root is not None:
            pybullet.resetBasePositionAndOrientation(self.robot, root[:3], root[3:])
        self.joints = {
            pybullet.getJointInfo(self.robot, joint)[1].decode(): joint
            for joint in range(pybullet.getNumJoints(self.robot))
        }
        self.motors = motors
        self._take_away_hidden_forces()
        self.drive([0.0] * len(motors))

    def _take_away_hidden_forces(self) -> None:
        for link in range(-1, len(self.joints)):
            pybullet.changeDynamics(
                self.robot,
                link,
                lateralFriction=FRICTION,
                rollingFriction=0,
                spinningFriction=0,
                linearDamping=0,
                angularDamping=0,
                jointDamping=0,
            )
        for joint in self.joints.values():
            pybullet.setJointMotorControl2(self.robot, joint, pybullet.VELOCITY_CONTROL, force=0)

    def push(self, speed_m_s: float) -> None:
        """Gives the root a velocity along x."""
        pybullet.resetBaseVelocity(self.robot, [speed_m_s, 0, 0])

    def step(self) -> None:
        """Advances by 1/240 s."""
        pybullet.stepSimulation()

    def drive(self, targets_rad_s: list[float]) -> None:
        """Sets the speeds that the motors aim at."""
        for motor, target in zip(self.motors, targets_rad_s):
            pybullet.setJointMotorControl2(
                self.robot,
                self.joints[motor.joint],
                pybullet.VELOCITY_CONTROL,
                targetVelocity=target,
                force=motor.torque_nm_max,
            )

    def poses(self) -> np.ndarray:
        """The poses of the links, in the order of the body."""
        rows = [(*position, *rotation) for position, rotation in map(self._pose, self._in_order())]
        return np.array(rows)

    def _pose(self, link: int) -> tuple:
        if link == -1:
            return pybullet.getBasePositionAndOrientation(self.robot)
        return pybullet.getLinkState(self.robot, link, computeForwardKinematics=1)[:2]

    def _in_order(self) -> list[int]:
        """PyBullet numbers links as it finds them; their joints are called by their place in the body."""
        return [-1, *(self.joints[name] for name in sorted(self.joints, key=lambda name: int(name.split("_")[-1])))]

    def masses_kg(self) -> np.ndarray:
        """The mass of each link."""
        return np.array([pybullet.getDynamicsInfo(self.robot, link)[0] for link in self._in_order()])

    def inertias_kg_m2(self) -> np.ndarray:
        """The principal moments of inertia of each link, the smallest first."""
        return np.array([sorted(pybullet.getDynamicsInfo(self.robot, link)[2]) for link in self._in_order()])


class InMuJoCo:
    """A body in MuJoCo."""

    def __init__(self, mjcf: Path, trial: Trial, motors: list[Motor], root: np.ndarray | None = None) -> None:
        """Puts a body where its root begins, or where the file says."""
        self.model = mujoco.MjModel.from_xml_path(str(mjcf))
        self.model.opt.gravity[2] = -trial.gravity_m_s2
        self.data = mujoco.MjData(self.model)
        if root is not None:
            self.data.qpos[:7] = [*root[:3], root[6], *root[3:6]]
        mujoco.mj_forward(self.model, self.data)
        self.motors = motors
        names = [motor.joint.replace("joint", "motor") for motor in motors]
        self.actuators = [mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name) for name in names]

    def push(self, speed_m_s: float) -> None:
        """Gives the root a velocity along x."""
        self.data.qvel[0] = speed_m_s

    def step(self) -> None:
        """Advances by 1/240 s."""
        mujoco.mj_step(self.model, self.data)

    def drive(self, targets_rad_s: list[float]) -> None:
        """Sets the speeds that the motors aim at."""
        for actuator, target in zip(self.actuators, targets_rad_s):
            if actuator >= 0:
                self.data.ctrl[actuator] = target

    def poses(self) -> np.ndarray:
        """The poses of the links, in the order of the body."""
        mujoco.mj_kinematics(self.model, self.data)
        bodies = self._in_order()
        return np.hstack([self.data.xpos[bodies], np.roll(self.data.xquat[bodies], -1, axis=1)])

    def _in_order(self) -> list[int]:
        count = self.model.nbody - 1
        return [mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, f"link_{link}") for link in range(count)]

    def masses_kg(self) -> np.ndarray:
        """The mass of each link."""
        return self.model.body_mass[self._in_order()]

    def inertias_kg_m2(self) -> np.ndarray:
        """The principal moments of inertia of each link, the smallest first."""
        return np.sort(self.model.body_inertia[self._in_order()], axis=1)


def play(player: Player, trial: Trial, period_s: float, frame_steps: int = 4) -> np.ndarray:
    """Plays a trial; returns the poses of all links at its start and after every few steps."""
    frames = [player.poses()]
    settle = round(trial.settle_s * STEPS_PER_S)
    update_steps = max(1, round(period_s * STEPS_PER_S))
    for step in range(settle + round(trial.scored_s * STEPS_PER_S)):
        player.step()
        scored = step - settle
        if scored >= 0 and scored % update_steps == 0:
            player.drive([motor.update() for motor in player.motors])
        if (step + 1) % frame_steps == 0:
            frames.append(player.poses())
    return np.array(frames)
