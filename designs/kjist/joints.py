"""The joints of the KJIST device: per leg two fixed motors, three pins, a 3R joint, the platform's pin."""

from __future__ import annotations

import math

from ..chains.leg_joints import AXIS_X, AXIS_Y, AXIS_Z, ORIGIN, leg_hinge
from ..chains.tripod import DELTAS
from ..language.joints import Joint, Point
from .parameters import KjistLimits, KjistParameters


def build_joints(p: KjistParameters, limits: KjistLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, leg by leg."""
    legs = [_leg_joints(i, p, limits) for i in range(3)]
    return (*(j for leg in legs for j in leg if j.is_active), *(j for leg in legs for j in leg if not j.is_active))


def _leg_joints(i: int, p: KjistParameters, lim: KjistLimits) -> tuple[Joint, ...]:
    """The frames are those of `kinematics.body_frames`; the three turns of the 3R joint are named after their order."""
    leg, c, s = f"leg_{i + 1}", math.cos(DELTAS[i]), math.sin(DELTAS[i])
    motors: Point = (p.plane_radius * c, p.plane_radius * s, p.chain_height)
    platform_pin: Point = (p.platform_radius * c, p.platform_radius * s, 0.0)
    radial, against = (c, s, 0.0), (s, -c, 0.0)
    elbow, top = (p.lower_link_length, 0.0, 0.0), (p.upper_link_length, 0.0, 0.0)
    theta_1, theta_2 = (lim.theta_1_min, lim.theta_1_max), (lim.theta_2_min, lim.theta_2_max)
    bend, back = (lim.elbow_min, lim.elbow_max), (-lim.elbow_max, -lim.elbow_min)
    upright = math.radians(-90.0)

    def motor(name: str, link: str, span: tuple[float, float]) -> Joint:
        return leg_hinge(leg, name, "base", link, motors, ORIGIN, span, axis=radial, to_axis=AXIS_Z, active=True)

    def about(limit: float) -> tuple[float, float]:
        return -limit, limit

    return (
        motor("theta_1", "lower_left", theta_1),
        motor("theta_2", "lower_right", theta_2),
        leg_hinge(leg, "elbow_left", "lower_left", "upper_left", elbow, ORIGIN, back),
        leg_hinge(leg, "elbow_right", "lower_right", "upper_right", elbow, ORIGIN, bend),
        leg_hinge(leg, "top", "upper_left", "upper_right", top, top, bend),
        leg_hinge(
            leg,
            "swing",
            "upper_right",
            "fork",
            (p.upper_link_length, 0.0, -p.joint_inset),
            ORIGIN,
            about(lim.swing_max),
        ),
        leg_hinge(leg, "tilt", "fork", "block", ORIGIN, ORIGIN, about(lim.fork_max), axis=AXIS_Y),
        leg_hinge(leg, "twist", "block", "bar", ORIGIN, ORIGIN, about(lim.twist_max), axis=AXIS_X),
        leg_hinge(
            leg,
            "plate_pin",
            "platform",
            "bar",
            platform_pin,
            (p.bar_length, 0.0, 0.0),
            (upright - lim.bar_lean_max, upright + lim.bar_lean_max),
            axis=against,
            to_axis=AXIS_Y,
        ),
    )
