"""The contract that every mechanism fulfils: kinematics both ways, Jacobian, joints, bodies and their poses.

All storeys above know this contract only. Batches have the poses along the leading axis; a mechanism is immutable.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .bodies import Body
from .joints import Joint

Array = np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class Coordinate:
    """A coordinate of the task: its column in a file is `<name>_<unit>`."""

    name: str
    unit: str

    @property
    def key(self) -> str:
        """Column name in a file."""
        return f"{self.name}_{self.unit}"


@dataclass(frozen=True, slots=True, kw_only=True)
class InverseSolution:
    """Joint values of a batch of n poses.

    Attributes:
        joints: values of all joints in the mechanism's order, active first, shape (n, n_joints) [rad or mm]. Finite
            always, but meaningless where `is_reachable` is False.
        margins: distance to each requirement, shape (n, n_requirements); legal where >= 0.
        requirements: their names ("leg_1 stretched").
        is_reachable: all margins are >= 0, shape (n,).
    """

    joints: Array
    margins: Array
    requirements: tuple[str, ...]
    is_reachable: Array

    def reason(self, i: int) -> str:
        """Why pose i cannot be reached: its first violated requirement; empty if it can."""
        bad = np.flatnonzero(~(self.margins[i] >= 0.0))
        return self.requirements[int(bad[0])] if len(bad) else ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForwardSolution:
    """Poses of a batch of n sets of active joint values.

    Attributes:
        poses: task coordinates, shape (n, n_task) [mm, rad].
        is_solved: a pose of the working assembly mode was found, and only one, shape (n,).
        n_candidates: how many distinct legal poses were found; above 1 the answer is refused unless a pose near the
            expected one was given.
        residual: closure error of the answer [mm].
    """

    poses: Array
    is_solved: Array
    n_candidates: Array
    residual: Array

    def reason(self, i: int) -> str:
        """Why set i has no answer; empty if it has one."""
        if self.is_solved[i]:
            return ""
        if self.n_candidates[i] > 1:
            return f"{self.n_candidates[i]} legal poses: give one nearby"
        return "no pose of the working assembly mode"


class Mechanism(ABC):
    """A mechanism with resolved numbers.

    Attributes:
        name: catalogue name.
        title: one line for people.
        source: the paper.
        sections: the frozen sections of numbers, by their table in the design file.
        task: the coordinates of a pose; for a platform in space x, y, z, rx, ry, rz with Q = Rz Ry Rx.
        joints: active ones first.
        bodies: in the order of `place_bodies`; the first is the base.
        home: a pose well inside the workspace, shape (n_task,).
        branches: names of the inverse's working modes, the default first.
        assembly_mode: name of the forward kinematics' working assembly mode.
        n_idle_freedoms: freedoms of bodies that neither the task nor a motor knows (a pen that turns in its ring).
    """

    name: str
    title: str
    source: str
    sections: Mapping[str, Any]
    task: tuple[Coordinate, ...]
    joints: tuple[Joint, ...]
    bodies: tuple[Body, ...]
    home: Array
    branches: tuple[str, ...]
    assembly_mode: str
    n_idle_freedoms: int = 0

    @property
    def has_solids(self) -> bool:
        """Some body has parts, so there is something to check and to build."""
        return any(body.parts for body in self.bodies)

    @property
    def n_active(self) -> int:
        """Number of driven joints."""
        return sum(joint.is_active for joint in self.joints)

    @abstractmethod
    def solve_inverse(self, poses: Array, branch: str | None = None) -> InverseSolution:
        """Joint values for poses (n, n_task) [mm, rad] in a named branch."""

    @abstractmethod
    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses for active joint values (n, n_active) [rad or mm], near given poses (n, n_task) if there are any."""

    @abstractmethod
    def compute_jacobian(self, poses: Array) -> Array:
        """Twist to joint rates, shape (n, n_active, n_task_velocity), rows d(active)/d(v, omega), v in mm/s.

        For a platform in space the velocity is the twist [v of the platform's origin; omega] in base axes.
        """

    @abstractmethod
    def place_bodies(self, poses: Array) -> Array:
        """Ts_base_body, shape (n, n_bodies, 4, 4) [mm]."""

    @abstractmethod
    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters: key -> (value in the unit inside, file unit, meaning)."""

    @abstractmethod
    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The kinematic numbers that a controller needs: key without unit -> (value inside, file unit)."""

    def body(self, name: str) -> Body:
        """The body of this name."""
        return next(b for b in self.bodies if b.name == name)
