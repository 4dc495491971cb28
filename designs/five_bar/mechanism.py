"""The plain five-bar as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..chains.dyad_pair_mechanism import TASK, DyadPairMechanism
from ..chains.sections import check_order
from ..language.bodies import Body
from ..language.mechanism import Array
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require
from .joints import build_joints
from .kinematics import FiveBarState, body_frames, joint_values, locate_tip, rate_rows, solve_state
from .parameters import FiveBarLimits, FiveBarParameters

__all__ = ["SECTIONS", "TASK", "FiveBar"]

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": FiveBarParameters, "joint_limits": FiveBarLimits}


class FiveBar(DyadPairMechanism):
    """Two arms driven at the base, with one tip, 2 DOF."""

    name = "five_bar"
    title = "Plain planar five-bar, 2 DOF"
    source = "Chung, Choo, Lee: SenSation: A New 2 DOF Parallel Mechanism for a Haptic Device (its comparison device)"
    assembly_mode = "tip beyond the elbows, sin(theta_2 - theta_4) > 0"
    section_classes = SECTIONS

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.parameters: FiveBarParameters = self.sections["parameters"]
        self.limits: FiveBarLimits = self.sections["joint_limits"]
        check_order(self.limits, ("theta_1", "theta_3", "elbow", "tip"))
        self.joints = build_joints(self.parameters, self.limits)
        names = [(side, kind) for side in ("right", "left") for kind in ("arm", "tip_link")]
        self.bodies = (
            Body(name="base", kind="base", group="", parts=()),
            *(Body(name=f"{side}_{kind}", kind=kind, group=side, parts=()) for side, kind in names),
        )
        p = self.parameters
        self.home = self.right_angle_home(p.pivot_distance, p.arm_length, p.tip_link_length)

    def solve_state(self, pose: Sequence[Number], branch: tuple[float, float], require: Require) -> FiveBarState:
        """Both arms at a pose."""
        return solve_state(self.parameters, pose, branch, require)

    def joint_values(self, state: FiveBarState) -> Sequence[Number]:
        """theta_1, theta_3, then elbows and tip."""
        return joint_values(state)

    def rate_rows(self, state: FiveBarState) -> Sequence[Sequence[Number]]:
        """d(theta_1, theta_3)/d(x, y) [rad/mm]."""
        return rate_rows(self.parameters, state)

    def body_frames(self, state: FiveBarState) -> Sequence[tuple[Rot, Vec]]:
        """Base, two links an arm."""
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
            "home_theta_1": (float(joints[0]), "deg", "right arm at home"),
            "home_theta_3": (float(joints[1]), "deg", "left arm at home"),
            "home_condition": (self.home_condition(), "", "condition number of the Jacobian at home"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "pivot_distance": (p.pivot_distance, "mm"),
            "arm_length": (p.arm_length, "mm"),
            "tip_link_length": (p.tip_link_length, "mm"),
        }
