"""Bodies whose motion is not chaotic, as URDF."""

import math

# Gravity of the task that the pendulum swings in, in m/s².
_GRAVITY_M_S2 = 9.81
_ARM_M = 0.6
_ARM_RADIUS_M = 0.02
_TILT_RAD = 0.2

BOX_HALF_M = 0.1
PUSH_M_S = 3.0
# What friction of 0.5 × 0.5 lets it slide under 10 m/s².
SLIDE_M = PUSH_M_S**2 / (2 * 0.25 * 10.0)


def _moments(x: float, y: float, z: float) -> str:
    return f'<inertia ixx="{x!r}" iyy="{y!r}" izz="{z!r}" ixy="0" ixz="0" iyz="0"/>'


def _link(name: str, mass_kg: float, moments: str, shape: str, origin: str = "0 0 0") -> str:
    geometry = f'<origin xyz="{origin}"/><geometry>{shape}</geometry>'
    return (
        f'<link name="{name}"><inertial><origin xyz="{origin}"/><mass value="{mass_kg!r}"/>{moments}</inertial>'
        f"<visual>{geometry}</visual><collision>{geometry}</collision></link>"
    )


def _box(name: str, mass_kg: float, side_m: float) -> str:
    moment = mass_kg * side_m**2 / 6
    return _link(name, mass_kg, _moments(moment, moment, moment), f'<box size="{side_m} {side_m} {side_m}"/>')


def _robot(*elements: str) -> str:
    return f'<?xml version="1.0"?>\n<robot name="by-hand">{"".join(elements)}</robot>\n'


_BALL_MOMENT = 0.4 * 2.0 * 0.1**2
BALL = _robot(_link("ball", 2.0, _moments(*[_BALL_MOMENT] * 3), '<sphere radius="0.1"/>'))

BOX = _robot(_box("box", 1.0, 2 * BOX_HALF_M))

# An arm on the side of a block that is ten thousand times as heavy, hanging by its end.
_ACROSS = _ARM_M**2 / 12 + _ARM_RADIUS_M**2 / 4
_ARM = _link(
    "arm",
    1.0,
    _moments(_ACROSS, _ACROSS, _ARM_RADIUS_M**2 / 2),
    f'<cylinder radius="{_ARM_RADIUS_M}" length="{_ARM_M}"/>',
    f"0 0 {-_ARM_M / 2}",
)
PENDULUM = _robot(
    _box("block", 10_000.0, 2.0),
    _ARM,
    '<joint name="hinge_1" type="continuous"><parent link="block"/><child link="arm"/>'
    f'<origin xyz="1.1 0 0.5" rpy="{_TILT_RAD} 0 0"/><axis xyz="1 0 0"/></joint>',
)
_ABOUT_END = _ACROSS + (_ARM_M / 2) ** 2
# With the first two terms of the period's series in the amplitude.
PENDULUM_PERIOD_S = (
    2 * math.pi * math.sqrt(_ABOUT_END / (_GRAVITY_M_S2 * _ARM_M / 2)) * (1 + _TILT_RAD**2 / 16)
)

# Two boxes that turn against each other, driven by a sine of a second and a half.
ROTOR = _robot(
    _box("one", 2.0, 0.3),
    _box("other", 1.0, 0.2),
    '<joint name="joint_1" type="continuous"><parent link="one"/><child link="other"/><origin xyz="0.3 0 0"/>'
    '<axis xyz="1 0 0"/><limit effort="20" velocity="3"/></joint>'
    '<islands version="1" control-period="0.1"><motor joint="joint_1" waveform="sine" amplitude="3" '
    'phase-start="0" phase-step="0.4"/></islands>',
)
