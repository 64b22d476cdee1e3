"""The engines, each used as its users use it.

All try a body for 2,400 steps of 1/240 s. After the first step, and after every 24th from there, each motor's phase
grows by its step and its target speed follows.
"""

import json
import math
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import pybullet

import bodies
from bodies import STEPS, STEPS_PER_UPDATE, Body
from creatures import Creature
from program import PLAIN

Positions = np.ndarray


@dataclass(frozen=True)
class Trial:
    """What a peer did with a body."""

    # In the loop of steps, without building the body.
    seconds: float
    # Of the root, after the first step, after every 24th from there (or after every one) and after the last.
    positions_m: Positions
    # Whether the engine kept to the body's physics up to the end.
    sound: bool


class Motors:
    """The motors of a body, by their links."""

    def __init__(self, body: Body) -> None:
        """Motors before their first update."""
        self._links = [body.links[index] for index in body.driven()]
        self._phases = [0.0] * len(self._links)

    def update(self) -> list[float]:
        """The target speeds that follow, in rad/s."""
        self._phases = [(phase + link.phase_step_rad) % math.tau for phase, link in zip(self._phases, self._links)]
        return [_speed(link.waveform, phase) for phase, link in zip(self._phases, self._links)]


def _speed(waveform: str, phase_rad: float) -> float:
    if waveform == "sine":
        return math.sin(phase_rad)
    return 1.0 if phase_rad < math.pi else -1.0


def try_in_pybullet(body: Body, every_step: bool = False) -> Trial:
    """Tries a body as the course's program does, which asks for the root's position after every step."""
    robot = _load_in_pybullet(body)
    joints = _joints_in_pybullet(robot, body)
    motors = Motors(body)
    positions = []
    begun = time.perf_counter()
    for step in range(STEPS):
        pybullet.stepSimulation()
        if step % STEPS_PER_UPDATE == 0:
            for joint, speed in zip(joints, motors.update()):
                pybullet.setJointMotorControl2(
                    robot,
                    joint,
                    controlMode=pybullet.VELOCITY_CONTROL,
                    targetVelocity=speed,
                    force=bodies.TORQUE_NM_MAX,
                )
        positions.append(pybullet.getBasePositionAndOrientation(robot)[0])
    seconds = time.perf_counter() - begun
    walked = np.array(positions)
    if not every_step:
        walked = np.vstack([walked[::STEPS_PER_UPDATE], walked[-1:]])
    return Trial(seconds, walked, bool(np.isfinite(walked).all()))


def _load_in_pybullet(body: Body) -> int:
    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    pybullet.setPhysicsEngineParameter(enableFileCaching=0)
    pybullet.setGravity(0, 0, -bodies.GRAVITY_M_S2)
    plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE)
    pybullet.createMultiBody(0, plane)
    path = Path("creature.urdf")
    path.write_text(bodies.urdf(body))
    robot = pybullet.loadURDF(str(path))
    pybullet.resetBasePositionAndOrientation(robot, [0, 0, body.start_height_m], [0, 0, 0, 1])
    return robot


def _joints_in_pybullet(robot: int, body: Body) -> list[int]:
    """The driven joints, in the order of their links."""
    infos = (pybullet.getJointInfo(robot, joint) for joint in range(pybullet.getNumJoints(robot)))
    joints = {info[1].decode(): info[0] for info in infos}
    return [joints[f"joint_{index}"] for index in body.driven()]


