"""The outline of a slab: the convex hull of circles, as exact arcs and the tangents that join them."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

Circle = tuple[float, float, float]

_TURN = 2.0 * math.pi
#: Two tangents that differ by less point the same way [rad]: the rounding of atan2 and acos together.
_SAME_ANGLE = 1e-11
#: Splitting closer than this to an arc's end would leave an edge shorter than the kernel's tolerance [mm].
_SHORTEST = 1e-5


@dataclass(frozen=True, slots=True, kw_only=True)
class Arc:
    """An arc of a hull, counter-clockwise; a sharp corner if its radius is 0.

    Attributes:
        x, y, radius: its circle [mm].
        start, end: directions of its first and last point from the centre [rad]; start <= end.
    """

    x: float
    y: float
    radius: float
    start: float
    end: float

    def point(self, angle: float) -> tuple[float, float]:
        """The point of the circle in this direction [mm]."""
        return self.x + self.radius * math.cos(angle), self.y + self.radius * math.sin(angle)

    @property
    def sweep(self) -> float:
        """Angle turned along the arc [rad]."""
        return self.end - self.start


def hull_of_circles(circles: tuple[Circle, ...]) -> tuple[Arc, ...]:
    """Arcs of the convex hull of circles (x, y, radius) [mm], counter-clockwise; tangents join them.

    Walks around the hull by its outward normal: circle i hands over to the circle j whose common tangent with i
    comes next, at the normal's angle `phi_ij - acos((r_i - r_j) / d_ij)`. One circle alone is a full turn.
    """
    outer = _drop_contained(circles)
    if len(outer) == 1:
        x, y, r = outer[0]
        return (Arc(x=x, y=y, radius=r, start=0.0, end=_TURN),)
    # At angle 0 the hull is where x + r is largest; of several there, the walk is already on the highest.
    reach = max(c[0] + c[2] for c in outer)
    first = max((i for i, c in enumerate(outer) if c[0] + c[2] > reach - 1e-9), key=lambda i: outer[i][1])
    arcs, i, angle = [], first, 0.0
    while True:
        j, step = _next_tangent(outer, i, angle)
        end = min(angle + step, _TURN)
        x, y, r = outer[i]
        arcs.append(Arc(x=x, y=y, radius=r, start=angle, end=end))
        if angle + step >= _TURN - _SAME_ANGLE:
            break
        i, angle = j, angle + step
    if i == first and len(arcs) > 1:
        # The walk began in the middle of an arc.
        head, tail = arcs[0], arcs.pop()
        arcs[0] = Arc(x=head.x, y=head.y, radius=head.radius, start=tail.start - _TURN, end=head.end)
    return tuple(arcs)


def _drop_contained(circles: tuple[Circle, ...]) -> list[Circle]:
    """The circles without those that lie inside another one (touching counts as inside)."""
    kept: list[Circle] = []
    for x, y, r in sorted(set(circles), key=lambda c: -c[2]):
        if not any(math.hypot(x - u, y - v) + r <= s + 1e-9 for u, v, s in kept):
            kept.append((x, y, r))
    return kept


def _next_tangent(circles: list[Circle], i: int, angle: float) -> tuple[int, float]:
    """Index of the circle that follows i on the hull, and by how much the normal turns until then [rad]."""
    x, y, r = circles[i]
    best, best_step, best_distance = i, math.inf, 0.0
    for j, (u, v, s) in enumerate(circles):
        if j == i:
            continue
        d = math.hypot(u - x, v - y)
        handover = math.atan2(v - y, u - x) - math.acos(max(-1.0, min(1.0, (r - s) / d)))
        step = (handover - angle) % _TURN
        if step > _TURN - _SAME_ANGLE:
            step = 0.0
        # Of circles on one tangent the farthest follows; those between only touch it.
        if step < best_step - _SAME_ANGLE or (step < best_step + _SAME_ANGLE and d > best_distance):
            best, best_step, best_distance = j, step, d
    return best, best_step


def split_arcs(arcs: tuple[Arc, ...], others: tuple[Arc, ...]) -> tuple[Arc, ...]:
    """The arcs, cut wherever one of the others on the same circle begins or ends.

    A boss that is flush with a bar's end lies on the bar's own cylinder, and the bar's flanks are tangent to it. The
    kernel loses such a union without a word; with the tangent points as corners of both it only has to match edges.
    """
    pieces: list[Arc] = []
    for arc in arcs:
        cuts = {0.0, arc.sweep}
        if arc.radius > 0.0:
            for other in others:
                if math.dist((arc.x, arc.y, arc.radius), (other.x, other.y, other.radius)) < 1e-7:
                    for angle in (other.start, other.end) if other.sweep < _TURN else ():
                        cuts.add((angle - arc.start) % _TURN)
        least = _SHORTEST / arc.radius if arc.radius > 0.0 else 0.0
        inside = [c for c in sorted(cuts) if least < c < arc.sweep - least]
        marks = [0.0]
        marks += [c for k, c in enumerate(inside) if k == 0 or c - inside[k - 1] > least]
        marks.append(arc.sweep)
        pieces += [
            Arc(x=arc.x, y=arc.y, radius=arc.radius, start=arc.start + a, end=arc.start + b)
            for a, b in itertools.pairwise(marks)
        ]
    return tuple(pieces)


def outline_area(arcs: tuple[Arc, ...]) -> float:
    """Area enclosed by a hull [mm2]: the polygon of its arcs' ends, and the segment of each arc."""
    points = [arc.point(angle) for arc in arcs for angle in (arc.start, arc.end)]
    polygon = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(points, points[1:] + points[:1], strict=True)) / 2.0
    return polygon + sum(arc.radius**2 * (arc.sweep - math.sin(arc.sweep)) / 2.0 for arc in arcs)


