"""The joints of the KAIST master hand: per leg a pin, two motors, two elbows, the top pin, the ball on its end."""

from __future__ import annotations

import math

from ..chains.leg_joints import AXIS_X, AXIS_Z, ORIGIN, base_pin, leg_hinge
from ..chains.tripod import DELTAS
from ..language.joints import Joint, JointKind
from .parameters import KaistLimits, KaistParameters


def build_joints(p: KaistParameters, limits: KaistLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, leg by leg."""
    legs = [_leg_joints(i, p, limits) for i in range(3)]
    return (*(j for leg in legs for j in leg if j.is_active), *(j for leg in legs for j in leg if not j.is_active))


def _leg_joints(i: int, p: KaistParameters, lim: KaistLimits) -> tuple[Joint, ...]:
    """Frames: frame: origin on the pin, x along the motors, z up; every link: x along it, z along the motors."""
    leg, half, h = f"leg_{i + 1}", 0.5 * p.motor_distance, p.chain_height
    elbow, top = (p.lower_link_length, 0.0, 0.0), (p.upper_link_length, 0.0, 0.0)
    theta_1, theta_2 = (lim.theta_1_min, lim.theta_1_max), (lim.theta_2_min, lim.theta_2_max)
    left, right = (-lim.elbow_max, -lim.elbow_min), (lim.elbow_min, lim.elbow_max)
    c, s = math.cos(DELTAS[i]), math.sin(DELTAS[i])

    def motor(name: str, link: str, y: float, span: tuple[float, float]) -> Joint:
        return leg_hinge(leg, name, "frame", link, (0.0, y, h), ORIGIN, span, axis=AXIS_X, to_axis=AXIS_Z, active=True)

    return (
        motor("theta_1", "lower_left", -half, theta_1),
        motor("theta_2", "lower_right", half, theta_2),
        base_pin(leg, DELTAS[i], p.base_radius, lim.pin_max),
        leg_hinge(leg, "elbow_left", "lower_left", "upper_left", elbow, ORIGIN, left),
        leg_hinge(leg, "elbow_right", "lower_right", "upper_right", elbow, ORIGIN, right),
        leg_hinge(leg, "top", "upper_left", "upper_right", top, top, (lim.top_min, lim.top_max)),
        # The top pin is fixed in the right upper link; its inner end is the ball-bar, so the socket opens outwards.
        Joint(
            name=f"{leg}_ball",
            kind=JointKind.SPHERICAL,
            parent="platform",
            child=f"{leg}_upper_right",
            p_parent=(p.platform_radius * c, p.platform_radius * s, 0.0),
            axis_parent=(c, s, 0.0),
            p_child=(p.upper_link_length, 0.0, -p.ball_inset),
            axis_child=AXIS_Z,
            lower=0.0,
            upper=lim.cone_max,
        ),
    )
