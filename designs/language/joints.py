"""A joint: which two bodies it holds, where, about what, and how far it may go."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

Point = tuple[float, float, float]


class JointKind(StrEnum):
    """How two bodies may move against each other."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    UNIVERSAL = "universal"
    SPHERICAL = "spherical"


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint between a parent and a child body.

    The value of a revolute joint grows when the child turns right-handed about `axis` against the parent; that of a
    prismatic one when the child moves along it. The value of a spherical (universal) joint is the angle between the
    child's axis and the parent's; its `lower` is 0 and its `upper` the half angle of the cone.

    Attributes:
        name: snake_case, unique in the mechanism.
        parent, child: names of bodies.
        p_parent: a point of the axis, or the ball centre, in the parent's frame [mm].
        axis_parent: unit axis in the parent's frame (spherical: axis of the socket's opening).
        p_child, axis_child: the same in the child's frame (spherical: axis of the bar).
        lower, upper: declared limits [rad or mm].
        is_active: driven by a motor.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    p_parent: Point
    axis_parent: Point
    p_child: Point
    axis_child: Point
    lower: float
    upper: float
    is_active: bool = False

    @property
    def unit(self) -> str:
        """Suffix of the joint's column in a file."""
        return "mm" if self.kind is JointKind.PRISMATIC else "deg"
