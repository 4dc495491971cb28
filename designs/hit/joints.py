"""The joints of the HIT device: per leg a pin, eleven pins of the nine-bar chain, and the ball."""

from __future__ import annotations

import math

from ..chains.tripod import DELTAS
from ..language.joints import Joint, JointKind, Point
from .parameters import HitLimits, HitParameters

_X: Point = (1.0, 0.0, 0.0)
_Y: Point = (0.0, 1.0, 0.0)
_Z: Point = (0.0, 0.0, 1.0)
_ORIGIN: Point = (0.0, 0.0, 0.0)


def polar(length: float, angle: float) -> tuple[float, float]:
    """A point in the leg's plane: y and z [mm] of a length at an angle from +y."""
    return length * math.cos(angle), length * math.sin(angle)


def build_joints(p: HitParameters, limits: HitLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, leg by leg."""
    legs = [_leg_joints(i, p, limits) for i in range(3)]
    return (*(j for leg in legs for j in leg if j.is_active), *(j for leg in legs for j in leg if not j.is_active))


def _leg_joints(i: int, p: HitParameters, lim: HitLimits) -> tuple[Joint, ...]:
    """Frames: base; frame: origin on the pin, x along the motors, z up; every link: x along it, z along the motors."""
    leg = f"leg_{i + 1}"
    e, h, L2, L3 = p.frame_width / 2.0, p.pivot_height, p.lower_link_length, p.upper_link_length
    v1, v2 = polar(p.lower_offset, p.lower_offset_angle), polar(p.upper_offset, p.upper_offset_angle)
    c, s = math.cos(DELTAS[i]), math.sin(DELTAS[i])
    socket = (p.platform_radius * c, p.platform_radius * s, 0.0)
    theta_1, theta_2 = (lim.theta_1_min, lim.theta_1_max), (lim.theta_2_min, lim.theta_2_max)
    bend = (lim.elbow_min, lim.elbow_max)

    def hinge(
        name: str,
        parent: str,
        child: str,
        at: Point,
        axis: Point,
        to: Point,
        span: tuple[float, float],
        *,
        to_axis: Point = _Z,
        active: bool = False,
    ) -> Joint:
        return Joint(
            name=f"{leg}_{name}",
            kind=JointKind.REVOLUTE,
            parent=parent if parent == "base" else f"{leg}_{parent}",
            child=f"{leg}_{child}",
            p_parent=at,
            axis_parent=axis,
            p_child=to,
            axis_child=to_axis,
            lower=span[0],
            upper=span[1],
            is_active=active,
        )

    return (
        hinge("theta_1", "frame", "lower_left", (0.0, -e, h), _X, _ORIGIN, theta_1, active=True),
        hinge("theta_2", "frame", "lower_right", (0.0, e, h), _X, _ORIGIN, theta_2, active=True),
        hinge(
            "pin",
            "base",
            "frame",
            (p.base_radius * c, p.base_radius * s, 0.0),
            (-s, c, 0.0),
            _ORIGIN,
            (-lim.pin_max, lim.pin_max),
            to_axis=_Y,
        ),
        hinge("elbow_left", "lower_left", "upper_left", (L2, 0.0, 0.0), _Z, _ORIGIN, (-bend[1], -bend[0])),
        hinge("elbow_right", "lower_right", "upper_right", (L2, 0.0, 0.0), _Z, _ORIGIN, bend),
        hinge("elbow_plate", "elbow_plate", "lower_left", _ORIGIN, _Z, (L2, 0.0, 0.0), theta_1),
        hinge("inner_lower_foot", "frame", "inner_lower", (0.0, -e + v1[0], h + v1[1]), _X, _ORIGIN, theta_1),
        hinge("inner_lower_head", "elbow_plate", "inner_lower", (*v1, 0.0), _Z, (L2, 0.0, 0.0), theta_1),
        hinge("inner_upper_foot", "elbow_plate", "inner_upper", (*v2, 0.0), _Z, _ORIGIN, theta_2),
        hinge("inner_upper_head", "top_bar", "inner_upper", (-e + v2[0], v2[1], 0.0), _Z, (L3, 0.0, 0.0), theta_2),
        hinge("top_left", "top_bar", "upper_left", (-e, 0.0, 0.0), _Z, (L3, 0.0, 0.0), theta_2),
        hinge("top_right", "top_bar", "upper_right", (e, 0.0, 0.0), _Z, (L3, 0.0, 0.0), theta_1),
        Joint(
            name=f"{leg}_ball",
            kind=JointKind.SPHERICAL,
            parent="platform",
            child=f"{leg}_top_bar",
            p_parent=socket,
            axis_parent=(0.0, 0.0, -1.0),
            p_child=(0.0, p.ball_height, 0.0),
            axis_child=(0.0, -1.0, 0.0),
            lower=0.0,
            upper=lim.cone_max,
        ),
    )
