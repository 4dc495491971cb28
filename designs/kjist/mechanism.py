"""The KJIST haptic device as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.sections import check_order
from ..chains.tripod import DELTAS, PAIRS, leg_axes
from ..chains.tripod_mechanism import TASK, Circles, TripodMechanism, leg_bodies, task_from_plate
from ..language.mechanism import Array
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .joints import build_joints
from .kinematics import (
    BRANCHES,
    KjistState,
    body_frames,
    joint_values,
    locate_joint,
    rate_rows,
    require_held,
    solve_state,
)
from .parameters import KjistLimits, KjistParameters

__all__ = ["SECTIONS", "TASK", "Kjist"]

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": KjistParameters, "joint_limits": KjistLimits}


class Kjist(TripodMechanism):
    """Three fixed pantographs, 3R joints and hinged bars under one platform, 6 DOF."""

    name = "kjist"
    title = "KJIST 6-DOF haptic device: motors on the base, 3R joints on pantographs, pins on the platform"
    source = "Yoon, Ryu: Design, fabrication and evaluation of a new haptic device using a parallel mechanism"
    assembly_mode = "platform on standing bars, det A < 0"
    section_classes = SECTIONS
    leg_branches = BRANCHES
    #: The closure's angle is 90 degrees - gamma, and gamma is -90 degrees upright.
    start_centre = math.pi
    assembly_sign = -1.0

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.parameters: KjistParameters = self.sections["parameters"]
        self.limits: KjistLimits = self.sections["joint_limits"]
        check_order(self.limits, ("theta_1", "theta_2", "elbow"))
        p = self.parameters
        self.joints = build_joints(p, self.limits)
        self.bodies = leg_bodies(("lower_left", "lower_right", "upper_left", "upper_right", "fork", "block", "bar"))
        lean = min(max((p.base_radius - p.platform_radius) / p.bar_length, -1.0), 1.0)
        height = p.chain_height + math.hypot(p.lower_link_length, p.upper_link_length)
        height += p.bar_length * math.sqrt(1.0 - lean**2)
        self.home = np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])

    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> KjistState:
        """All legs at a pose; in the working branch the plate must be held as well."""
        state = solve_state(self.parameters, pose, branch, require)
        if branch == self.read_branch(None):
            require_held(self.limits, state, require)
        return state

    def joint_values(self, state: KjistState) -> Sequence[Number]:
        """Six motor angles, then the passive joints leg by leg."""
        return joint_values(state)

    def rate_rows(self, state: KjistState) -> Sequence[Sequence[Number]]:
        """d(motor angles)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.parameters, state)

    def body_frames(self, state: KjistState) -> Sequence[tuple[Rot, Vec]]:
        """Base, seven bodies a leg, platform."""
        return body_frames(self.parameters, state)

    def _joint_centres(self, active: Array, require: Require) -> Array:
        """S of the three legs in the base [mm], shape (n, 3, 3)."""
        centres = [
            locate_joint(self.parameters, delta, active[:, 2 * i], active[:, 2 * i + 1], require).array()
            for i, delta in enumerate(DELTAS)
        ]
        return np.stack(centres, axis=1)

    def circles_from_motors(self, active: Array) -> Circles:
        """The dual problem: on the platform every S runs on a circle about a pin, and their distances are known."""
        p, need = self.parameters, Requirements()
        S = self._joint_centres(active, need)
        closed = np.all(need.stacked((len(active),)) >= 0.0, axis=-1)
        wanted = np.stack([np.linalg.norm(S[:, a] - S[:, b], axis=-1) for a, b in PAIRS], axis=-1)
        rho = np.full_like(wanted, p.bar_length)
        return Circles(np.zeros_like(wanted), rho, p.platform_radius, wanted, 0.0, closed)

    def closure_angles(self, state: KjistState) -> Array:
        """The bars' angles from the platform's normal."""
        return 0.5 * math.pi - np.stack([leg.gamma for leg in state.legs], axis=-1)

    def pose_from_closure(self, angles: Array, circles: Circles, active: Array) -> Array:
        """Poses (n, 6) that bring the joint centres of the platform onto those of the base."""
        S = self._joint_centres(active, Requirements())
        points = []
        for i, delta in enumerate(DELTAS):
            foot = np.array([circles.radius * math.cos(delta), circles.radius * math.sin(delta), 0.0])
            points.append(foot + circles.rho[:, i, None] * leg_axes(angles[:, i], delta).z.array())
        s = np.stack(points, axis=1)
        Q = _triangle_axes(S) @ np.swapaxes(_triangle_axes(s), 1, 2)
        origin = S.mean(axis=1) - np.einsum("nij,nj->ni", Q, s.mean(axis=1))
        return task_from_plate(Q, origin)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "plane_radius": (self.parameters.plane_radius, "mm", "centre of the base to the pantographs' planes"),
            "home_height": (float(self.home[2]), "mm", "platform above the base with every elbow at a right angle"),
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
            "bar_length": (p.bar_length, "mm"),
            **{f"leg_{i + 1}_azimuth": (delta, "deg") for i, delta in enumerate(DELTAS)},
        }


def _triangle_axes(points: Array) -> Array:
    """Orthonormal axes (n, 3, 3) that are fixed to triangles (n, 3, 3)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        first = points[:, 1] - points[:, 0]
        first = first / np.linalg.norm(first, axis=-1, keepdims=True)
        normal = np.cross(first, points[:, 2] - points[:, 0])
        normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.stack([first, np.cross(normal, first), normal], axis=-1)