def try_in_mujoco(body: Body, every_step: bool = False, hurried: bool = False) -> Trial:
    """Tries a body in MuJoCo, with one call from one motor update to the next unless every step is asked for.

    Hurried, it has half as many steps, four iterations of its solver and ten of its line search: as fast as MuJoCo goes
    without losing most of these bodies. Its `rollout` module adds threads, which one core has no use for.
    """
    model = mujoco.MjModel.from_xml_string(bodies.mjcf(body))
    steps_in_all, steps_per_update = STEPS, STEPS_PER_UPDATE
    if hurried:
        model.opt.timestep *= 2
        model.opt.iterations, model.opt.ls_iterations = 4, 10
        steps_in_all, steps_per_update = STEPS // 2, STEPS_PER_UPDATE // 2
    data = mujoco.MjData(model)
    motors = Motors(body)
    positions = []

    def advance(steps: int) -> None:
        calls, steps_per_call = (steps, 1) if every_step else (1, steps)
        for _ in range(calls):
            mujoco.mj_step(model, data, nstep=steps_per_call)
            positions.append(data.qpos[:3].copy())

    begun = time.perf_counter()
    advance(1)
    left = steps_in_all - 1
    while left > 0:
        data.ctrl[:] = motors.update()
        advance(min(left, steps_per_update))
        left -= steps_per_update
    seconds = time.perf_counter() - begun
    walked = np.array(positions)
    return Trial(seconds, walked, bool(np.isfinite(walked).all()) and not _has_blown_up(data))


def _has_blown_up(data: mujoco.MjData) -> bool:
    """Whether MuJoCo put a body back to its start since its numbers were bad."""
    warnings = mujoco.mjtWarning
    bad = (warnings.mjWARN_BADQPOS, warnings.mjWARN_BADQVEL, warnings.mjWARN_BADQACC)
    return any(data.warning[int(warning)].number > 0 for warning in bad)


PEERS: dict[str, Callable[..., Trial]] = {"PyBullet": try_in_pybullet, "MuJoCo": try_in_mujoco}

# Those that are only timed: nobody compares what bodies do in them.
HURRIED: dict[str, Callable[[Body], Trial]] = {"MuJoCo, hurried": lambda body: try_in_mujoco(body, hurried=True)}


@dataclass(frozen=True)
class Score:
    """What `islands evaluate` says of a creature."""

    # The root's way in space, from after the first step to the end; NaN if the trial did not get there.
    displacement_m: float
    # The length of the root's path, if the program tells it.
    path_m: float | None
    sound: bool


# So many times as many trials has a genome that is evaluated alone as `--robustness` says: it may be the best.
_BEST_TIMES = 4


@dataclass(frozen=True)
class Islands:
    """The program, with one of its engines, and how many perturbed trials a creature has; 0 for one as it is."""

    program: Path
    engine: str
    trials: int = 0

    @property
    def name(self) -> str:
        """What tables call it."""
        return f"islands {self.engine}" + (f", {self.trials} trials" if self.trials else "")

    def seconds_a_trial(self, creatures: Sequence[Creature]) -> float:
        """The seconds that the program counts for a trial of each creature, on one thread."""
        return self.evaluate(creatures)[0] / max(self.trials, 1)

    def evaluate(self, creatures: Sequence[Creature]) -> tuple[float, list[Score]]:
        """The seconds that the program counts for creatures, on one thread, and their scores."""
        options = ["--profile", "coursework", "--task", "course", "--threads", "1", "--json"]
        several = ["--robustness", str(self.trials // _BEST_TIMES), "--robust-by", "mean", "--judged=false"]
        options += ["--engine", self.engine, *(several if self.trials else PLAIN)]
        genomes = [creature.genome for creature in creatures]
        command: list[str | Path] = [self.program, "evaluate", *options, *genomes]
        printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        result = json.loads(printed.splitlines()[-1])
        return result["wall_seconds"], [_score(genome) for genome in result["genomes"]]


def _score(genome: dict) -> Score:
    sound = genome["outcome"] == "scored"
    return Score(genome["fitness"] if sound else math.nan, None, sound)


def engines_of(program: Path) -> list[Islands]:
    """The program with each engine that it has."""
    return [Islands(program, engine) for engine in ("rapier", "featherstone")]


def timed_of(program: Path) -> list[Islands]:
    """The program in every way that is timed: eight trials of a body go side by side."""
    return [*engines_of(program), Islands(program, "featherstone", trials=8)]
