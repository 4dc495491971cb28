"""The two shapes of which every made part consists, as numbers: turned on a lathe, or milled out of plate.

A feature is frozen numbers in the part's own frame; the generator turns it into one solid. Lengths in mm.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Vertex:
    """A corner of a turned profile at radius r and height z.

    With `mid` = (r, z) the edge that arrives here from the vertex before is the circular arc through that point.
    """

    r: float
    z: float
    mid: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Hole:
    """A hole along z at (x, y), drilled from the plane z = `top` downwards (from z = `top` upwards if `upwards`).

    Attributes:
        diameter: of the bore. Threaded holes carry their nominal diameter and a `thread` such as "M4".
        depth: from `top`; None goes through everything.
        head_diameter, head_depth: a wider bore for a head or a bearing at the same end; 0 for none.
        countersink: the head recess is a 90 degree cone of `head_diameter` instead of a cylinder.
        n, pitch_radius: n > 1 repeats the hole on a circle about (x, y), the first at angle `first` [rad].
    """

    x: float = 0.0
    y: float = 0.0
    top: float
    diameter: float
    depth: float | None = None
    upwards: bool = False
    head_diameter: float = 0.0
    head_depth: float = 0.0
    countersink: bool = False
    thread: str = ""
    n: int = 1
    pitch_radius: float = 0.0
    first: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossHole:
    """A blind hole in any direction: starts at `origin` and goes `depth` along `direction`."""

    origin: tuple[float, float, float]
    direction: tuple[float, float, float]
    diameter: float
    depth: float
    thread: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Turned:
    """A solid of revolution about z.

    Attributes:
        profile: closed polygon (last joins first) of at least three vertices with r >= 0, counter-clockwise with r to
            the right and z up; a clockwise one is refused, for only so does a negative length show.
        holes, cross_holes: cut afterwards.
        hex_socket: (across flats, z of its mouth, depth downwards) or None.
    """

    profile: tuple[Vertex, ...]
    holes: tuple[Hole, ...] = ()
    cross_holes: tuple[CrossHole, ...] = ()
    hex_socket: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Slab:
    """The convex hull of circles (x, y, radius) in plan, from z = low to z = high. One circle is a disc."""

    circles: tuple[tuple[float, float, float], ...]
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Milled:
    """A union of slabs with holes and windows.

    Attributes:
        slabs: their union is the blank; it must be one piece.
        windows: cut through (their own low and high bound the cut).
        edge_break: chamfer on the outer edges of the largest slab's top and bottom faces; 0 for none.
    """

    slabs: tuple[Slab, ...]
    windows: tuple[Slab, ...] = ()
    holes: tuple[Hole, ...] = ()
    cross_holes: tuple[CrossHole, ...] = ()
    edge_break: float = 0.0


Feature = Turned | Milled
