"""The HIT device as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.pantograph import locate_kite_tip
from ..chains.spherical_joint import SphericalJointDimensions, cone_half_angle
from ..chains.tripod import DELTAS, close_loops, leg_axes, plate_pose
from ..language.errors import ParameterError, UnknownNameError
from ..language.formulas import FormulaMechanism
from ..language.forward import Candidates
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.parameters import check_section
from ..language.poses import task_from_pose
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .bodies import build_bodies
from .joints import build_joints
from .kinematics import BRANCHES, HitState, body_frames, joint_values, rate_rows, solve_state
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

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(
    Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")
)

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


class Hit(FormulaMechanism):
    """Three nine-bar pantographs on base pins under one platform, 6 DOF."""

    name = "hit"
    title = "HIT 6-DOF haptic device: three nine-bar pantographs, wide ball joints"
    source = "Zhang, Kong, Sun, Du: Design and Analysis of a Novel Haptic Device"
    task = TASK
    branches = tuple(BRANCHES)
    assembly_mode = "platform up, det A > 0"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = {key: sections.get(key) or cls() for key, cls in SECTIONS.items()}
        for key, section in self.sections.items():
            try:
                check_section(section)
            except ParameterError as error:
                raise ParameterError(f"{key}.{error.field}", error.value, error.allowed) from None
        self.parameters: HitParameters = self.sections["parameters"]
        self.limits: HitLimits = self.sections["joint_limits"]
        self._check_limits()
        self.joints = build_joints(self.parameters, self.limits)
        self.bodies = build_bodies(self.sections)
        self.home = np.array([0.0, 0.0, self._home_height(), 0.0, 0.0, 0.0])

    def _check_limits(self) -> None:
        for low, high in (("theta_1_min", "theta_1_max"), ("theta_2_min", "theta_2_max"), ("elbow_min", "elbow_max")):
            if getattr(self.limits, low) >= getattr(self.limits, high):
                value = math.degrees(getattr(self.limits, high))
                raise ParameterError(
                    f"joint_limits.{high}_deg",
                    value,
                    f"must be above {low}_deg = {math.degrees(getattr(self.limits, low)):g}",
                )

    def _home_height(self) -> float:
        """The platform's height with every elbow bent to a right angle: halfway between folded and stretched."""
        p = self.parameters
        return p.chain_height + math.hypot(p.lower_link_length, p.upper_link_length)

    def read_branch(self, branch: str | None) -> tuple[tuple[float, float], ...]:
        """Signs (pin, elbow) of the three legs; `a/b/c` names one branch per leg."""
        names = (branch or self.branches[0]).split("/")
        names = names * 3 if len(names) == 1 else names
        for name in names:
            if name not in BRANCHES:
                raise UnknownNameError("branch", name, self.branches)
        if len(names) != 3:
            raise UnknownNameError("branch", branch or "", (*self.branches, "three of these joined by /"))
        return tuple(BRANCHES[name] for name in names)

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

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses of the working assembly mode for motor angles (n, 6) [rad].

        Newton on the three leans from 28 starts (and from `near`, if given). A pose counts if it closes, if its
        closure determinant is positive and if all joints keep their limits; when more than one does, the answer is
        refused unless `near` decides.

        Source: Zhang et al., eq. (12). Printed: Newton, silent on starts. A cold start from zero lean converges to
        another assembly for 1-5 % of poses. Shown by: tests/papers/test_zhang_hit.py.
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        p, n = self.parameters, len(active)
        need = Requirements()
        tips = [
            locate_kite_tip(active[:, 2 * i], active[:, 2 * i + 1], p.lower_link_length, p.upper_link_length, need)
            for i in range(3)
        ]
        y = np.stack([tip[0] for tip in tips], axis=-1)
        rho = np.stack([tip[1] for tip in tips], axis=-1) + p.chain_height
        closed = np.all(need.stacked((n,)) >= 0.0, axis=-1) & np.all(np.isfinite(active), axis=-1)
        y, rho = np.where(closed[:, None], y, 0.0), np.where(closed[:, None], rho, p.chain_height)
        starts = [np.zeros(3)] + [np.array(s) for s in itertools.product((-0.6, 0.0, 0.6), repeat=3)]
        candidates = Candidates(n, self.home, near)
        guesses = [np.broadcast_to(s, (n, 3)) for s in starts]
        if candidates.near is not None:
            state = self.solve_state(tuple(candidates.near.T), self.read_branch(None), Requirements())
            guesses.insert(0, np.stack([leg.alpha for leg in state.legs], axis=-1))
        for guess in guesses:
            alphas, error, det = close_loops(y, rho, p.base_radius, p.platform_radius, guess)
            poses = self._pose_of(alphas, y, rho)
            legal = closed & (error < 1e-9 * p.platform_radius) & (det > 0.0) & self._keeps_limits(poses, active)
            candidates.offer(poses, legal, error)
        return candidates.solution()

    def _pose_of(self, alphas: Array, y: Array, rho: Array) -> Array:
        F = []
        for i, delta in enumerate(DELTAS):
            axes = leg_axes(alphas[:, i], delta)
            c, s = math.cos(delta), math.sin(delta)
            foot = np.array([self.parameters.base_radius * c, self.parameters.base_radius * s, 0.0])
            F.append(foot + y[:, i, None] * np.array([-s, c, 0.0]) + rho[:, i, None] * axes.z.array())
        R, origin = plate_pose(np.stack(F, axis=1))
        T = np.zeros((len(alphas), 4, 4))
        T[:, :3, :3], T[:, :3, 3], T[:, 3, 3] = R, origin, 1.0
        return task_from_pose(T)

    def _keeps_limits(self, poses: Array, active: Array) -> Array:
        """The inverse of the pose is legal and returns the motor angles that were asked for."""
        inverse = self.solve_inverse(poses)
        back = np.max(np.abs(inverse.joints[:, :6] - active), axis=-1)
        return inverse.is_reachable & (back < 1e-6)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        J = self.compute_jacobian(self.home[None])[0]
        scaled = J @ np.diag([1.0] * 3 + [1.0 / self.parameters.platform_radius] * 3)
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
            "home_condition": (
                float(np.linalg.cond(scaled)),
                "",
                "condition number of the Jacobian at home, lengths by r",
            ),
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
