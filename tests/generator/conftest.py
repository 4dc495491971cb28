"""Features that several tests build, and one seeded source of chance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex

BALL, NECK, FOOT = 10.0, 3.0, -30.0


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20041)


@pytest.fixture
def rod() -> Turned:
    """A cylinder of radius 5 from z = 0 to 10."""
    return Turned(profile=(Vertex(r=0, z=0), Vertex(r=5, z=0), Vertex(r=5, z=10), Vertex(r=0, z=10)))


@pytest.fixture
def ball_with_neck() -> Turned:
    """A ball of radius 10 about the origin on a neck of radius 3 that ends at z = -30."""
    z = -math.sqrt(BALL**2 - NECK**2)
    return Turned(
        profile=(
            Vertex(r=0, z=FOOT),
            Vertex(r=NECK, z=FOOT),
            Vertex(r=NECK, z=z),
            Vertex(r=0, z=BALL, mid=(BALL, 0)),
        )
    )


@pytest.fixture
def bar() -> Milled:
    """A bar of 150 mm between two eyes, each with a bearing seat from above and a lip below."""
    seat = {"top": 6.0, "diameter": 8.0, "head_diameter": 10.0, "head_depth": 4.0}
    return Milled(
        slabs=(
            Slab(circles=((0, 0, 6), (150, 0, 6)), low=0, high=6),
            Slab(circles=((0, 0, 8),), low=0, high=6),
            Slab(circles=((150, 0, 8),), low=0, high=6),
        ),
        holes=(Hole(**seat), Hole(x=150, **seat)),
    )


@pytest.fixture
def plate() -> Milled:
    """A triangular plate with a window, six countersunk holes and broken edges."""
    return Milled(
        slabs=(Slab(circles=((100, 0, 20), (-50, 86.6, 20), (-50, -86.6, 20)), low=0, high=6),),
        windows=(Slab(circles=((0, 0, 30),), low=0, high=6),),
        holes=(Hole(top=6, diameter=4.5, head_diameter=9, countersink=True, n=6, pitch_radius=40),),
        edge_break=0.5,
    )


@pytest.fixture
def features(rod: Turned, ball_with_neck: Turned, bar: Milled, plate: Milled) -> dict[str, Turned | Milled]:
    return {"rod": rod, "ball_with_neck": ball_with_neck, "bar": bar, "plate": plate}
