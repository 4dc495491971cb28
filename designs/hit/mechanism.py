"""The HIT device as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.pantograph import locate_kite_tip
from ..chains.sections import check_order
from ..chains.spherical_joint import SphericalJointDimensions, cone_half_angle
from ..chains.tripod import DELTAS, LEG_BRANCHES
from ..chains.tripod_mechanism import TASK, Circles, TripodMechanism
from ..language.errors import ParameterError
from ..language.mechanism import Array
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .bodies import build_bodies
from .joints import build_joints
from .kinematics import HitState, body_frames, joint_values, rate_rows, solve_state
from .parameters import (
    HitBase,
    HitFrame,
    HitLimits,
    HitLinks,
    HitMaterials,
    HitParameters,
    HitPlatform,
    HitSupplies,
)

__all__ = ["SECTIONS", "TASK", "Hit"]

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {
    "parameters": HitParameters,
    "joint_limits": HitLimits,
    "parts.links": HitLinks,
    "parts.frame": HitFrame,
    "parts.base": HitBase,
    "parts.platform": HitPlatform,
    "parts.spherical_joint": SphericalJointDimensions,
    "supplies": HitSupplies,
    "materials": HitMaterials,
}


class Hit(TripodMechanism):
    """Three nine-bar pantographs on base pins under one platform, 6 DOF."""

    name = "hit"
    title = "HIT 6-DOF haptic device: three nine-bar pantographs, wide ball joints"
    source = "Zhang, Kong, Sun, Du: Design and Analysis of a Novel Haptic Device"
    section_classes = SECTIONS
    leg_branches = LEG_BRANCHES

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.parameters: HitParameters = self.sections["parameters"]
        self.limits: HitLimits = self.sections["joint_limits"]
        check_order(self.limits, ("theta_1", "theta_2", "elbow"))
        self.sections = {**self.sections, "parts.spherical_joint": self._fitted_joint()}
        self.joints = build_joints(self.parameters, self.limits)
        self.bodies = build_bodies(self.sections)
        self.home = np.array([0.0, 0.0, self._home_height(), 0.0, 0.0, 0.0])

    def _fitted_joint(self) -> SphericalJointDimensions:
        """The ball joint with a stem that ends on the top bar's edge; it follows unless the design states another.

        Raises:
            ParameterError: the design states a stem that leaves a gap to the top bar or runs into it.
        """
        d: SphericalJointDimensions = self.sections["parts.spherical_joint"]
        seat = self.parameters.ball_height - self.sections["parts.links"].eye_diameter / 2.0
        if abs(d.stem_length - seat) < 1e-9:
            return d
        if d.stem_length != SphericalJointDimensions().stem_length:
            allowed = f"must be {seat:g}, ball_height_mm less half of eye_diameter_mm; left out, it follows"
            raise ParameterError("parts.spherical_joint.stem_length_mm", d.stem_length, allowed)
        return dataclasses.replace(d, stem_length=seat)

    def _home_height(self) -> float:
        """The platform's height with every elbow bent to a right angle: halfway between folded and stretched."""
        p = self.parameters
        return p.chain_height + math.hypot(p.lower_link_length, p.upper_link_length)

    def solve_state(
        self, pose: Sequence[Number], branch: tuple[tuple[float, float], ...], require: Require
    ) -> HitState:
        """All legs at a pose."""
        return solve_state(self.parameters, pose, branch, require)

    def joint_values(self, state: HitState) -> Sequence[Number]:
        """Six motor angles, then the passive joints leg by leg."""
        return joint_values(state)

    def rate_rows(self, state: HitState) -> Sequence[Sequence[Number]]:
        """d(motor angles)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.parameters, state)

    def body_frames(self, state: HitState) -> Sequence[tuple[Rot, Vec]]:
        """Base, nine links a leg, platform."""
        return body_frames(self.parameters, state)

    def circles_from_motors(self, active: Array) -> Circles:
        """Balls in their legs' planes, where the upper links reach each other."""
        p, need = self.parameters, Requirements()
        tips = [
            locate_kite_tip(active[:, 2 * i], active[:, 2 * i + 1], p.lower_link_length, p.upper_link_length, need)
            for i in range(3)
        ]
        y, w = (np.stack([tip[k] for tip in tips], axis=-1) for k in (0, 1))
        closed = np.all(need.stacked((len(active),)) >= 0.0, axis=-1)
        wanted = np.full_like(y, math.sqrt(3.0) * p.platform_radius)
        return Circles(y, w + p.chain_height, p.base_radius, wanted, 0.0, closed)

    def closure_angles(self, state: HitState) -> Array:
        """The leans of the legs."""
        return np.stack([leg.alpha for leg in state.legs], axis=-1)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "home_height": (float(self.home[2]), "mm", "platform above the pins with every elbow at a right angle"),
            "home_theta_1": (float(home[0]), "deg", "left lower link at home"),
            "home_theta_2": (float(home[1]), "deg", "right lower link at home"),
            "cone_half_angle": (
                cone_half_angle(self.sections["parts.spherical_joint"]),
                "deg",
                "half angle of the ball joint's cone by its dimensions (S1)",
            ),
            "home_condition": (self.scaled_condition(), "", "condition number of the Jacobian at home, lengths by r"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "base_radius": (p.base_radius, "mm"),
            "platform_radius": (p.platform_radius, "mm"),
            "pin_to_motor_height": (p.pivot_height, "mm"),
            "top_bar_to_ball_height": (p.ball_height, "mm"),
            "chain_height": (p.chain_height, "mm"),
            "lower_link_length": (p.lower_link_length, "mm"),
            "upper_link_length": (p.upper_link_length, "mm"),
            "frame_width": (p.frame_width, "mm"),
            **{f"leg_{i + 1}_azimuth": (delta, "deg") for i, delta in enumerate(DELTAS)},
        }
