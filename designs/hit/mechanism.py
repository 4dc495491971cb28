"""The HIT device as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..chains.pantograph import locate_kite_tip
from ..chains.spherical_joint import SphericalJointDimensions, cone_half_angle
from ..chains.tripod import DELTAS, close_loops, leg_axes, plate_pose
from ..language.errors import ParameterError, UnknownNameError
from ..language.mechanism import Array, Coordinate, ForwardSolution, InverseSolution, Mechanism
from ..language.parameters import check_section
from ..language.poses import pose_from_parts, pose_from_task, task_from_pose
from ..language.vectors import Rot, Vec, vec_from_array
from ..language.vocabulary import Requirements, acos, cos, sin
from .bodies import build_bodies
from .joints import build_joints, joint_values
from .kinematics import LegState, cone_cosine, rate_rows, solve_leg
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

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz"))

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

#: Working modes of a leg: (pin, elbow) signs of `solve_leg`.
BRANCHES: dict[str, tuple[float, float]] = {
    "up-out": (1.0, 1.0),
    "up-in": (1.0, -1.0),
    "down-out": (-1.0, 1.0),
    "down-in": (-1.0, -1.0),
}

_LIMIT_SLACK = 1e-9


class Hit(Mechanism):
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
        self._lower = np.array([j.lower for j in self.joints])
        self._upper = np.array([j.upper for j in self.joints])

    def _check_limits(self) -> None:
        for low, high in (("theta_1_min", "theta_1_max"), ("theta_2_min", "theta_2_max"), ("elbow_min", "elbow_max")):
            if getattr(self.limits, low) >= getattr(self.limits, high):
                value = math.degrees(getattr(self.limits, high))
                raise ParameterError(f"joint_limits.{high}_deg", value, f"must be above {low}_deg "
                                     f"= {math.degrees(getattr(self.limits, low)):g}")

    def _home_height(self) -> float:
        """The platform's height with every elbow bent to a right angle: halfway between folded and stretched."""
        p = self.parameters
        return p.chain_height + math.hypot(p.lower_link_length, p.upper_link_length)

    def _signs(self, branch: str | None) -> list[tuple[float, float]]:
        names = (branch or self.branches[0]).split("/")
        names = names * 3 if len(names) == 1 else names
        for name in names:
            if name not in BRANCHES:
                raise UnknownNameError("branch", name, self.branches)
        if len(names) != 3:
            raise UnknownNameError("branch", branch or "", (*self.branches, "three of these joined by /"))
        return [BRANCHES[name] for name in names]

    def _legs(self, poses: Array, signs: list[tuple[float, float]], need: Requirements | None = None) -> list[LegState]:
        pose = tuple(np.moveaxis(np.asarray(poses, dtype=float), -1, 0))
        states = []
        for i, (pin, elbow) in enumerate(signs):
            def require(margin: Any, name: str, leg: str = f"leg_{i + 1}") -> None:
                if need is not None:
                    need(margin, f"{leg} {name}")
            # Out of reach the formulas may divide by zero; the margins say so.
            with np.errstate(all="ignore"):
                states.append(solve_leg(self.parameters, pose, i, pin, elbow, require))
        return states

    def solve_inverse(self, poses: Array, branch: str | None = None) -> InverseSolution:
        """Joint values for poses (n, 6); joint limits are required in the working branch only.

        Branches other than the default are assemblies that the solids do not allow; `a/b/c` names one per leg.
        """
        poses = np.asarray(poses, dtype=float)
        signs, need = self._signs(branch), Requirements()
        pose = tuple(np.moveaxis(poses, -1, 0))
        states = self._legs(poses, signs, need)
        with np.errstate(all="ignore"):
            legs = [joint_values(s.alpha, s.links, acos(cone_cosine(pose, s, i))) for i, s in enumerate(states)]
        columns = [np.broadcast_to(v, poses.shape[:-1]) for leg in legs for v in leg[:2]]
        columns += [np.broadcast_to(v, poses.shape[:-1]) for leg in legs for v in leg[2:]]
        joints = np.stack(columns, axis=-1)
        names, margins = need.names, need.stacked(poses.shape[:-1])
        if all(sign == BRANCHES[self.branches[0]] for sign in signs):
            names = names + [f"{j.name} below its limit" for j in self.joints]
            names = names + [f"{j.name} above its limit" for j in self.joints]
            margins = np.concatenate([margins, joints - self._lower + _LIMIT_SLACK, self._upper - joints + _LIMIT_SLACK], -1)
        finite = np.isfinite(margins)
        joints = np.where(np.isfinite(joints), joints, 0.0)
        return InverseSolution(joints=joints, margins=np.where(finite, margins, -np.inf), requirements=tuple(names),
                               is_reachable=np.all(finite & (margins >= 0.0), axis=-1))

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
        tips = [locate_kite_tip(active[:, 2 * i], active[:, 2 * i + 1], p.lower_link_length, p.upper_link_length,
                                lambda m, name: need(m, name)) for i in range(3)]
        y = np.stack([tip[0] for tip in tips], axis=-1)
        rho = np.stack([tip[1] for tip in tips], axis=-1) + p.chain_height
        closed = np.all(need.stacked((n,)) >= 0.0, axis=-1) & np.all(np.isfinite(active), axis=-1)
        y, rho = np.where(closed[:, None], y, 0.0), np.where(closed[:, None], rho, p.chain_height)
        starts = [np.zeros(3)] + [np.array(s) for s in itertools.product((-0.6, 0.0, 0.6), repeat=3)]
        poses = np.tile(self.home, (n, 1))
        best = np.full(n, np.inf)
        n_found, residual = np.zeros(n, dtype=int), np.full(n, np.inf)
        found: list[list[Array]] = [[] for _ in range(n)]
        guesses = [np.broadcast_to(s, (n, 3)) for s in starts]
        if near is not None:
            near = np.broadcast_to(np.asarray(near, dtype=float), (n, 6))
            guesses.insert(0, np.stack([s.alpha for s in self._legs(near, self._signs(None))], axis=-1))
        for guess in guesses:
            alphas, error, det = close_loops(y, rho, p.base_radius, p.platform_radius, guess)
            candidate = self._pose_of(alphas, y, rho)
            legal = closed & (error < 1e-9 * p.platform_radius) & (det > 0.0)
            legal &= self._keeps_limits(candidate, active)
            for k in np.flatnonzero(legal):
                if any(np.max(np.abs(candidate[k] - other)) < 1e-5 for other in found[k]):
                    continue
                found[k].append(candidate[k])
                n_found[k] += 1
                score = 0.0 if near is None else float(np.linalg.norm(candidate[k] - near[k]))
                if score < best[k]:
                    best[k], poses[k], residual[k] = score, candidate[k], error[k]
        solved = (n_found == 1) if near is None else (n_found >= 1)
        return ForwardSolution(poses=poses, is_solved=solved, n_candidates=n_found, residual=residual)

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

    def compute_jacobian(self, poses: Array) -> Array:
        """d(motor angles)/d(twist), shape (n, 6, 6); rows in motor order, columns v [mm/s], omega [rad/s]."""
        poses = np.asarray(poses, dtype=float)
        pose = tuple(np.moveaxis(poses, -1, 0))
        rows = []
        for i, state in enumerate(self._legs(poses, self._signs(None))):
            for linear, turning in rate_rows(self.parameters, pose, i, state):
                rows.append(np.concatenate([linear.array(), turning.array()], axis=-1))
        return np.stack(np.broadcast_arrays(*rows), axis=-2)

    def place_bodies(self, poses: Array) -> Array:
        """Ts_base_body in the order of `bodies`: base, nine links a leg, platform."""
        poses = np.asarray(poses, dtype=float)
        p = self.parameters
        e, v1 = p.frame_width / 2.0, (p.lower_offset, p.lower_offset_angle)
        v2 = (p.upper_offset, p.upper_offset_angle)
        placed = [np.broadcast_to(np.eye(4), (*poses.shape[:-1], 4, 4))]
        for i, state in enumerate(self._legs(poses, self._signs(None))):
            axes = leg_axes(state.alpha, DELTAS[i])
            foot = vec_from_array(np.array([math.cos(DELTAS[i]), math.sin(DELTAS[i]), 0.0]) * p.base_radius)

            def at(y: Any, z: Any, axes: Rot = axes, foot: Vec = foot) -> Vec:
                return foot + axes.y * y + axes.z * z

            def link(angle: Any, y: Any, z: Any, axes: Rot = axes) -> Array:
                along = axes.y * cos(angle) + axes.z * sin(angle)
                across = axes.z * cos(angle) - axes.y * sin(angle)
                return pose_from_parts(Rot(along, across, axes.x), at(y, z))

            t1, t2, up_left, up_right = state.links
            left = (-e + p.lower_link_length * cos(t1), p.pivot_height + p.lower_link_length * sin(t1))
            right = (e + p.lower_link_length * cos(t2), p.pivot_height + p.lower_link_length * sin(t2))
            shift_1 = (v1[0] * math.cos(v1[1]), v1[0] * math.sin(v1[1]))
            shift_2 = (v2[0] * math.cos(v2[1]), v2[0] * math.sin(v2[1]))
            placed += [
                pose_from_parts(axes, at(0.0, 0.0)),
                link(t1, -e, p.pivot_height),
                link(t2, e, p.pivot_height),
                link(up_left, *left),
                link(up_right, *right),
                link(0.0, state.y, p.pivot_height + state.w),
                link(t1, -e + shift_1[0], p.pivot_height + shift_1[1]),
                link(0.0, *left),
                link(up_left, left[0] + shift_2[0], left[1] + shift_2[1]),
            ]
        placed.append(pose_from_task(poses))
        return np.stack(np.broadcast_arrays(*placed), axis=-3)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        J = self.compute_jacobian(self.home[None])[0]
        scaled = J @ np.diag([1.0] * 3 + [1.0 / self.parameters.platform_radius] * 3)
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "home_height": (float(self.home[2]), "mm", "platform above the pins with every elbow at a right angle"),
            "home_theta_1": (float(home[0]), "deg", "left lower link at home"),
            "home_theta_2": (float(home[1]), "deg", "right lower link at home"),
            "cone_half_angle": (cone_half_angle(self.sections["parts.spherical_joint"]), "deg",
                                "half angle of the ball joint's cone by its dimensions (S1)"),
            "home_condition": (float(np.linalg.cond(scaled)), "", "condition number of the Jacobian at home, lengths by r"),
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
