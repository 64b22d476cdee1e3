"""What must be the same in every engine, and what is only reported."""

import math
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

import claims
import hand
import ros
import terrain
import trials
import verdicts
from in_mujoco import InMuJoCo
from in_pybullet import InPyBullet
from players import COURSE, STEPS_PER_S, UPRIGHT, WALK, Trial, motors_of, play
from program import PLAIN, Islands, Specimen

ENGINES = ("islands", "PyBullet", "MuJoCo")
# Of masses, inertias and poses, relative to the size of the body.
SAME = 1e-5
# Of motion that is not chaotic.
ALIKE = 0.02
FRAMES_PER_S = 60
# Of scores of the same film, whose numbers have single precision, in metres.
SAME_SCORE_M = 1e-4
# Of what a run claims of its champion: the median of three engines, of any and of the one in the middle.
HOLDS_MIN = 0.75
HOLDS_MEDIAN = 0.9
# Perturbed trials of each in each engine.
TRIALS = 8


def same_bodies(islands: Islands, specimens: list[Specimen]) -> list[str]:
    """Loads every body in every engine and in ROS's parser; returns what differs."""
    failures = []
    for specimen in specimens:
        urdf, mjcf = islands.export(specimen, "urdf"), islands.export(specimen, "mjcf")
        links = islands.inspect(urdf)["links"]
        players = {"PyBullet": InPyBullet(urdf, COURSE, []), "MuJoCo": InMuJoCo(mjcf, COURSE, [])}
        for engine, player in players.items():
            failures += [f"{specimen.file.name} in {engine}: {what}" for what in _differences(links, player)]
        failures += _joints(specimen, links, players["PyBullet"], players["MuJoCo"])
        failures += [f"{specimen.file.name} in ROS: {what}" for what in ros.differences(urdf, links)]
    print(f"bodies: {len(specimens)} loaded in PyBullet, MuJoCo and ROS's parser, {len(failures)} differences")
    return failures


def _joints(specimen: Specimen, links: list[dict], bullet: InPyBullet, mujoco: InMuJoCo) -> list[str]:
    """MuJoCo has no joint where links are fixed, but one for the root to move freely."""
    turning = sum(link["joint"] == "revolute" for link in links)
    counts = (len(bullet.joints), mujoco.model.njnt - 1)
    if counts == (len(links) - 1, turning):
        return []
    return [f"{specimen.file.name}: {counts} joints instead of {len(links) - 1} and {turning}"]


def _differences(links: list[dict], player: InPyBullet | InMuJoCo) -> list[str]:
    poses = player.poses()
    if len(poses) != len(links):
        return [f"{len(poses)} links instead of {len(links)}"]
    masses = np.array([link["mass"] for link in links])
    inertias = np.array([sorted(link["inertia"][:3]) for link in links])
    places = np.array([link["rest_xyz"] for link in links])
    turns = np.array([link["rest_xyzw"] for link in links])
    size = 1 + np.abs(places).max()
    # The root's height is the engine's own matter.
    shifted = poses[:, :3] - poses[0, :3] + places[0]
    wrong = {
        "masses": np.abs(player.masses_kg() / masses - 1).max() > SAME,
        "inertias": np.abs(player.inertias_kg_m2() - inertias).max() > SAME * inertias.max(),
        "places": np.abs(shifted - places).max() > SAME * size,
        # A quaternion and its opposite are the same rotation.
        "rotations": (1 - np.abs((poses[:, 3:] * turns).sum(axis=1))).max() > SAME,
    }
    return [f"other {what}" for what, is_wrong in wrong.items() if is_wrong]


