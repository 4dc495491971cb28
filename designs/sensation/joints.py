"""The eleven pins of SenSation: two motors, two passive ones on the motors' axes, seven between links."""

from __future__ import annotations

from ..chains.dyad_pair_mechanism import hinge
from ..language.joints import Joint
from ..language.units import DEG
from .parameters import SensationLimits, SensationParameters

#: The passive links on the base are held by elbow and motor limits; their own only bound the columns [rad].
_ARM_SPAN = {"right": (-90.0 * DEG, 200.0 * DEG), "left": (-20.0 * DEG, 270.0 * DEG)}


def build_joints(p: SensationParameters, lim: SensationLimits) -> tuple[Joint, ...]:
    """All joints, the two driven ones first; the paper's letters A, a*, B, E, F and C, c*, D, G, H, then P."""
    half, l1, l2 = 0.5 * p.pivot_distance, p.arm_length, p.crank_length
    active, passive = [], []
    spans = {"right": (lim.theta_2_min, lim.theta_2_max), "left": (lim.theta_4_min, lim.theta_4_max)}
    bends = {"right": (lim.elbow_min, lim.elbow_max), "left": (-lim.elbow_max, -lim.elbow_min)}
    for side, pivot, motor in (("right", half, "theta_2"), ("left", -half, "theta_4")):
        crank, arm, rod, tip = (f"{side}_{kind}" for kind in ("crank", "arm", "rod", "tip_link"))
        bend = bends[side]
        back = (-bend[1], -bend[0])
        active.append(hinge(motor, "base", crank, (pivot, 0.0), (0.0, 0.0), spans[side], active=True))
        passive += [
            hinge(f"{side}_pivot", "base", arm, (pivot, 0.0), (0.0, 0.0), _ARM_SPAN[side]),
            hinge(f"elbow_{side}", arm, tip, (l1, 0.0), (0.0, 0.0), bend),
            hinge(f"{side}_crank_rod", crank, rod, (l2, 0.0), (0.0, 0.0), back),
            hinge(f"{side}_rod_tip", rod, tip, (l1, 0.0), (l2, 0.0), bend),
        ]
    # The tip pin may turn nearly all round; the tip links lie in different layers.
    l4 = p.tip_link_length
    ends = (-350.0 * DEG, 10.0 * DEG)
    return (*active, *passive, hinge("tip", "right_tip_link", "left_tip_link", (l4, 0.0), (l4, 0.0), ends))
