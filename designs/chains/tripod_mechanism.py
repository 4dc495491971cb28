"""What every mechanism of three planar chains under one plate shares: task, branches, forward kinematics by closure."""

from __future__ import annotations

import itertools
import math
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..language.bodies import Body
from ..language.errors import UnknownNameError
from ..language.formulas import FormulaMechanism
from ..language.forward import Candidates
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.poses import task_from_pose
from ..language.vocabulary import Requirements
from .sections import resolve_sections
from .tripod import DELTAS, close_circles, leg_axes, plate_pose

TASK = tuple(Coordinate(name=n, unit="mm") for n in "xyz") + tuple(
    Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")
)

#: Largest difference [rad] between motor angles asked for and those of the pose found.
_SAME_ANGLES = 1e-6

#: Largest closure error of an answer, as a share of the platform's radius.
_CLOSED = 1e-9


class Circles(NamedTuple):
    """What the motors fix: three points on circles about three pins, whose distances are known.

    Attributes:
        y, rho: the points in their planes [mm], shape (n, 3).
        radius: of the pins' triangle [mm].
        wanted: distances of the pairs [mm], shape (n, 3).
        aside: points from their planes [mm].
        is_closed: the planar chains close, shape (n,).
    """

    y: Array
    rho: Array
    radius: float
    wanted: Array
    aside: float
    is_closed: Array


class TripodMechanism(FormulaMechanism):
    """Three legs at 120 degrees, two motors each; subclasses have `parameters` with base_radius and platform_radius.

    Attributes:
        section_classes: section of the design file -> its dataclass.
        leg_branches: name -> signs of one leg, the working one first.
        start_centre: middle of the closure's starting angles [rad].
        assembly_sign: sign of the closure's determinant in the working assembly mode.
    """

    task = TASK
    assembly_mode = "platform up, det A > 0"
    section_classes: ClassVar[Mapping[str, type]]
    leg_branches: ClassVar[Mapping[str, tuple[float, ...]]]
    start_centre: ClassVar[float] = 0.0
    assembly_sign: ClassVar[float] = 1.0
    parameters: Any

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(self.section_classes, sections)
        self.branches = tuple(self.leg_branches)

    def read_branch(self, branch: str | None) -> tuple[tuple[float, ...], ...]:
        """Signs of the three legs; `a/b/c` names one branch per leg."""
        names = (branch or self.branches[0]).split("/")
        names = names * 3 if len(names) == 1 else names
        for name in names:
            if name not in self.leg_branches:
                raise UnknownNameError("branch", name, self.branches)
        if len(names) != 3:
            raise UnknownNameError("branch", branch or "", (*self.branches, "three of these joined by /"))
        return tuple(self.leg_branches[name] for name in names)

    @abstractmethod
    def circles_from_motors(self, active: Array) -> Circles:
        """The circles of the closure for finite motor angles (n, 6) [rad]."""

    @abstractmethod
    def closure_angles(self, state: Any) -> Array:
        """The closure's three angles at a state, shape (n, 3) [rad]."""

    def pose_from_closure(self, angles: Array, circles: Circles, active: Array) -> Array:
        """Poses (n, 6) of the plate whose balls the circles carry at these angles (n, 3) [rad]."""
        F = []
        for i, delta in enumerate(DELTAS):
            axes = leg_axes(angles[:, i], delta)
            c, s = math.cos(delta), math.sin(delta)
            foot = np.array([circles.radius * c, circles.radius * s, 0.0])
            ball = foot + circles.y[:, i, None] * np.array([-s, c, 0.0]) + circles.rho[:, i, None] * axes.z.array()
            F.append(ball + circles.aside * axes.x.array())
        return task_from_plate(*plate_pose(np.stack(F, axis=1)))

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses of the working assembly mode for motor angles (n, 6) [rad].

        Newton on the closure's three angles from 28 starts (and from `near`, if given). A pose counts if it closes, if
        its closure determinant has the working sign and if all joints keep their limits; when more than one does, the
        answer is refused unless `near` decides.

        Source: Zhang et al., eq. (12). Printed: Newton, silent on starts. A cold start from zero lean converges to
        another assembly for 1-5 % of poses. Shown by: tests/papers/test_zhang_hit.py.
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        n, finite = len(active), np.all(np.isfinite(active), axis=-1)
        goal = np.where(finite[:, None], active, 0.0)
        circles = self.circles_from_motors(goal)
        closed = finite & circles.is_closed
        candidates = Candidates(n, self.home, near)
        steps = [np.zeros(3)] + [np.array(s) for s in itertools.product((-0.6, 0.0, 0.6), repeat=3)]
        guesses = [np.broadcast_to(self.start_centre + s, (n, 3)) for s in steps]
        if candidates.near is not None:
            state = self.solve_state(tuple(candidates.near.T), self.read_branch(None), Requirements())
            guesses.insert(0, self.closure_angles(state))
        for guess in guesses:
            angles, error, det = close_circles(
                circles.y, circles.rho, circles.radius, circles.wanted, guess, circles.aside
            )
            poses = self.pose_from_closure(angles, circles, goal)
            legal = closed & (error < _CLOSED * self.parameters.platform_radius) & (self.assembly_sign * det > 0.0)
            candidates.offer(poses, legal & self._keeps_limits(poses, goal), error)
        return candidates.solution()

    def _keeps_limits(self, poses: Array, active: Array) -> Array:
        """The inverse of the pose is legal and returns the motor angles that were asked for."""
        inverse = self.solve_inverse(poses)
        back = np.max(np.abs(inverse.joints[:, :6] - active), axis=-1)
        return inverse.is_reachable & (back < _SAME_ANGLES)

    def scaled_condition(self) -> float:
        """Condition number of the Jacobian at home, lengths by the platform's radius."""
        J = self.compute_jacobian(self.home[None])[0]
        return float(np.linalg.cond(J @ np.diag([1.0] * 3 + [1.0 / self.parameters.platform_radius] * 3)))


def task_from_plate(R: Array, origin: Array) -> Array:
    """Poses (n, 6) from rotations (n, 3, 3) and origins (n, 3) [mm]."""
    T = np.zeros((len(R), 4, 4))
    T[:, :3, :3], T[:, :3, 3], T[:, 3, 3] = R, origin, 1.0
    return task_from_pose(T)


def leg_bodies(kinds: Sequence[str]) -> tuple[Body, ...]:
    """Base, a body of every kind for each of the three legs, platform; without solids."""
    return (
        Body(name="base", kind="base", group="", parts=()),
        *(
            Body(name=f"leg_{i}_{kind}", kind=kind, group=f"leg_{i}", parts=())
            for i in range(1, len(DELTAS) + 1)
            for kind in kinds
        ),
        Body(name="platform", kind="platform", group="", parts=()),
    )