def _played(islands: Islands, specimen: Specimen, trial: Trial) -> dict[str, np.ndarray]:
    """The motion of a body in each engine."""
    urdf, mjcf = islands.export(specimen, "urdf"), islands.export(specimen, "mjcf")
    task = "course" if trial is COURSE else "walk"
    mine = islands.motion(specimen, task)
    period_s, motors = motors_of(urdf)
    root = mine[0, 0]
    bullet = InPyBullet(urdf, trial, motors, root)
    played = {"islands": mine, "PyBullet": play(bullet, trial, period_s)}
    _, motors = motors_of(urdf)
    played["MuJoCo"] = play(InMuJoCo(mjcf, trial, motors, root), trial, period_s)
    return played


def same_motion(islands: Islands) -> list[str]:
    """Plays bodies whose motion is not chaotic; returns what differs."""
    failures = []
    cases: list[tuple[str, str, Trial, Callable[[np.ndarray], float], float | None]] = [
        ("free fall, m in 0.5 s", hand.BALL, COURSE, _fall_m, 1.25),
        ("pendulum, s a period", hand.PENDULUM, WALK, _period_s, hand.PENDULUM_PERIOD_S),
        ("driven hinge in the air, rad in 0.6 s", hand.ROTOR, COURSE, _turned_rad, None),
    ]
    for name, urdf, trial, measure, truth in cases:
        file = islands.folder / f"{name.split()[0].strip(',')}.urdf"
        file.write_text(urdf)
        found = {engine: measure(poses) for engine, poses in _played(islands, Specimen(file), trial).items()}
        failures += _compare(name, found, truth)
    file = islands.folder / "slide.urdf"
    file.write_text(hand.BOX)
    # What rapier slides is held against the same truth in the suite: no trial begins with a push.
    return failures + _compare("slide from 3 m/s, m", _slides_m(islands, file), hand.SLIDE_M)


def _compare(name: str, found: dict[str, float], truth: float | None) -> list[str]:
    """Prints what each engine found; returns who is not alike."""
    truth = found["islands"] if truth is None else truth
    print(f"{name}: {truth:.4f} expected; " + ", ".join(f"{engine} {value:.4f}" for engine, value in found.items()))
    return [
        f"{name}: {engine} has {value:.4f} instead of {truth:.4f}"
        for engine, value in found.items()
        if not abs(value / truth - 1) <= ALIKE
    ]


