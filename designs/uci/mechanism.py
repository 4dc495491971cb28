"""The UCI hand controller as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.sections import check_order
from ..chains.tripod import DELTAS, LEG_BRANCHES
from ..chains.tripod_mechanism import TASK, Circles, TripodMechanism, leg_bodies
from ..language.errors import ParameterError
from ..language.mechanism import Array
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require
from .joints import build_joints
from .kinematics import UciState, body_frames, joint_values, locate_tip, rate_rows, solve_state
from .parameters import UciLimits, UciParameters

__all__ = ["SECTIONS", "TASK", "Uci"]

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": UciParameters, "joint_limits": UciLimits}


class Uci(TripodMechanism):
    """Three parallelogram legs on base pins under one platform, 6 DOF."""

    name = "uci"
    title = "UCI 6-DOF hand controller: three pantographs on base pins, balls at their tips"
    source = "Long, Collins: A pantograph linkage parallel platform master hand controller for force-reflection"
    section_classes = SECTIONS
    leg_branches = LEG_BRANCHES

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.parameters: UciParameters = self.sections["parameters"]
        self.limits: UciLimits = self.sections["joint_limits"]
        check_order(self.limits, ("theta_1", "theta_2", "elbow"))
        p = self.parameters
        if p.inner_link_length <= 0.0:
            raise ParameterError(
                "parameters.tip_setback_mm",
                p.tip_setback,
                f"must be below upper_link_length_mm = {p.upper_link_length:g}",
            )
        self.joints = build_joints(p, self.limits)
        self.bodies = leg_bodies(("frame", "lower_left", "lower_right", "upper_left", "upper_right"))
        height = p.chain_height + math.hypot(p.lower_link_length, p.upper_link_length)
        self.home = np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])

    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> UciState:
        """All legs at a pose."""
        return solve_state(self.parameters, pose, branch, require)

    def joint_values(self, state: UciState) -> Sequence[Number]:
        """Six motor angles, then the passive joints leg by leg."""
        return joint_values(self.parameters, state)

    def rate_rows(self, state: UciState) -> Sequence[Sequence[Number]]:
        """d(motor angles)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.parameters, state)

    def body_frames(self, state: UciState) -> Sequence[tuple[Rot, Vec]]:
        """Base, five bodies a leg, platform."""
        return body_frames(self.parameters, state)

    def circles_from_motors(self, active: Array) -> Circles:
        """Balls in their planes; the parallelograms always close."""
        p = self.parameters
        tips = [locate_tip(p, active[:, 2 * i], active[:, 2 * i + 1]) for i in range(3)]
        y, w = (np.stack([tip[k] for tip in tips], axis=-1) for k in (0, 1))
        wanted = np.full_like(y, math.sqrt(3.0) * p.platform_radius)
        return Circles(y, w + p.chain_height, p.base_radius, wanted, 0.0, np.ones(len(active), dtype=bool))

    def closure_angles(self, state: UciState) -> Array:
        """The leans."""
        return np.stack([leg.alpha for leg in state.legs], axis=-1)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "inner_link_length": (self.parameters.inner_link_length, "mm", "D to H, and E to G"),
            "home_height": (float(self.home[2]), "mm", "platform above the pins with every elbow at a right angle"),
            "home_theta_1": (float(home[0]), "deg", "left lower link at home"),
            "home_theta_2": (float(home[1]), "deg", "right lower link at home"),
            "home_condition": (self.scaled_condition(), "", "condition number of the Jacobian at home, lengths by r"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "base_radius": (p.base_radius, "mm"),
            "platform_radius": (p.platform_radius, "mm"),
            "chain_height": (p.chain_height, "mm"),
            "lower_link_length": (p.lower_link_length, "mm"),
            "upper_link_length": (p.upper_link_length, "mm"),
            **{f"leg_{i + 1}_azimuth": (delta, "deg") for i, delta in enumerate(DELTAS)},
        }
