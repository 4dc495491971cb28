"""The joints of the UCI hand controller: per leg a pin, two coaxial motors, three pins of the parallelogram, a ball."""

from __future__ import annotations

import math

from ..chains.leg_joints import AXIS_X, AXIS_Z, ORIGIN, base_pin, leg_hinge
from ..chains.tripod import DELTAS
from ..language.joints import Joint, JointKind
from .parameters import UciLimits, UciParameters


def build_joints(p: UciParameters, limits: UciLimits) -> tuple[Joint, ...]:
    """All joints, the six driven ones first, leg by leg."""
    legs = [_leg_joints(i, p, limits) for i in range(3)]
    return (*(j for leg in legs for j in leg if j.is_active), *(j for leg in legs for j in leg if not j.is_active))


def _leg_joints(i: int, p: UciParameters, lim: UciLimits) -> tuple[Joint, ...]:
    """Frames: frame: origin on the pin, x along the motors, z up; every link: x along it, z along the motors."""
    leg, motors = f"leg_{i + 1}", (0.0, 0.0, p.chain_height)
    L2, L3, a = p.lower_link_length, p.upper_link_length, p.inner_link_length
    theta_1, theta_2 = (lim.theta_1_min, lim.theta_1_max), (lim.theta_2_min, lim.theta_2_max)
    bend = (lim.elbow_min, lim.elbow_max)
    c, s, bar, tilt = math.cos(DELTAS[i]), math.sin(DELTAS[i]), p.ball_bar_angle, p.socket_tilt
    return (
        leg_hinge(
            leg, "theta_1", "frame", "lower_left", motors, ORIGIN, theta_1, axis=AXIS_X, to_axis=AXIS_Z, active=True
        ),
        leg_hinge(
            leg, "theta_2", "frame", "lower_right", motors, ORIGIN, theta_2, axis=AXIS_X, to_axis=AXIS_Z, active=True
        ),
        base_pin(leg, DELTAS[i], p.base_radius, lim.pin_max),
        leg_hinge(leg, "elbow_left", "lower_left", "upper_left", (L2, 0.0, 0.0), ORIGIN, (-bend[1], -bend[0])),
        leg_hinge(leg, "elbow_right", "lower_right", "upper_right", (a, 0.0, 0.0), ORIGIN, bend),
        leg_hinge(leg, "top", "upper_left", "upper_right", (a, 0.0, 0.0), (L2, 0.0, 0.0), bend),
        Joint(
            name=f"{leg}_ball",
            kind=JointKind.SPHERICAL,
            parent="platform",
            child=f"{leg}_upper_left",
            p_parent=(p.platform_radius * c, p.platform_radius * s, 0.0),
            axis_parent=(s * math.sin(tilt), -c * math.sin(tilt), -math.cos(tilt)),
            p_child=(L3, 0.0, 0.0),
            axis_child=(-math.cos(bar), -math.sin(bar), 0.0),
            lower=0.0,
            upper=lim.cone_max,
        ),
    )
