"""Bodies, and how each peer's format writes them: URDF for PyBullet, MJCF for MuJoCo."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

STEPS_PER_S = 240
STEPS = 2400
STEPS_PER_UPDATE = 24
GRAVITY_M_S2 = 10.0
# The course's friction, 0.5 of the ground times 0.5 of the body. PyBullet multiplies by itself.
FRICTION = 0.25
TORQUE_NM_MAX = 5.0


@dataclass(frozen=True)
class Link:
    """A link and what holds and drives it; the root has no parent."""

    parent: int | None
    # "cylinder" or "box", along its own z.
    shape: str
    length_m: float
    # Of a box: half its side.
    radius_m: float
    mass_kg: float
    # "revolute" or "fixed". The joint is at the link's centre.
    joint: str
    axis: tuple[float, ...]
    xyz_m: tuple[float, ...]
    rpy_rad: tuple[float, ...]
    # "pulse" or "sine".
    waveform: str
    phase_step_rad: float


@dataclass(frozen=True)
class Body:
    """A body: its links, parents before their children, and how high its root starts."""

    name: str
    links: tuple[Link, ...]
    start_height_m: float

    def driven(self) -> list[int]:
        """The links with a motor."""
        return [i for i, link in enumerate(self.links) if link.parent is not None and link.joint == "revolute"]

    def children(self, index: int) -> list[int]:
        """The links that a link carries."""
        return [i for i, link in enumerate(self.links) if link.parent == index]


def from_inspection(inspection: dict[str, Any]) -> Body:
    """A body of the course, dropped from 2.5 m, from what `islands inspect --json` prints."""
    places: dict[str, int] = {}
    links = []
    for place, link in enumerate(inspection["links"]):
        joint = link["joint"] or {"axis": (0, 0, 1), "origin_xyz": (0, 0, 0), "origin_rpy": (0, 0, 0)}
        motor = link["motor"] or {"waveform": "pulse", "freq": 0.0}
        links.append(
            Link(
                parent=None if link["parent"] is None else places[link["parent"]],
                shape="cylinder",
                length_m=link["length"],
                radius_m=link["radius"],
                mass_kg=link["mass"],
                joint="revolute",
                axis=tuple(joint["axis"]),
                xyz_m=tuple(joint["origin_xyz"]),
                rpy_rad=tuple(joint["origin_rpy"]),
                waveform=motor["waveform"],
                phase_step_rad=motor["freq"],
            )
        )
        if places.setdefault(link["name"], place) != place:
            raise ValueError(f"two links of {inspection['source']} are called {link['name']}")
    return Body(inspection["source"], tuple(links), 2.5)


def from_manifest(body: dict[str, Any]) -> Body:
    """A body made by hand, from an entry of the collection's `manifest.json`."""

    def link(entry: dict[str, Any]) -> Link:
        return Link(
            parent=None if entry["parent"] < 0 else entry["parent"],
            shape=entry["shape"],
            length_m=entry["length"],
            radius_m=entry["radius"],
            mass_kg=entry["mass"],
            joint=entry["jtype"],
            axis=tuple(float(axis == entry["axis"]) for axis in range(3)),
            xyz_m=tuple(entry["xyz"]),
            rpy_rad=tuple(entry["rpy"]),
            waveform=entry["wave"],
            phase_step_rad=entry["freq"],
        )

    return Body(body["name"], tuple(map(link, body["links"])), body["z_lift"])


def urdf(body: Body) -> str:
    """A body as the course's program writes it.

    PyBullet makes inertias from shapes, not from those that stand here, and takes reversed limits for none.
    """
    links = "".join(_urdf_link(index, link) for index, link in enumerate(body.links))
    joints = "".join(_urdf_joint(i, link) for i, link in enumerate(body.links) if link.parent is not None)
    return f'<?xml version="1.0"?>\n<robot name="creature">\n{links}{joints}</robot>\n'


def _urdf_link(index: int, link: Link) -> str:
    side = 2 * link.radius_m
    if link.shape == "box":
        shape = f'<box size="{_numbers([side, side, link.length_m])}"/>'
    else:
        shape = f'<cylinder length="{link.length_m!r}" radius="{link.radius_m!r}"/>'
    return (
        f'<link name="link_{index}">'
        f"<visual><geometry>{shape}</geometry></visual><collision><geometry>{shape}</geometry></collision>"
        f'<inertial><mass value="{link.mass_kg!r}"/>'
        '<inertia ixx="0.03" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>\n'
    )


def _urdf_joint(index: int, link: Link) -> str:
    return (
        f'<joint name="joint_{index}" type="{link.joint}">'
        f'<parent link="link_{link.parent}"/><child link="link_{index}"/><axis xyz="{_numbers(link.axis)}"/>'
        '<limit effort="1" upper="-3.1415" lower="3.1415" velocity="1"/>'
        f'<origin rpy="{_numbers(link.rpy_rad)}" xyz="{_numbers(link.xyz_m)}"/></joint>\n'
    )


# The gain of MuJoCo's velocity servos, in N·m·s/rad, and the inertia of their motors, in kg·m². A gain of 3 or less is
# too weak for heavy creatures to reach their speed. Light links chatter between the limits of a stiff servo if its
# motor is without inertia, and a few of them blow up. From 10 on the gain hardly changes the speed of simulation.
MUJOCO_GAIN = 10.0
MUJOCO_ARMATURE = 0.01


def mjcf(body: Body) -> str:
    """A body, the ground and their physics for MuJoCo."""
    servos = "".join(
        f'<velocity joint="joint_{index}" kv="{MUJOCO_GAIN}" forcerange="{-TORQUE_NM_MAX} {TORQUE_NM_MAX}"/>\n'
        for index in body.driven()
    )
    return (
        '<mujoco>\n<compiler angle="radian"/>\n'
        f'<option timestep="{1 / STEPS_PER_S!r}" gravity="0 0 {-GRAVITY_M_S2}" integrator="implicitfast"/>\n'
        f'<default><geom friction="{FRICTION} 0.005 0.0001"/><joint armature="{MUJOCO_ARMATURE}"/></default>\n'
        '<worldbody>\n<geom type="plane" size="0 0 1" contype="2" conaffinity="1"/>\n'
        f"{_mjcf_body(body, 0)}</worldbody>\n<actuator>\n{servos}</actuator>\n</mujoco>\n"
    )


def _mjcf_body(body: Body, index: int) -> str:
    link = body.links[index]
    place = (0, 0, body.start_height_m) if link.parent is None else link.xyz_m
    half = link.length_m / 2
    size = [link.radius_m, link.radius_m, half] if link.shape == "box" else [link.radius_m, half]
    if link.parent is None:
        joint = "<freejoint/>"
    elif link.joint == "revolute":
        joint = f'<joint name="joint_{index}" type="hinge" axis="{_numbers(link.axis)}"/>'
    else:
        joint = ""
    carried = "".join(_mjcf_body(body, child) for child in body.children(index))
    # Links touch the ground (type 2) and not each other (type 1).
    return (
        f'<body pos="{_numbers(place)}" quat="{_numbers(_quaternion(link.rpy_rad))}">{joint}'
        f'<geom type="{link.shape}" size="{_numbers(size)}" mass="{link.mass_kg!r}" contype="1" conaffinity="2"/>\n'
        f"{carried}</body>\n"
    )


def _quaternion(rpy_rad: Iterable[float]) -> tuple[float, ...]:
    """URDF's roll, pitch and yaw about fixed axes as w, x, y, z."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in rpy_rad)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