def outline_length(arcs: tuple[Arc, ...]) -> float:
    """Circumference of a hull [mm]."""
    gaps = zip(arcs, arcs[1:] + arcs[:1], strict=True)
    return sum(arc.radius * arc.sweep for arc in arcs) + sum(
        math.dist(a.point(a.end), b.point(b.start)) for a, b in gaps
    )


def depth_inside(arcs: tuple[Arc, ...], x: float, y: float) -> float:
    """How far (x, y) lies inside a hull [mm]: the largest disc about it; negative outside.

    Outside it is the distance below a supporting line, never more than the true one.
    """
    best = math.inf
    for a, b in zip(arcs, arcs[1:] + arcs[:1], strict=True):
        direction = math.atan2(y - a.y, x - a.x)
        if (direction - a.start) % _TURN <= a.sweep:
            best = min(best, a.radius - math.hypot(x - a.x, y - a.y))
        px, py = a.point(a.end)
        best = min(best, (px - x) * math.cos(a.end) + (py - y) * math.sin(a.end))
        qx, qy = b.point(b.start)
        best = min(best, (qx - x) * math.cos(b.start) + (qy - y) * math.sin(b.start))
    return best


def polygon_of_arcs(arcs: tuple[Arc, ...], n: int, *, outside: bool) -> list[tuple[float, float]]:
    """Corners of a polygon that the hull contains, or that contains the hull if `outside` [mm].

    Args:
        arcs: of the hull.
        n: chords (or tangents) that a full turn is cut into.
        outside: circumscribed instead of inscribed.
    """
    points: list[tuple[float, float]] = []
    for arc in arcs:
        k = max(1, math.ceil(n * arc.sweep / _TURN)) if arc.radius > 0.0 else 0
        if k == 0 or arc.sweep == 0.0:
            points.append(arc.point(arc.start))
            continue
        step = arc.sweep / k
        if outside:
            far = Arc(x=arc.x, y=arc.y, radius=arc.radius / math.cos(step / 2.0), start=arc.start, end=arc.end)
            middles = [far.point(arc.start + (m + 0.5) * step) for m in range(k)]
            points += middles if arc.sweep >= _TURN else [arc.point(arc.start), *middles, arc.point(arc.end)]
        else:
            points += [arc.point(arc.start + m * step) for m in range(k + (arc.sweep < _TURN))]
    return points
