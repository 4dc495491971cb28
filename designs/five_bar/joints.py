"""The five pins of the five-bar: two motors, two elbows, the tip."""

from __future__ import annotations

from ..chains.dyad_pair_mechanism import hinge
from ..language.joints import Joint
from .parameters import FiveBarLimits, FiveBarParameters

_END = (0.0, 0.0)


def build_joints(p: FiveBarParameters, lim: FiveBarLimits) -> tuple[Joint, ...]:
    """All joints, the two driven ones first."""
    half, elbow, tip = 0.5 * p.pivot_distance, (p.arm_length, 0.0), (p.tip_link_length, 0.0)
    return (
        hinge("theta_1", "base", "right_arm", (half, 0.0), _END, (lim.theta_1_min, lim.theta_1_max), active=True),
        hinge("theta_3", "base", "left_arm", (-half, 0.0), _END, (lim.theta_3_min, lim.theta_3_max), active=True),
        hinge("elbow_right", "right_arm", "right_tip_link", elbow, _END, (lim.elbow_min, lim.elbow_max)),
        hinge("elbow_left", "left_arm", "left_tip_link", elbow, _END, (-lim.elbow_max, -lim.elbow_min)),
        hinge("tip", "right_tip_link", "left_tip_link", tip, tip, (-lim.tip_max, -lim.tip_min)),
    )
