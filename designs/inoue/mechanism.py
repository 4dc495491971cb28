"""The Inoue platform as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ..chains.hinged_arm import ARM_RANGES, Arm
from ..chains.hinged_five_bar import ELBOWS, read_elbows
from ..chains.hinged_triad import TriadLeg, solve_triad
from ..chains.sections import check_order, resolve_sections
from ..language.formulas import FormulaMechanism
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .joints import build_arms, build_bodies, build_joints, build_legs
from .kinematics import InoueState, body_frames, joint_values, locate_tips, rate_rows, solve_state
from .parameters import InoueLimits, InoueParameters, InoueStems

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(
    Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")
)

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": InoueParameters, "joint_limits": InoueLimits, "stems": InoueStems}


class Inoue(FormulaMechanism):
    """Three five-bars on passive hinges under one platform, 6 DOF."""

    name = "inoue"
    title = "Inoue platform: three hinged five-bars, six shoulder motors"
    source = "Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen (after Inoue)"
    task = TASK
    branches = tuple(ELBOWS)
    assembly_mode = "tips beyond their elbows, closure determinant > 0"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(SECTIONS, sections)
        check_order(self.sections["joint_limits"], ARM_RANGES)
        self.parameters: InoueParameters = self.sections["parameters"]
        self.home = np.array([0.0, 0.0, self.parameters.home_distance, 0.0, 0.0, 0.0])
        self.zeros = self._zeros()
        self.joints = build_joints(self.arms, self.sections["joint_limits"])
        self.bodies = build_bodies(self.arms)

    def _zeros(self) -> tuple[Vec, ...]:
        """Where the hubs point at home, in the platform: turns are zero there."""
        still = [Vec(1.0, 0.0, 0.0)] * 3
        with np.errstate(all="ignore"):
            state = solve_state(self.arms, still, [float(v) for v in self.home], self.read_branch(None), Requirements())
        return tuple(Vec(*(float(c) for c in arm.wrist.hub_axes.x)) for arm in state.arms)

    @property
    def legs(self) -> tuple[TriadLeg, ...]:
        """Hinges and platform points, from the parameters at each reading, so that these may be symbols."""
        return build_legs(self.parameters)

    @property
    def arms(self) -> tuple[Arm, ...]:
        """What is fixed about the arms, from the parameters at each reading, so that these may be symbols."""
        return build_arms(self.parameters, self.sections["stems"], self.legs)

    def read_branch(self, branch: str | None) -> tuple[tuple[float, float], ...]:
        """Elbow signs of the three arms; `a/b/c` names one branch per arm."""
        return read_elbows(branch, self.branches, 3)

    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> InoueState:
        """All arms at a pose."""
        return solve_state(self.arms, self.zeros, pose, branch, require)

    def joint_values(self, state: InoueState) -> Sequence[Number]:
        """Six motor angles, then the passive joints arm by arm."""
        return joint_values(self.arms, state)

    def rate_rows(self, state: InoueState) -> Sequence[Sequence[Number]]:
        """d(motor angles)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.arms, state)

    def body_frames(self, state: InoueState) -> Sequence[tuple[Rot, Vec]]:
        """Base, seven bodies an arm, platform."""
        return body_frames(self.arms, state)

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses of the working assembly mode for motor angles (n, 6) [rad].

        Each arm's shoulders place its tip on a circle; Newton closes the three circles from many leans. When more than
        one legal pose is found the answer is refused unless `near` decides.
        """
        rest = self.parameters.home_distance
        return solve_triad(self, self.legs, active, partial(locate_tips, self.arms), self._leans, rest, near)

    def _leans(self, poses: Array) -> Array:
        """Waists of the arms at poses [rad], shape (n, 3)."""
        state = self._evaluate(poses, None, Requirements())
        return np.stack([arm.five_bar.waist for arm in state.arms], axis=-1)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        p = self.parameters
        J = self.compute_jacobian(self.home[None])[0] @ np.diag([1.0] * 3 + [1.0 / p.platform_pair_radius] * 3)
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "home_shoulder_single": (float(home[0]), "deg", "left upper arm of leg 1 at home"),
            "home_shoulder_near": (float(home[2]), "deg", "left upper arm of leg 2 at home"),
            "home_condition": (float(np.linalg.cond(J)), "", "condition number of J at home, lengths by l_7"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "shoulder_half_spacing": (p.shoulder_half_spacing, "mm"),
            "upper_arm_length": (p.upper_arm_length, "mm"),
            "forearm_length": (p.forearm_length, "mm"),
            "base_single_radius": (p.base_single_radius, "mm"),
            "base_pair_radius": (p.base_pair_radius, "mm"),
            "platform_single_radius": (p.platform_single_radius, "mm"),
            "platform_pair_radius": (p.platform_pair_radius, "mm"),
            "base_angle": (p.base_angle, "deg"),
            "platform_angle": (p.platform_angle, "deg"),
        }