def _fall_m(poses: np.ndarray) -> float:
    return float(poses[0, 0, 2] - poses[FRAMES_PER_S // 2, 0, 2])


def _period_s(poses: np.ndarray) -> float:
    """From the first to the last time that the bob passes below its hinge in one direction, after settling."""
    swing = poses[2 * FRAMES_PER_S :, 1, 1] - poses[2 * FRAMES_PER_S :, 0, 1]
    ups = [i - swing[i] / (swing[i + 1] - swing[i]) for i in range(len(swing) - 1) if swing[i] < 0 <= swing[i + 1]]
    return float((ups[-1] - ups[0]) / (len(ups) - 1) / FRAMES_PER_S)


def _turned_rad(poses: np.ndarray) -> float:
    """By how much two links have turned against each other after 0.6 s."""
    a, b = poses[round(0.6 * FRAMES_PER_S), :2, 3:]
    dot = abs(float((a * b).sum()))
    return 2 * math.acos(min(1.0, dot))


def _slides_m(islands: Islands, urdf: Path) -> dict[str, float]:
    specimen = Specimen(urdf)
    found = {}
    resting = Trial(COURSE.gravity_m_s2, 0.0, 3.0)
    push_m_s = np.array([hand.PUSH_M_S, 0.0, 0.0])
    root = UPRIGHT + [0, 0, hand.BOX_HALF_M, 0, 0, 0, 0]
    bullet = InPyBullet(islands.export(specimen, "urdf"), resting, [], root)
    bullet.push(push_m_s)
    mujoco = InMuJoCo(islands.export(specimen, "mjcf"), resting, [], root)
    mujoco.push(push_m_s)
    for engine, player in (("PyBullet", bullet), ("MuJoCo", mujoco)):
        poses = play(player, resting, 1.0)
        found[engine] = float(poses[-1, 0, 0] - poses[0, 0, 0])
    return found


def same_scores(islands: Islands, specimens: list[Specimen]) -> list[str]:
    """Scores what islands films by the rules that other engines are scored by; returns whose score is another one."""
    failures = []
    settled, every = round(WALK.settle_s * FRAMES_PER_S), round(trials.TRACK_SAMPLE_S * FRAMES_PER_S)
    for task, ground in (("walk", None), ("travel", None), ("climb", terrain.mountain())):
        said = islands.evaluate([specimen.file for specimen in specimens], "--task", task, *PLAIN)
        for specimen, score_m in zip(specimens, said):
            filmed = islands.motion(specimen, task)[settled::every]
            body = trials.exported(islands, specimen, task, ground)
            walk = trials.measured(body, filmed, filmed[0, 0, :3])
            found_m = None if walk is None else trials.TASKS[task].score(walk)
            if found_m is None or score_m is None or not abs(found_m - score_m) <= SAME_SCORE_M:
                failures.append(f"{task}: {specimen.file.name} is worth {score_m} in islands, {found_m} by our rules")
    print(f"scores: {len(specimens)} walkers by three tasks' rules, {len(failures)} differences")
    return failures


def claims_hold(islands: Islands, folder: Path, jobs: int) -> list[str]:
    """Tries champions of runs as users make them; returns whose claims, which stand in claims.csv, fail elsewhere."""
    if not (folder / "claims.csv").exists():
        return [f"claims: there is no {folder / 'claims.csv'}, so that nothing is known of what runs claim"]
    try:
        judged = verdicts.judge(islands, claims.of_fixtures(islands, folder, ""), TRIALS, jobs)
    except claims.NoClaim as error:
        return [f"claims: {error}"]
    print("\n".join(table.text() for table in verdicts.tables(judged, TRIALS)))
    failures = [
        f"claims: of {verdict.claim.name}'s {verdict.claim.claim_m:.2f} m other engines leave {verdict.ratio:.2f}"
        for verdict in judged
        if not verdict.ratio >= HOLDS_MIN
    ]
    median = float(np.median([verdict.ratio for verdict in judged]))
    if not median >= HOLDS_MEDIAN:
        failures.append(f"claims: in the median other engines leave {median:.2f} of them")
    return failures


def report_walkers(islands: Islands, kind: str, specimens: list[Specimen]) -> None:
    """Prints how far each walker gets in each engine, and what they come to."""
    print(f"\n| {kind} | {' | '.join(ENGINES)} |\n|---|{'---:|' * len(ENGINES)}")
    table = []
    for specimen in specimens:
        masses = np.array([link["mass"] for link in islands.inspect(islands.export(specimen, "urdf"))["links"]])
        played = _played(islands, specimen, WALK)
        row = [_walked_m(played[engine], masses) for engine in ENGINES]
        table.append(row)
        _print_row(specimen.file.stem, row)
    distances = np.array(table)
    ratios = distances / distances[:, :1]
    _print_row("median", np.median(distances, axis=0))
    _print_row("median ratio", np.median(ratios, axis=0))
    _print_row("first quartile", np.quantile(ratios, 0.25, axis=0))
    _print_row("least ratio", ratios.min(axis=0))
    _print_row("greatest ratio", ratios.max(axis=0))
    print()


def _print_row(name: str, numbers: Iterable[float]) -> None:
    print(f"| {name} | {' | '.join(f'{number:.2f}' for number in numbers)} |")


def _walked_m(poses: np.ndarray, masses: np.ndarray) -> float:
    """How far the centre of mass got along the ground while it was scored."""
    centres = (poses[:, :, :2] * masses[:, None]).sum(axis=1) / masses.sum()
    settled = round(WALK.settle_s * FRAMES_PER_S)
    return float(np.linalg.norm(centres[-1] - centres[settled]))


assert STEPS_PER_S % FRAMES_PER_S == 0
