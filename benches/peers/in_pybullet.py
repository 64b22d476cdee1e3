"""Bodies in PyBullet: its default solver, the exported inertias, nothing that damps, motors as its users drive them."""

from pathlib import Path

import numpy as np
import pybullet

from players import FRICTION, Motor, Trial
from terrain import Terrain


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
