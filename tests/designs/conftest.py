"""A mechanism that no catalogue holds: two bars in a plane. What works on it knows no mechanism by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from linkwright.designs.catalogue import Entry
from linkwright.designs.design import Workspace
from linkwright.designs.language.bodies import Body
from linkwright.designs.language.errors import ParameterError, UnknownNameError
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.mechanism import Coordinate, ForwardSolution, InverseSolution, Mechanism
from linkwright.designs.language.parameters import angle, choice, count, flag, length, number
from linkwright.designs.language.units import DEG

TASK = (Coordinate(name="x", unit="mm"), Coordinate(name="y", unit="mm"))


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmParameters:
    """The two bars of the arm."""

    upper: float = length(100.0, "shoulder to elbow", symbol="l_1")
    fore: float = length(
        80.0,
        "elbow to hand; a text that is long enough to need a second line of comment beside its "
        "value, because it explains at length why eighty is right",
        symbol="l_2",
        most=500.0,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmBars:
    """How the bars are made."""

    width: float = length(12.0, "of a bar", least=0.0)
    tilt: float = angle(0.3, "of a bar; its default is no round number of degrees", least=-90.0 * DEG, most=90.0 * DEG)
    weight: float = number(0.25, "kg", "of the hand", least=0.0)
    n_screws: int = count(4, "screws per joint", least=1, most=12)
    is_hollow: bool = flag(False, "tube instead of bar")


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmSupplies:
    """Bought parts."""

    bearing: str = choice("688ZZ", "in both joints", ("623", "688ZZ", "MR104ZZ", "MR105ZZ"))
    spare: str = choice("623", "in the box", ("623", "688ZZ", "MR104ZZ", "MR105ZZ"))


SECTIONS: dict[str, type] = {"parameters": ArmParameters, "parts.bars": ArmBars, "supplies": ArmSupplies}


class Arm(Mechanism):
    """Two bars; refuses bars of one length, to have a rule that spans two keys."""

    name = "arm"
    title = "Arm of two bars"
    source = "none"
    task = TASK
    branches = ("elbow-up",)
    assembly_mode = "the only one"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = {key: sections.get(key) or kind() for key, kind in SECTIONS.items()}
        p = self.sections["parameters"]
        if p.upper == p.fore:
            raise ParameterError("fore_mm", p.fore, f"must differ from upper_mm = {p.upper:g}")
        origin, z = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        names = (("shoulder", "base", "upper"), ("elbow", "upper", "fore"), ("wrist", "fore", "hand"))
        self.joints = tuple(
            Joint(
                name=name,
                kind=JointKind.REVOLUTE,
                parent=parent,
                child=child,
                p_parent=origin,
                axis_parent=z,
                p_child=origin,
                axis_child=z,
                lower=-math.pi,
                upper=math.pi,
                is_active=name != "wrist",
            )
            for name, parent, child in names
        )
        bodies = ("base", "upper", "fore", "hand")
        self.bodies = tuple(Body(name=name, kind=name, group="", parts=()) for name in bodies)
        self.home = np.array([p.upper, p.fore])

    def solve_inverse(self, poses: np.ndarray, branch: str | None = None) -> InverseSolution:
        """Cosine law; the hand is kept level, so that the wrist is passive."""
        if branch not in (None, *self.branches):
            raise UnknownNameError("branch", str(branch), self.branches)
        p = self.sections["parameters"]
        d = np.hypot(poses[:, 0], poses[:, 1])
        cosine = (d**2 - p.upper**2 - p.fore**2) / (2.0 * p.upper * p.fore)
        elbow = np.arccos(np.clip(cosine, -1.0, 1.0))
        bend = np.arctan2(p.fore * np.sin(elbow), p.upper + p.fore * np.cos(elbow))
        shoulder = np.arctan2(poses[:, 1], poses[:, 0]) - bend
        margins = np.stack([p.upper + p.fore - d, d - abs(p.upper - p.fore)], axis=-1)
        return InverseSolution(
            joints=np.stack([shoulder, elbow, -shoulder - elbow], axis=-1),
            margins=margins,
            requirements=("stretched", "folded"),
            is_reachable=np.all(margins >= 0.0, axis=-1),
        )

    def solve_forward(self, active: np.ndarray, near: np.ndarray | None = None) -> ForwardSolution:
        """The hand; without a pose nearby an elbow below -90 degrees is held ambiguous."""
        p = self.sections["parameters"]
        first, both = active[:, 0], active.sum(axis=1)
        poses = np.stack([p.upper * f(first) + p.fore * f(both) for f in (np.cos, np.sin)], axis=-1)
        n_found = np.where((active[:, 1] < -0.5 * math.pi) & (near is None), 2, 1)
        return ForwardSolution(poses=poses, is_solved=n_found == 1, n_candidates=n_found, residual=np.zeros(len(poses)))

    def compute_jacobian(self, poses: np.ndarray) -> np.ndarray:
        """Not needed here."""
        raise UnknownNameError("pose", "", ())

    def place_bodies(self, poses: np.ndarray) -> np.ndarray:
        """Not needed here."""
        raise UnknownNameError("pose", "", ())

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Its reach."""
        p = self.sections["parameters"]
        return {"reach": (p.upper + p.fore, "mm", "shoulder to hand, stretched")}

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """None."""
        return {}


def arm_entry() -> Entry:
    """The arm's row of a catalogue."""
    box = Workspace(lower=(60.0, 60.0), upper=(90.0, 90.0))
    return Entry(name="arm", title=Arm.title, source=Arm.source, sections=SECTIONS, task=TASK, workspace=box, build=Arm)


@pytest.fixture
def arm() -> Entry:
    """The arm, handed to functions that take an entry."""
    return arm_entry()
