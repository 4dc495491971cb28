"""The paired Stewart platform as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ..chains.hinged_triad import TriadLeg, solve_triad, triad_legs
from ..chains.sections import check_order, resolve_sections
from ..language.errors import UnknownNameError
from ..language.formulas import FormulaMechanism
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .joints import build_bodies, build_joints
from .kinematics import (
    StewartState,
    body_frames,
    joint_values,
    locate_pins,
    rate_rows,
    rest_axes,
    socket_direction,
    solve_state,
)
from .parameters import StewartLimits, StewartParameters

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(
    Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")
)

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": StewartParameters, "joint_limits": StewartLimits}


class Stewart(FormulaMechanism):
    """Six driven legs in three hinged pairs under one platform, 6 DOF."""

    name = "stewart"
    title = "Paired Stewart platform: six prismatic legs, three points on the platform"
    source = "Stocco, Salcudean, Sassani: Optimal Kinematic Design of a Haptic Pen (after Fichter)"
    task = TASK
    branches = ("extended",)
    assembly_mode = "platform before the base, closure determinant > 0"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(SECTIONS, sections)
        self.parameters: StewartParameters = self.sections["parameters"]
        check_order(self.sections["joint_limits"], ("scissor",))
        self.home = np.array([0.0, 0.0, self.parameters.home_distance, 0.0, 0.0, 0.0])
        self.sockets = self._sockets()
        self.joints = build_joints(self.parameters, self.sections["joint_limits"], self.legs, self.sockets)
        self.bodies = build_bodies()

    @property
    def legs(self) -> tuple[TriadLeg, ...]:
        """Hinges and platform points, from the parameters at each reading, so that these may be symbols."""
        p = self.parameters
        return triad_legs(
            p.base_single_radius,
            p.base_pair_radius,
            p.base_angle,
            p.platform_single_radius,
            p.platform_pair_radius,
            p.platform_angle,
        )

    def _sockets(self) -> tuple[tuple[Vec, Vec], ...]:
        """Axes of sockets in the left rods and of balls in the platform: one and the same direction at home."""
        state = solve_state(self.parameters, self.legs, [float(v) for v in self.home], Requirements())
        sockets = []
        for pair in state.pairs:
            opening = socket_direction(self.parameters, pair)
            own = pair.leg_axes(0).inverse_apply(opening)
            sockets.append((Vec(*(float(c) for c in own)), Vec(*(float(c) for c in opening))))
        return tuple(sockets)

    def read_branch(self, branch: str | None) -> str:
        """A leg has one way to reach its ball."""
        if branch not in (None, *self.branches):
            raise UnknownNameError("branch", branch or "", self.branches)
        return self.branches[0]

    def solve_state(self, pose: Sequence[Number], branch: Any, require: Require) -> StewartState:
        """All pairs at a pose."""
        return solve_state(self.parameters, self.legs, pose, require)

    def joint_values(self, state: StewartState) -> Sequence[Number]:
        """Six leg lengths, then the passive joints pair by pair."""
        return joint_values(state, self.sockets)

    def rate_rows(self, state: StewartState) -> Sequence[Sequence[Number]]:
        """d(leg lengths)/d(twist): columns v [mm/s], omega [rad/s]."""
        return rate_rows(self.parameters, self.legs, state)

    def body_frames(self, state: StewartState) -> Sequence[tuple[Rot, Vec]]:
        """Base, five bodies a pair, platform."""
        return body_frames(self.parameters, self.legs, state)

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses of the working assembly mode for leg lengths (n, 6) [mm].

        Each pair's lengths place its ball on a circle; Newton closes the three circles from many leans. When more than
        one legal pose is found the answer is refused unless `near` decides.
        """
        rest = self.parameters.home_distance
        return solve_triad(self, self.legs, active, partial(locate_pins, self.parameters), self._leans, rest, near)

    def _leans(self, poses: Array) -> Array:
        """Leans of the balls about the base lines [rad], shape (n, 3)."""
        state = self._evaluate(poses, None, Requirements())
        local = [
            rest_axes(leg).inverse_apply(pair.ball - Vec(*leg.foot))
            for leg, pair in zip(self.legs, state.pairs, strict=True)
        ]
        return np.stack([np.arctan2(-v.y, v.z) for v in local], axis=-1)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        p = self.parameters
        J = self.compute_jacobian(self.home[None])[0] @ np.diag([1.0] * 3 + [1.0 / p.platform_pair_radius] * 3)
        home = self.solve_inverse(self.home[None]).joints[0]
        return {
            "home_length_single": (float(home[0]), "mm", "legs of pair 1 at home"),
            "home_length_near": (float(home[2]), "mm", "legs of pairs 2, 3 next to pair 1 at home"),
            "home_length_far": (float(home[3]), "mm", "their other legs at home"),
            "home_condition": (float(np.linalg.cond(J)), "", "condition number of J at home, lengths by l_7"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "pair_half_spacing": (p.pair_half_spacing, "mm"),
            "base_single_radius": (p.base_single_radius, "mm"),
            "base_pair_radius": (p.base_pair_radius, "mm"),
            "platform_single_radius": (p.platform_single_radius, "mm"),
            "platform_pair_radius": (p.platform_pair_radius, "mm"),
            "base_angle": (p.base_angle, "deg"),
            "platform_angle": (p.platform_angle, "deg"),
            "ball_offset": (p.ball_offset, "mm"),
        }
