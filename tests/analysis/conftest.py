from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from linkwright.designs.design import Design, Workspace
from linkwright.designs.language.bodies import Body, Part
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.mechanism import Array, Coordinate, ForwardSolution, InverseSolution, Mechanism
from linkwright.designs.language.poses import turn_about
from linkwright.generator.assembly import Assembly, build_assembly


class OneJoint(Mechanism):
    """A parent at the origin and a child on one joint along z at the origin; the task is the joint's value."""

    name, title, source = "one_joint", "one joint", "test"
    branches, assembly_mode = ("only",), "only"

    def __init__(
        self, joints: tuple[Joint, ...], parent: tuple[Part, ...], child: tuple[Part, ...], home: float
    ) -> None:
        self.joints = joints
        self.bodies = (
            Body(name="base", kind="base", group="", parts=parent),
            Body(name="arm", kind="arm", group="", parts=child),
        )
        self.home = np.array([home])
        self.sections = {}
        self.task = (Coordinate(name="q", unit="deg"),)

    def solve_inverse(self, poses: Array, branch: str | None = None) -> InverseSolution:
        n = len(poses)
        return InverseSolution(
            joints=np.tile(np.asarray(poses), (1, len(self.joints))),
            margins=np.ones((n, 1)),
            requirements=("none",),
            is_reachable=np.ones(n, bool),
        )

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        n = len(active)
        return ForwardSolution(
            poses=np.asarray(active), is_solved=np.ones(n, bool), n_candidates=np.ones(n, int), residual=np.zeros(n)
        )

    def compute_jacobian(self, poses: Array) -> Array:
        return np.ones((len(poses), 1, 1))

    def place_bodies(self, poses: Array) -> Array:
        poses = np.asarray(poses, dtype=float)
        Ts = np.tile(np.eye(4), (len(poses), 2, 1, 1))
        kind = self.joints[0].kind if self.joints else JointKind.REVOLUTE
        if kind is JointKind.PRISMATIC:
            Ts[:, 1, 2, 3] = poses[:, 0]
        elif kind is JointKind.REVOLUTE:
            Ts[:, 1] = turn_about(np.zeros(3), np.array([0.0, 0.0, 1.0]), poses[:, 0])
        else:  # a ball joint leans about y by its value
            Ts[:, 1] = turn_about(np.zeros(3), np.array([0.0, 1.0, 0.0]), poses[:, 0])
        return Ts

    def derived_numbers(self):
        return {}

    def controller_parameters(self):
        return {}


def one_joint(kind: JointKind, lower: float, upper: float, name: str = "hinge") -> Joint:
    z, origin = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    return Joint(
        name=name,
        kind=kind,
        parent="base",
        child="arm",
        p_parent=origin,
        axis_parent=z,
        p_child=origin,
        axis_child=z,
        lower=lower,
        upper=upper,
        is_active=True,
    )


@pytest.fixture(scope="session")
def assemble() -> Callable[..., Assembly]:
    """(kind, parent parts, child parts, lower, upper, home value, deviation) -> Assembly of one joint."""

    def build(
        kind: JointKind,
        parent: tuple[Part, ...],
        child: tuple[Part, ...],
        lower: float,
        upper: float,
        home: float = 0.0,
        deviation: float = 0.02,
        n_joints: int = 1,
    ) -> Assembly:
        joints = tuple(one_joint(kind, lower, upper, f"hinge_{i}") for i in range(n_joints))
        mechanism = OneJoint(joints, parent, child, home)
        design = Design(name="probe", mechanism=mechanism, workspace=Workspace(lower=(home,), upper=(home,)))
        return build_assembly(design, deviation=deviation)

    return build
