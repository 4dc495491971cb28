"""The 6-DOF Twin-Pantograph as a mechanism: solves both ways in closed form, differentiates, places its bodies."""

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
from ..language.poses import pose_from_parts, task_from_pose
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .joints import build_arms, build_bodies, build_joints
from .kinematics import joint_values, locate_pen, rate_rows, solve_state
from .parameters import TwinPantographParameters, TwinPantographRoll

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(
    Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")
)

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {
    "parameters": TwinPantographParameters,
    "joint_limits": ArmLimits,
    "roll_limits": TwinPantographRoll,
}

#: Largest difference of motor angles at which the forward kinematics counts as closed [rad].
_CLOSED = 1e-9


class TwinPantograph(FormulaMechanism):
    """A pen between two waist-hinged five-bars: one waist, four shoulders and the pen's roll are driven, 6 DOF."""

    name = "twin_pantograph"
    title = "Twin-Pantograph, 6 DOF: two waist-hinged five-bars, series roll actuator"
    source = "Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen"
    task = TASK
    branches = tuple(ELBOWS)
    assembly_mode = "both tips beyond their elbows, pen above the plane of arm B"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(SECTIONS, sections)
        check_order(self.sections["joint_limits"], ARM_RANGES)
        self.parameters: TwinPantographParameters = self.sections["parameters"]
        self.joints = build_joints(self.arms, self.sections["joint_limits"])
        self.bodies = build_bodies(self.arms)
        self.home = np.array([0.0, 0.0, self.parameters.home_distance, 0.0, 0.0, 0.0])

    @property
    def arms(self) -> tuple[Arm, Arm]:
        """What is fixed about the arms, from the parameters at each reading, so that these may be symbols."""
        return build_arms(self.parameters, self.sections["roll_limits"])

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
        """d(motor angles)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.arms, state)

    def body_frames(self, state: TwinState) -> Sequence[tuple[Rot, Vec]]:
        """Base, seven bodies an arm, pen."""
        return twin_frames(self.arms, state)

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses for six motor angles (n, 6) [rad], in closed form; `near` is not needed.

        The assembly mode has one pose at most; the residual is the largest misfit of the angles, times the forearm.
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        n, need = len(active), Requirements()
        finite = np.all(np.isfinite(active), axis=-1)
        given = np.where(finite[:, None], active, 0.0)
        with np.errstate(all="ignore"):
            origin, Q = locate_pen(self.arms, tuple(given.T), self.parameters.pen_half_length, need)
            poses = task_from_pose(pose_from_parts(Q, origin))
        closed = finite & np.all(need.stacked((n,)) >= 0.0, axis=-1) & np.all(np.isfinite(poses), axis=-1)
        poses = np.where(closed[:, None], poses, self.home)
        inverse = self.solve_inverse(poses)
        miss = np.max(np.abs(np.mod(inverse.joints[:, :6] - given + math.pi, 2.0 * math.pi) - math.pi), axis=-1)
        solved = closed & inverse.is_reachable & (miss < _CLOSED)
        return ForwardSolution(
            poses=np.where(solved[:, None], poses, self.home),
            is_solved=solved,
            n_candidates=solved.astype(int),
            residual=np.where(solved, miss * self.parameters.forearm_length, np.inf),
        )

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        J = self.compute_jacobian(self.home[None])[0] @ np.diag([1.0] * 3 + [1.0 / self.parameters.pen_half_length] * 3)
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "pen_length": (2.0 * self.parameters.pen_half_length, "mm", "tip to tip"),
            "home_waist": (float(home[0]), "deg", "waist of arm A at home"),
            "home_shoulder_left": (float(home[1]), "deg", "left upper arm of arm A at home"),
            "home_roll": (float(home[5]), "deg", "roll motor at home, from the host forearm"),
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
