"""The profile of a turned part: its edges, its mistakes, and the volume that it sweeps by Pappus."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Vertex

Corner = tuple[float, float]

#: Shorter edges cannot be told from the kernel's tolerance [mm].
SHORTEST_EDGE = 1e-5
#: A radius below this lies on the axis: rounding of a designer's formula, not a dimension [mm].
_ON_AXIS = 1e-9
_CHORDS = 48


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfileEdge:
    """An edge of a profile in (r, z) [mm]: a line, or an arc about `centre`.

    Attributes:
        start, end: its corners.
        centre: of the arc; None for a line.
        radius: of the arc; 0 for a line.
        first, sweep: direction of the arc's start from its centre, and the signed angle that it turns [rad].
    """

    start: Corner
    end: Corner
    centre: Corner | None = None
    radius: float = 0.0
    first: float = 0.0
    sweep: float = 0.0

    @property
    def is_on_axis(self) -> bool:
        """A line along the axis, which sweeps no face."""
        return self.centre is None and self.start[0] == 0.0 and self.end[0] == 0.0

    def at(self, share: float) -> Corner:
        """The point a share (0..1) along the edge [mm]."""
        if self.centre is None:
            (a, b), (c, d) = self.start, self.end
            return a + share * (c - a), b + share * (d - b)
        angle = self.first + share * self.sweep
        return self.centre[0] + self.radius * math.cos(angle), self.centre[1] + self.radius * math.sin(angle)


def build_profile(vertices: tuple[Vertex, ...], where: str) -> tuple[ProfileEdge, ...]:
    """The edges of a closed profile; arcs whose centre is on the axis have it exactly there.

    Its corners must run counter-clockwise with r to the right and z up. That is no matter of taste: a negative length
    turns a profile over, and the mirrored part would pass every later check.

    Raises:
        BuildError: fewer than three corners, a negative radius, an edge without length, an arc through points on one
            line, edges that cross or touch, a profile that meets the axis in a point only, or one that runs clockwise.
    """
    if len(vertices) < 3:
        raise BuildError(where, f"a turned profile needs at least 3 corners, it has {len(vertices)}")
    corners = [_corner(v.r, v.z, i, where) for i, v in enumerate(vertices)]
    edges = []
    for i, vertex in enumerate(vertices):
        start, end = corners[i - 1], corners[i]
        if vertex.mid is None and math.dist(start, end) < SHORTEST_EDGE:
            previous = (i - 1) % len(vertices)
            raise BuildError(
                where,
                f"corners {previous} and {i} of the profile coincide at r = {end[0]:g}, z = {end[1]:g} mm; "
                "leave one out",
            )
        edges.append(
            ProfileEdge(start=start, end=end) if vertex.mid is None else _arc(start, vertex.mid, end, i, where)
        )
    _refuse_crossings(edges, where)
    _refuse_axis_points(edges, where)
    area = sum(_moments(edge)[0] for edge in edges)
    if abs(area) < SHORTEST_EDGE**2:
        raise BuildError(where, "the profile encloses no area")
    if area < 0.0:
        raise BuildError(
            where,
            f"the profile's corners run clockwise around {-area:.4g} mm2 (r to the right, z up): a length or a "
            "thickness is negative; as solids count they must run counter-clockwise",
        )
    return tuple(edges)


def straight_profile(corners: tuple[Corner, ...]) -> tuple[ProfileEdge, ...]:
    """The edges through corners that are known to be in order, such as a drill's."""
    return tuple(ProfileEdge(start=a, end=b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))


def swept_volume(edges: tuple[ProfileEdge, ...]) -> float:
    """Volume of the solid of revolution [mm3].

    Source: Pappus: 2 pi times the profile's first moment about the axis, each edge integrated in closed form.
    """
    return 2.0 * math.pi * sum(_moments(edge)[1] for edge in edges)


def profile_span(edges: tuple[ProfileEdge, ...]) -> tuple[float, float]:
    """Lowest and highest z of a profile [mm]; an arc may bulge beyond its corners."""
    heights = [edge.end[1] for edge in edges]
    for edge in edges:
        if edge.centre is not None:
            # The circle's lowest and highest points, where the arc passes them.
            for pole in (-math.pi / 2.0, math.pi / 2.0):
                turn = (pole - edge.first) % math.tau if edge.sweep > 0.0 else (edge.first - pole) % math.tau
                if turn <= abs(edge.sweep):
                    heights.append(edge.centre[1] + edge.radius * math.sin(pole))
    return min(heights), max(heights)


def outer_walls(edges: tuple[ProfileEdge, ...], low: float, high: float) -> list[float]:
    """Radii [mm] of the straight cylinders that bound the part outwards somewhere between two heights [mm].

    Cones and balls do not count: a hole may well open into one.
    """
    return [
        edge.start[0]
        for edge in edges
        if edge.centre is None
        and abs(edge.start[0] - edge.end[0]) < SHORTEST_EDGE
        and edge.end[1] > edge.start[1]  # upwards on a counter-clockwise profile: material lies inwards
        and min(edge.end[1], high) - max(edge.start[1], low) > SHORTEST_EDGE
    ]


def _corner(r: float, z: float, i: int, where: str) -> Corner:
    if not (math.isfinite(r) and math.isfinite(z)):
        raise BuildError(where, f"corner {i} of the profile is at r = {r}, z = {z}: not a number")
    if r < -_ON_AXIS:
        raise BuildError(where, f"corner {i} of the profile lies at radius {r:g} mm; a radius must not be negative")
    return (0.0 if r < _ON_AXIS else float(r)), float(z)


