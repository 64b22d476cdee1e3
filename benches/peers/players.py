"""The same motor programme, played in PyBullet and in MuJoCo.

A player has a body from a file that islands exported, advances it by steps, and tells where its links are: the centres
of their solids, in the order of the body. Its motors are driven as islands drives them.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol
from xml.etree import ElementTree

import mujoco
import numpy as np
import pybullet

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


class InPyBullet:
    """A body in PyBullet."""

    def __init__(self, urdf: Path, trial: Trial, motors: list[Motor], root: np.ndarray | None = None) -> None:
        """Puts a body where its root begins, or where the file says."""
        if not pybullet.isConnected():
            pybullet.connect(pybullet.DIRECT)
        pybullet.resetSimulation()
        pybullet.setPhysicsEngineParameter(enableFileCaching=0, fixedTimeStep=1 / trial.steps_per_s)
        pybullet.setGravity(0, 0, -trial.gravity_m_s2)
        for ground in _grounds_in_pybullet(trial.terrain):
            pybullet.changeDynamics(ground, -1, lateralFriction=trial.grip / FRICTION)
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

    def push(self, velocity_m_s: np.ndarray) -> None:
        """Gives the whole body a velocity on top of its own: all else is relative to its root's."""
        linear, angular = pybullet.getBaseVelocity(self.robot)
        pybullet.resetBaseVelocity(self.robot, list(np.array(linear) + velocity_m_s), angular)

    def halt(self) -> None:
        """Takes all speed from the body."""
        pybullet.resetBaseVelocity(self.robot, [0, 0, 0], [0, 0, 0])
        for joint in self.joints.values():
            pybullet.resetJointState(self.robot, joint, pybullet.getJointState(self.robot, joint)[0], 0)

    def is_sound(self) -> bool:
        """Whether the engine has kept to numbers so far."""
        return bool(np.isfinite(self.poses()).all())

    def step(self) -> None:
        """Advances by a step."""
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
        states = [pybullet.getBasePositionAndOrientation(self.robot)]
        if self.joints:
            states += pybullet.getLinkStates(self.robot, self._in_order()[1:], computeForwardKinematics=1)
        return np.array([(*state[0], *state[1]) for state in states])

    def _in_order(self) -> list[int]:
        """PyBullet numbers links as it finds them; their joints are called by their place in the body."""
        return [-1, *(self.joints[name] for name in sorted(self.joints, key=lambda name: int(name.split("_")[-1])))]

    def masses_kg(self) -> np.ndarray:
        """The mass of each link."""
        return np.array([pybullet.getDynamicsInfo(self.robot, link)[0] for link in self._in_order()])

    def inertias_kg_m2(self) -> np.ndarray:
        """The principal moments of inertia of each link, the smallest first."""
        return np.array([sorted(pybullet.getDynamicsInfo(self.robot, link)[2]) for link in self._in_order()])


def _grounds_in_pybullet(terrain: Terrain | None) -> list[int]:
    """A plane, or a mesh and its walls."""
    if terrain is None:
        return [pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))]
    mesh = pybullet.createCollisionShape(
        pybullet.GEOM_MESH,
        vertices=terrain.vertices_m().tolist(),
        indices=terrain.triangles().ravel().tolist(),
        flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
    )
    boxes = [
        (pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=wall.half_m), wall.centre_m)
        for wall in terrain.walls()
    ]
    return [pybullet.createMultiBody(0, shape, basePosition=at) for shape, at in [(mesh, (0, 0, 0)), *boxes]]


class InMuJoCo:
    """A body in MuJoCo."""

    def __init__(self, mjcf: Path, trial: Trial, motors: list[Motor], root: np.ndarray | None = None) -> None:
        """Puts a body where its root begins, or where the file says."""
        self.model = mujoco.MjModel.from_xml_string(_on_ground(mjcf.read_text(), trial.terrain))
        self.model.opt.gravity[2] = -trial.gravity_m_s2
        self.model.opt.timestep = 1 / trial.steps_per_s
        self.model.geom_friction[:, 0] = trial.grip
        if trial.terrain is not None:
            heights_m = trial.terrain.heights_m
            self.model.hfield_data[:] = ((heights_m - heights_m.min()) / np.ptp(heights_m)).ravel()
        self.data = mujoco.MjData(self.model)
        if root is not None:
            self.data.qpos[:7] = [*root[:3], root[6], *root[3:6]]
        mujoco.mj_forward(self.model, self.data)
        self.motors = motors
        names = [motor.joint.replace("joint", "motor") for motor in motors]
        self.actuators = [mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name) for name in names]
        for motor, actuator in zip(motors, self.actuators):
            if actuator >= 0:
                self.model.actuator_forcerange[actuator] = -motor.torque_nm_max, motor.torque_nm_max

    def push(self, velocity_m_s: np.ndarray) -> None:
        """Gives the whole body a velocity on top of its own: all else is relative to its root's."""
        self.data.qvel[:3] += velocity_m_s

    def halt(self) -> None:
        """Takes all speed from the body."""
        self.data.qvel[:] = 0

    def is_sound(self) -> bool:
        """Whether MuJoCo has not put the body back to the start since its numbers were bad."""
        return not any(self.data.warning[int(warning)].number for warning in _BAD)

    def step(self) -> None:
        """Advances by a step."""
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


