"""URDF as ROS reads it: with urdf_parser_py, by whose rules the exported files have to be valid."""

from pathlib import Path

import numpy as np
from urdf_parser_py.urdf import URDF, Joint, Robot
from urdf_parser_py.xml_reflection import core

# What urdf_parser_py passes over, and says so.
_EXTENSION = 'Unknown tag "islands" in /robot'
# Of numbers that were read, calculated with and written.
_SAME = 1e-12


def differences(urdf: Path, links: list[dict]) -> list[str]:
    """Reads a body; returns what of it is not valid, or not what islands says of its links."""
    complaints: list[str] = []
    core.on_error = complaints.append
    try:
        robot = URDF.from_xml_file(urdf)
        reached = _reached(robot)
    # The parser has no class of its own for what it refuses.
    except Exception as error:
        return [f"refused: {error}"]
    odd = [complaint for complaint in complaints if not complaint.startswith(_EXTENSION)]
    if len(links) != len(robot.links):
        return [*odd, f"{len(robot.links)} links instead of {len(links)}"]
    wrong = {
        "names that are not unique": len(set(robot.link_map)) != len(links)
        or len(set(robot.joint_map)) != len(links) - 1,
        "no tree": len(reached) != len(links) or len(robot.joints) != len(links) - 1,
        "other masses": [link.inertial.mass for link in robot.links] != [link["mass"] for link in links],
        "other inertias": not all(map(_has_inertia, robot.links, links)),
        "impossible limits": not all(map(_has_limits, robot.joints)),
    }
    return odd + [what for what, is_wrong in wrong.items() if is_wrong]


def _reached(robot: Robot) -> list[str]:
    """The links that hang on the root, and itself."""
    reached = [robot.get_root()]
    for link in reached:
        reached += [child for _, child in robot.child_map.get(link, [])]
    return reached


def _has_inertia(link: object, expected: dict) -> bool:
    found = link.inertial.inertia
    moments = np.array([found.ixx, found.iyy, found.izz, found.ixy, found.ixz, found.iyz])
    return np.abs(moments - expected["inertia"]).max() <= _SAME * max(expected["inertia"])


def _has_limits(joint: Joint) -> bool:
    if joint.type == "fixed":
        return True
    limit = joint.limit
    return limit is not None and limit.lower <= limit.upper and limit.effort >= 0 and limit.velocity >= 0