def _arc(start: Corner, mid: Corner, end: Corner, i: int, where: str) -> ProfileEdge:
    a, b, c = (np.array(p, dtype=float) for p in (start, mid, end))
    u, v = b - a, c - a
    cross = u[0] * v[1] - u[1] * v[0]
    size = max(math.dist(start, mid), math.dist(mid, end), math.dist(start, end))
    if (
        min(math.dist(start, mid), math.dist(mid, end), math.dist(start, end)) < SHORTEST_EDGE
        or abs(cross) < 1e-9 * size**2
    ):
        raise BuildError(where, f"the arc to corner {i} goes through {start}, {mid}, {end}: no circle does; use a line")
    uu, vv = u @ u, v @ v
    centre = a + np.array([v[1] * uu - u[1] * vv, u[0] * vv - v[0] * uu]) / (2.0 * cross)
    r_c = 0.0 if abs(centre[0]) < _ON_AXIS * max(1.0, size) else float(centre[0])
    centre_point = (r_c, float(centre[1]))
    first = math.atan2(start[1] - centre_point[1], start[0] - centre_point[0])
    last = math.atan2(end[1] - centre_point[1], end[0] - centre_point[0])
    sweep = (last - first) % math.tau if cross > 0.0 else -((first - last) % math.tau)
    return ProfileEdge(
        start=start, end=end, centre=centre_point, radius=math.dist(start, centre_point), first=first, sweep=sweep
    )


def _moments(edge: ProfileEdge) -> tuple[float, float]:
    """Share of an edge in the area, the integral of r dz, and in its first moment, that of r^2/2 dz."""
    (a, p), (b, q) = edge.start, edge.end
    if edge.centre is None:
        return (a + b) / 2.0 * (q - p), (a * a + a * b + b * b) / 6.0 * (q - p)
    r, radius, t0, t1 = edge.centre[0], edge.radius, edge.first, edge.first + edge.sweep
    sin, cos2 = math.sin(t1) - math.sin(t0), (t1 - t0) / 2.0 + (math.sin(2 * t1) - math.sin(2 * t0)) / 4.0
    cos3 = sin - (math.sin(t1) ** 3 - math.sin(t0) ** 3) / 3.0
    area = radius * (r * sin + radius * cos2)
    return area, radius * (r * r * sin + 2.0 * r * radius * cos2 + radius**2 * cos3) / 2.0


def _refuse_crossings(edges: list[ProfileEdge], where: str) -> None:
    """Edges as fine chords: no chord may meet one of another edge but where the edges join, nor lie beyond the axis."""
    for i, edge in enumerate(edges):
        least = min(edge.at(k / _CHORDS)[0] for k in range(_CHORDS + 1))
        if least < -SHORTEST_EDGE:
            raise BuildError(
                where, f"the arc to corner {i} of the profile reaches radius {least:.4g} mm, beyond the axis"
            )
    lines = [np.array([e.at(k / n) for k in range(n + 1)]) for e in edges for n in [_CHORDS if e.centre else 1]]
    count = len(edges)
    for i in range(count):
        for j in range(i + 1, count):
            hit = _meeting(lines[i], lines[j], j == i + 1, i == 0 and j == count - 1)
            if hit is not None:
                raise BuildError(
                    where,
                    f"the profile crosses or touches itself: its edges to corners {i} and {j} meet at "
                    f"r = {hit[0]:.4g}, z = {hit[1]:.4g} mm; a length there is negative or a wall has no thickness",
                )


def _meeting(first: np.ndarray, second: np.ndarray, follows: bool, precedes: bool) -> np.ndarray | None:
    """A point where two chains of chords meet, other than the corner that they share; None if there is none."""
    a, b = first[:-1, None], first[1:, None]
    c, d = second[None, :-1], second[None, 1:]
    u, v, w = b - a, d - c, c - a
    det = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (w[..., 0] * v[..., 1] - w[..., 1] * v[..., 0]) / det
        t = (w[..., 0] * u[..., 1] - w[..., 1] * u[..., 0]) / det
    hits = (det != 0.0) & (s > -1e-9) & (s < 1.0 + 1e-9) & (t > -1e-9) & (t < 1.0 + 1e-9)
    points = np.broadcast_to(a, (*s.shape, 2))[hits] + s[hits, None] * np.broadcast_to(u, (*s.shape, 2))[hits]
    shared = ([first[-1]] if follows else []) + ([first[0]] if precedes else [])
    for corner in shared:
        points = points[np.linalg.norm(points - corner, axis=-1) > SHORTEST_EDGE]
    if len(points):
        return points[0]
    return _overlap(first, second, shared)


def _overlap(first: np.ndarray, second: np.ndarray, shared: list[np.ndarray]) -> np.ndarray | None:
    """A corner of one chain that lies on the other: parallel edges on one line, which no crossing shows."""
    for chain, points in ((first, second[[0, -1]]), (second, first[[0, -1]])):
        a, u = chain[:-1], np.diff(chain, axis=0)
        for point in points:
            if any(np.linalg.norm(point - corner) < SHORTEST_EDGE for corner in shared):
                continue
            s = np.clip(((point - a) * u).sum(-1) / (u * u).sum(-1), 0.0, 1.0)
            if np.min(np.linalg.norm(a + s[:, None] * u - point, axis=-1)) < SHORTEST_EDGE:
                return point
    return None


def _refuse_axis_points(edges: list[ProfileEdge], where: str) -> None:
    for i, edge in enumerate(edges):
        follower = edges[(i + 1) % len(edges)]
        if edge.end[0] == 0.0 and not edge.is_on_axis and not follower.is_on_axis:
            raise BuildError(
                where,
                f"the profile meets the axis in one point only, at corner {i} (z = {edge.end[1]:g} mm): "
                "the part has no thickness there",
            )