class DrivenInMuJoCo(InMuJoCo):
    """A body in MuJoCo whose motors reach their speed if their torque suffices, as in islands and in PyBullet.

    A velocity servo, which is all that MJCF has, gives torque in return for an error of the speed: as stiff as it can
    be at 240 steps a second, a light limb that carries a heavy body lags behind by several rad/s. MuJoCo's dry friction
    of a joint is what is meant: a constraint that brings the joint to a speed, 0, with a bounded torque. So the motors
    are frictions, and in the middle of each step the speed that they aim at is moved from 0 to the target.
    """

    def __init__(self, mjcf: Path, trial: Trial, motors: list[Motor], root: np.ndarray | None = None) -> None:
        """Puts a body where its root begins, or where the file says."""
        super().__init__(mjcf, trial, motors, root)
        model = self.model
        model.actuator_gainprm[:] = 0
        model.actuator_biasprm[:] = 0
        dofs = {index: model.jnt_dofadr[model.joint(motor.joint).id] for index, motor in enumerate(motors)}
        # Without torque there is no friction, and no constraint. Constraints are in the order of the joints.
        driven = [index for index in dofs if motors[index].torque_nm_max > 0]
        self._driven = sorted(driven, key=dofs.get)
        for index in self._driven:
            model.dof_frictionloss[dofs[index]] = motors[index].torque_nm_max
            # As hard as MuJoCo allows.
            model.dof_solref[dofs[index]] = 2 * model.opt.timestep, 1
            model.dof_solimp[dofs[index], :2] = _HARD
        self._targets_rad_s = np.zeros(len(self._driven))
        mujoco.mj_forward(model, self.data)
        assert self.data.nf == len(self._driven), "each motor is a constraint"

    def drive(self, targets_rad_s: list[float]) -> None:
        """Sets the speeds that the motors aim at."""
        self._targets_rad_s = np.array([targets_rad_s[index] for index in self._driven])

    def step(self) -> None:
        """Advances by a step."""
        mujoco.mj_step1(self.model, self.data)
        # A friction asks for the acceleration -b v; b is the second number of its row.
        damping = self.data.efc_KBIP.reshape(-1, 4)[: self.data.nf, 1]
        self.data.efc_aref[: self.data.nf] += damping * self._targets_rad_s
        mujoco.mj_step2(self.model, self.data)


# What of a motor's error is left to its constraint's softness: MuJoCo's d, from 0 to 1.
_HARD = 0.99
_BAD = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


def _on_ground(mjcf: str, terrain: Terrain | None) -> str:
    """A model that stands on a terrain and within its walls, instead of on its plane."""
    if terrain is None:
        return mjcf
    root = ElementTree.fromstring(mjcf)
    rows, columns = terrain.heights_m.shape
    low_m, tall_m = float(terrain.heights_m.min()), float(np.ptp(terrain.heights_m))
    size = f"{terrain.half_m[0]} {terrain.half_m[1]} {tall_m} 1"
    field = {"name": "terrain", "nrow": str(rows), "ncol": str(columns), "size": size}
    ElementTree.SubElement(ElementTree.SubElement(root, "asset"), "hfield", field)
    world = root.find("worldbody")
    ground = world.find("geom[@name='ground']")
    del ground.attrib["size"]
    ground.attrib |= {"type": "hfield", "hfield": "terrain", "pos": f"0 0 {low_m}"}
    for wall in terrain.walls():
        centre, half = (" ".join(map(str, map(float, of))) for of in (wall.centre_m, wall.half_m))
        ElementTree.SubElement(world, "geom", type="box", pos=centre, size=half, contype="0", conaffinity="1")
    return ElementTree.tostring(root, encoding="unicode")


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
