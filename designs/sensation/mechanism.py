"""SenSation as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..chains.dyad_pair_mechanism import TASK, DyadPairMechanism
from ..chains.sections import check_order
from ..language.bodies import Body
from ..language.errors import ParameterError
from ..language.mechanism import Array
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require
from .joints import build_joints
from .kinematics import SensationState, body_frames, joint_values, locate_tip, rate_rows, require_held, solve_state
from .parameters import SensationLimits, SensationParameters

__all__ = ["SECTIONS", "TASK", "Sensation"]

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": SensationParameters, "joint_limits": SensationLimits}

#: A shorter crank [mm] leaves no room for two pins.
_SHORTEST_CRANK = 5.0


class Sensation(DyadPairMechanism):
    """Two parallelogram-driven arms with one tip, 2 DOF."""

    name = "sensation"
    title = "SenSation planar haptic device: two arms driven through parallelograms, 2 DOF"
    source = "Chung, Choo, Lee: SenSation: A New 2 DOF Parallel Mechanism for a Haptic Device"
    assembly_mode = "left arm counter-clockwise of the right one, sin(theta_3 - theta_1) > 0"
    section_classes = SECTIONS

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.parameters: SensationParameters = self.sections["parameters"]
        self.limits: SensationLimits = self.sections["joint_limits"]
        check_order(self.limits, ("theta_2", "theta_4", "elbow"))
        if abs(self.parameters.crank_length) < _SHORTEST_CRANK:
            raise ParameterError(
                "parameters.crank_length_mm",
                self.parameters.crank_length,
                f"must be at least {_SHORTEST_CRANK:g} mm to either side",
            )
        self.joints = build_joints(self.parameters, self.limits)
        names = [(side, kind) for side in ("right", "left") for kind in ("crank", "arm", "rod", "tip_link")]
        self.bodies = (
            Body(name="base", kind="base", group="", parts=()),
            *(Body(name=f"{side}_{kind}", kind=kind, group=side, parts=()) for side, kind in names),
        )
        p = self.parameters
        self.home = self.right_angle_home(p.pivot_distance, p.arm_length, p.tip_link_length)

    def solve_state(self, pose: Sequence[Number], branch: tuple[float, float], require: Require) -> SensationState:
        """Both arms at a pose; in the working posture the tip must be held as well."""
        state = solve_state(self.parameters, pose, branch, require)
        if branch == self.read_branch(None):
            require_held(self.limits, state, require)
        return state

    def joint_values(self, state: SensationState) -> Sequence[Number]:
        """theta_2, theta_4, then the passive pins."""
        return joint_values(state)

    def rate_rows(self, state: SensationState) -> Sequence[Sequence[Number]]:
        """d(theta_2, theta_4)/d(x, y) [rad/mm]."""
        return rate_rows(self.parameters, state)

    def body_frames(self, state: SensationState) -> Sequence[tuple[Rot, Vec]]:
        """Base, four links an arm."""
        return body_frames(self.parameters, state)

    def locate_tip(self, active: Array, require: Require) -> tuple[Array, Array]:
        """Tip of the working assembly mode."""
        return locate_tip(self.parameters, active[:, 0], active[:, 1], require)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        joints = self.solve_inverse(self.home[None]).joints[0]
        p = self.parameters
        return {
            "reach": (p.arm_length + p.tip_link_length, "mm", "motor axis to the tip with an arm stretched"),
            "home_theta_2": (float(joints[0]), "deg", "right tip link at home"),
            "home_theta_4": (float(joints[1]), "deg", "left tip link at home"),
            "home_condition": (self.home_condition(), "", "condition number of the Jacobian at home"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "pivot_distance": (p.pivot_distance, "mm"),
            "arm_length": (p.arm_length, "mm"),
            "tip_link_length": (p.tip_link_length, "mm"),
            "crank_length": (p.crank_length, "mm"),
        }
