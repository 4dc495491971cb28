"""The haptic pen as a mechanism: solves both ways in closed form, differentiates, places its bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.hinged_arm import ARM_RANGES, Arm, ArmLimits
from ..chains.hinged_five_bar import ELBOWS, read_elbows
from ..chains.sections import check_order, resolve_sections
from ..chains.twin_arms import TwinState, twin_frames
from ..language.formulas import FormulaMechanism
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .joints import build_arms, build_bodies, build_joints
from .kinematics import force_rows, joint_values, locate_pen, rate_rows, solve_state
from .parameters import HapticPenForward, HapticPenParameters

TASK = (
    *(Coordinate(name=n, unit="mm") for n in "xyz"),
    Coordinate(name="rx", unit="deg"),
    Coordinate(name="rz", unit="deg"),
)

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {
    "parameters": HapticPenParameters,
    "joint_limits": ArmLimits,
    "forward": HapticPenForward,
}


class HapticPen(FormulaMechanism):
    """A pen between two waist-hinged five-bars: 6 motors, 5 DOF, and a roll that is free."""

    name = "haptic_pen"
    title = "Twin-Pantograph haptic pen: two waist-hinged five-bars, redundant waist, passive roll"
    source = "Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen"
    task = TASK
    branches = tuple(ELBOWS)
    assembly_mode = "both tips beyond their elbows"

    #: The pen may roll in its hubs without any motor noticing.
    n_idle_freedoms = 1

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(SECTIONS, sections)
        check_order(self.sections["joint_limits"], ARM_RANGES)
        self.parameters: HapticPenParameters = self.sections["parameters"]
        self.joints = build_joints(self.arms, self.sections["joint_limits"])
        self.bodies = build_bodies(self.arms)
        self.home = np.array([0.0, 0.0, self.parameters.home_distance, 0.0, 0.0])

    @property
    def arms(self) -> tuple[Arm, Arm]:
        """What is fixed about the arms, from the parameters at each reading, so that these may be symbols."""
        return build_arms(self.parameters)

    def read_branch(self, branch: str | None) -> tuple[tuple[float, float], ...]:
        """Elbow signs of both arms; `a/b` names one branch per arm."""
        return read_elbows(branch, self.branches, 2)

    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> TwinState:
        """Pen and arms at a pose."""
        return solve_state(self.arms, pose, branch, require)

    def joint_values(self, state: TwinState) -> Sequence[Number]:
        """Six motor angles, then the passive joints arm by arm."""
        return joint_values(self.arms, state)

    def rate_rows(self, state: TwinState) -> Sequence[Sequence[Number]]:
        """d(motor angles)/d(x, y, z, rx, rz)."""
        return rate_rows(self.arms, state)

    def body_frames(self, state: TwinState) -> Sequence[tuple[Rot, Vec]]:
        """Base, seven bodies an arm, pen at zero roll."""
        return twin_frames(self.arms, state)

    def compute_force_jacobian(self, poses: Array) -> Array:
        """The paper's J, shape (n, 6, 5): (v, omega_i, omega_k) in pen axes to motor rates, [mm/s, rad/s]."""
        poses = np.asarray(poses, dtype=float)
        rows = force_rows(self.arms, self._evaluate(poses, None, Requirements()))
        return np.stack([np.stack(np.broadcast_arrays(*row), axis=-1) for row in rows], axis=-2)

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses for six motor angles (n, 6) [rad], in closed form; `near` is not needed.

        Six angles overdetermine five coordinates: where the tips do not lie a pen's length apart (within the closure
        tolerance of the design) the angles belong to no pose. The residual is that misfit [mm].
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        n, tolerance = len(active), self.sections["forward"].closure_tolerance
        finite = np.all(np.isfinite(active), axis=-1)
        need = Requirements()
        with np.errstate(all="ignore"):
            columns, residual = locate_pen(
                self.arms, tuple(np.where(finite[:, None], active, 0.0).T), self.parameters.pen_half_length, need
            )
        poses = np.stack(columns, axis=-1)
        closed = finite & np.all(need.stacked((n,)) >= 0.0, axis=-1) & (residual <= tolerance)
        poses = np.where(closed[:, None] & np.isfinite(poses), poses, self.home)
        inverse = self.solve_inverse(poses)
        miss = np.mod(inverse.joints[:, :6] - active + math.pi, 2.0 * math.pi) - math.pi
        # A misfit of the tips moves a motor by at most a few times its share of the shortest lever.
        bound = max(1e-9, 10.0 * tolerance / self.parameters.shoulder_half_spacing)
        solved = (
            closed & inverse.is_reachable & (np.max(np.abs(np.where(finite[:, None], miss, np.inf)), axis=-1) < bound)
        )
        return ForwardSolution(
            poses=np.where(solved[:, None], poses, self.home),
            is_solved=solved,
            n_candidates=solved.astype(int),
            residual=np.where(solved, residual, np.inf),
        )

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        J = self.compute_force_jacobian(self.home[None])[0] @ np.diag(
            [1.0] * 3 + [1.0 / self.parameters.pen_half_length] * 2
        )
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "pen_length": (2.0 * self.parameters.pen_half_length, "mm", "tip to tip"),
            "home_waist": (float(home[0]), "deg", "waist of arm A at home"),
            "home_shoulder_left": (float(home[1]), "deg", "left upper arm of arm A at home"),
            "home_condition": (float(np.linalg.cond(J)), "", "condition number of J at home, lengths by l_6"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "shoulder_half_spacing": (p.shoulder_half_spacing, "mm"),
            "upper_arm_length": (p.upper_arm_length, "mm"),
            "forearm_length": (p.forearm_length, "mm"),
            "waist_half_spacing": (p.waist_half_spacing, "mm"),
            "pen_half_length": (p.pen_half_length, "mm"),
        }
