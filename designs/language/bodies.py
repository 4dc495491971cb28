"""A body: parts that move as one, each a feature at a place, of a material."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .features import Feature
from .poses import frame

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Where a part's frame lies in its body: origin [mm], direction of its z, and of its x (orthogonalised)."""

    origin: Point = (0.0, 0.0, 0.0)
    z: Point = (0.0, 0.0, 1.0)
    x: Point = (1.0, 0.0, 0.0)

    def matrix(self) -> np.ndarray:
        """T_body_part, shape (4, 4)."""
        return frame(self.origin, self.z, self.x)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One separate part of a body.

    Attributes:
        name: snake_case, unique in its body.
        feature: its shape as numbers.
        at: its place in the body.
        material: a row of the materials table.
        purchased: catalogue designation ("MR104ZZ"), empty for a made part.
        mass: catalogue mass of a purchased part [kg]; None takes volume times density.
        runs_in_joint: its faces of revolution about a joint's axis (or on its ball) run in that joint: pins,
            bearings, spacers, clips, balls and seats. Such a face may come near its partner's; nothing else may.
        fit: how it is held in its body, in words ("press H7/p6 in bar").
    """

    name: str
    feature: Feature
    at: Placement = Placement()
    material: str
    purchased: str = ""
    mass: float | None = None
    runs_in_joint: bool = False
    fit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A rigid body.

    Attributes:
        name: unique in the mechanism ("leg_1_lower_left").
        kind: bodies of one kind have equal parts in their own frames ("lower_left").
        group: the sub-assembly it is filed under ("leg_1"), or empty for the top level.
        parts: none for a mechanism that has no solids yet.
    """

    name: str
    kind: str
    group: str
    parts: tuple[Part, ...]
