"""What every mechanism of two planar arms shares: its task, its postures and its closed-form forward kinematics."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from ..language.errors import ParameterError, UnknownNameError
from ..language.formulas import FormulaMechanism
from ..language.forward import Candidates
from ..language.joints import Joint, JointKind
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.vectors import Rot, Vec, rot_z
from ..language.vocabulary import Number, Requirements
from .dyad_pair import POSTURES
from .sections import resolve_sections

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xy")

#: Largest difference [rad] between motor angles asked for and those of the pose found.
_SAME_ANGLES = 1e-6


class DyadPairMechanism(FormulaMechanism):
    """Two arms in one plane; motors about z. A pose is the tip (x, y) [mm], its velocity the rates of these."""

    task = TASK
    branches = tuple(POSTURES)
    section_classes: ClassVar[Mapping[str, type]]

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(self.section_classes, sections)

    def read_branch(self, branch: str | None) -> tuple[float, float]:
        """Sides (right arm, left arm) of the elbows."""
        name = branch or self.branches[0]
        if name not in POSTURES:
            raise UnknownNameError("branch", name, self.branches)
        return POSTURES[name]

    @abstractmethod
    def locate_tip(self, active: Array, require: Requirements) -> tuple[Array, Array]:
        """Tip (x, y) [mm] of the working assembly mode for two columns of motor angles [rad]."""

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Tips for motor angles (n, 2) [rad], in closed form; the assembly mode leaves one, so `near` decides nothing.

        A tip counts if all joints keep their limits and its inverse returns the motor angles: of two arms that share
        their motor angles, the one with its elbow on the other side is refused.
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        need = Requirements()
        finite = np.all(np.isfinite(active), axis=-1)
        poses = np.stack(self.locate_tip(np.where(finite[:, None], active, 0.0), need), axis=-1)
        closed = finite & np.all(need.stacked((len(active),)) >= 0.0, axis=-1)
        inverse = self.solve_inverse(poses)
        miss = np.max(np.abs(inverse.joints[:, :2] - np.where(finite[:, None], active, 0.0)), axis=-1)
        candidates = Candidates(len(active), self.home, near)
        candidates.offer(poses, closed & inverse.is_reachable & (miss < _SAME_ANGLES), miss * self.home[1])
        return candidates.solution()

    def right_angle_home(self, pivot_distance: float, pivot_link: float, tip_link: float) -> Array:
        """The tip on the middle line with both elbows at a right angle: halfway between folded and stretched.

        Raises:
            ParameterError: the pivots are too far apart for that.
        """
        squared = pivot_link**2 + tip_link**2 - 0.25 * pivot_distance**2
        if squared <= 0.0:
            allowed = f"must be below {2.0 * np.hypot(pivot_link, tip_link):g} mm for these links"
            raise ParameterError("parameters.pivot_distance_mm", pivot_distance, allowed)
        return np.array([0.0, np.sqrt(squared)])

    def home_condition(self) -> float:
        """Condition number of the Jacobian at home; both columns have one unit, so none is scaled."""
        return float(np.linalg.cond(self.compute_jacobian(self.home[None])[0]))


def link_frame(angle: Number, x: Number, y: Number) -> tuple[Rot, Vec]:
    """Axes and origin of a link: x along it, z along the motors."""
    return rot_z(angle), Vec(x, y, 0.0)


def hinge(
    name: str,
    parent: str,
    child: str,
    at: tuple[float, float],
    to: tuple[float, float],
    span: tuple[float, float],
    *,
    active: bool = False,
) -> Joint:
    """A pin along z between two bodies, at points (x, y) [mm] of their frames, with limits [rad]."""
    return Joint(
        name=name,
        kind=JointKind.REVOLUTE,
        parent=parent,
        child=child,
        p_parent=(*at, 0.0),
        axis_parent=(0.0, 0.0, 1.0),
        p_child=(*to, 0.0),
        axis_child=(0.0, 0.0, 1.0),
        lower=span[0],
        upper=span[1],
        is_active=active,
    )
