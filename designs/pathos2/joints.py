"""The joints of PATHOS-II: per leg the motor, R2, the elbow R3 and three axes of the globular joint; and the grip."""

from __future__ import annotations

import math

from ..language.joints import Joint, JointKind, Point
from ..language.vectors import Vec
from .kinematics import N_LEGS, SIDES, TURNS, motor_frame
from .parameters import PathosLimits, PathosParameters

_X: Point = (1.0, 0.0, 0.0)
_Y: Point = (0.0, 1.0, 0.0)
_Z: Point = (0.0, 0.0, 1.0)
_ORIGIN: Point = (0.0, 0.0, 0.0)

#: Angles that change their sign in the mirror image of a leg.
_MIRRORED = (1, 3, 4, 6)


def build_joints(p: PathosParameters, limits: PathosLimits) -> tuple[Joint, ...]:
    """All joints, the seven driven ones first: six motors, then the grip.

    The paper counts a globular joint as one of three freedoms; here its two inner bodies, ring and fork, count too.
    """
    legs = [_leg_joints(i, p, limits) for i in range(N_LEGS)]
    return (*(leg[0] for leg in legs), _grip(limits), *(joint for leg in legs for joint in leg[1:]))


def _grip(limits: PathosLimits) -> Joint:
    """The slide between the top plates; its value is their distance 2 h_0."""
    return Joint(
        name="grip",
        kind=JointKind.PRISMATIC,
        parent="lower_plate",
        child="upper_plate",
        p_parent=_ORIGIN,
        axis_parent=_Z,
        p_child=_ORIGIN,
        axis_child=(0.0, 0.0, -1.0),
        lower=limits.gap_min,
        upper=limits.gap_max,
        is_active=True,
    )


def _leg_joints(i: int, p: PathosParameters, limits: PathosLimits) -> tuple[Joint, ...]:
    """Frames: every link's z runs along it; ring and fork have their origin in the globular joint's centre."""
    leg = f"leg_{i + 1}"
    motor, foot = motor_frame(p, i)
    c, s = math.cos(TURNS[i]), math.sin(TURNS[i])
    lean = math.sin(p.globular_tilt)
    plate = "lower_plate" if SIDES[i] > 0.0 else "upper_plate"
    chain: tuple[tuple[str, str, Point, Point, Point, Point], ...] = (
        ("base", f"{leg}_lower_link", _point(foot), _point(motor.z), _ORIGIN, _Z),
        (f"{leg}_lower_link", f"{leg}_middle_link", (0.0, 0.0, p.lower_link_length), _Y, _ORIGIN, _Y),
        (f"{leg}_middle_link", f"{leg}_upper_link", (0.0, 0.0, p.middle_link_length), _X, _ORIGIN, _X),
        (f"{leg}_upper_link", f"{leg}_ring", (0.0, 0.0, p.upper_link_length), _Z, _ORIGIN, _Z),
        (f"{leg}_ring", f"{leg}_fork", _ORIGIN, _Y, _ORIGIN, _Y),
        (
            f"{leg}_fork",
            plate,
            _ORIGIN,
            _Z,
            (p.plate_radius * c, p.plate_radius * s, 0.0),
            (lean * c, lean * s, math.cos(p.globular_tilt)),
        ),
    )
    joints = []
    for k, (parent, child, at, axis, to, to_axis) in enumerate(chain, start=1):
        span = (getattr(limits, f"theta_{k}_min"), getattr(limits, f"theta_{k}_max"))
        if SIDES[i] < 0.0 and k in _MIRRORED:
            span = (-span[1], -span[0])
        joints.append(
            Joint(
                name=f"{leg}_theta_{k}",
                kind=JointKind.REVOLUTE,
                parent=parent,
                child=child,
                p_parent=at,
                axis_parent=axis,
                p_child=to,
                axis_child=to_axis,
                lower=span[0],
                upper=span[1],
                is_active=k == 1,
            )
        )
    return tuple(joints)


def _point(v: Vec) -> Point:
    return float(v.x), float(v.y), float(v.z)
