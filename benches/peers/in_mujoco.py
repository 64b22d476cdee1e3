"""Bodies in MuJoCo: the exported model, with its servos or with motors that are constraints."""

from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from players import Motor, Trial
from terrain import Terrain

# How hard the motors' constraints are, from 0 to 1: MuJoCo's d, 0.9 to 0.95 unless said.
_HARD = 0.99
_BAD = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


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
