import math

import numpy as np
import pytest
from manifold3d import CrossSection

from linkwright.generator.parts.outline import (
    depth_inside,
    hull_of_circles,
    outline_area,
    outline_length,
    polygon_of_arcs,
    split_arcs,
)


def _random_circles(rng: np.random.Generator) -> tuple[tuple[float, float, float], ...]:
    n = int(rng.integers(1, 9))
    radii = np.where(rng.random(n) < 0.25, 0.0, rng.uniform(0.5, 20.0, n))
    return tuple(zip(*rng.uniform(-40, 40, (2, n)).tolist(), radii.tolist(), strict=True))


def _support(circles, angles):
    x, y, r = np.array(circles).T[:, :, None]
    return np.max(x * np.cos(angles) + y * np.sin(angles) + r, axis=0)


def test_a_hull_reaches_as_far_in_every_direction_as_its_circles_do(rng):
    angles = np.linspace(0, 2 * math.pi, 181)
    for _ in range(150):
        circles = _random_circles(rng)
        if len({c[:2] for c in circles}) == 1 and circles[0][2] == 0.0:
            continue
        points = np.array(polygon_of_arcs(hull_of_circles(circles), 1000, outside=False))
        reach = np.max(points @ np.array([np.cos(angles), np.sin(angles)]), axis=0)
        assert np.max(np.abs(reach - _support(circles, angles))) < 20.0 * (math.pi / 1000) ** 2


def test_area_and_length_of_a_hull_are_the_integrals_of_its_support(rng):
    angles = np.linspace(0, 2 * math.pi, 40000, endpoint=False)
    for _ in range(50):
        circles = _random_circles(rng)
        if len(circles) < 3:
            continue
        arcs = hull_of_circles(circles)
        h = _support(circles, angles)
        slope = (np.roll(h, -1) - np.roll(h, 1)) / (2 * (angles[1] - angles[0]))
        assert outline_length(arcs) == pytest.approx(h.mean() * 2 * math.pi, rel=1e-4)
        assert outline_area(arcs) == pytest.approx((h**2 - slope**2).mean() * math.pi, rel=1e-3)


def test_the_hull_of_two_equal_circles_is_a_stadium():
    arcs = hull_of_circles(((0, 0, 6), (150, 0, 6)))
    assert len(arcs) == 2
    assert outline_area(arcs) == pytest.approx(150 * 12 + math.pi * 36, rel=1e-14)
    assert outline_length(arcs) == pytest.approx(300 + 12 * math.pi, rel=1e-14)


@pytest.mark.parametrize("circles", [
    ((0, 0, 5), (10, 0, 5), (20, 0, 5), (30, 0, 5)),
    ((0, 0, 5), (0, 10, 5), (0, 30, 5)),
    ((0, 0, 0), (10, 0, 0), (20, 0, 0), (20, 10, 0), (0, 10, 0)),
])  # fmt: skip
def test_circles_on_one_tangent_leave_no_edge_between_them(circles):
    arcs = hull_of_circles(circles)
    assert len(arcs) == (2 if circles[0][2] else 4)
    assert sum(arc.sweep for arc in arcs) == pytest.approx(2 * math.pi)


def test_a_circle_within_another_leaves_no_trace():
    big = (1.0, 2.0, 10.0)
    assert hull_of_circles((big, (4.0, 2.0, 7.0), (1.0, 2.0, 10.0), (0.0, 0.0, 1.0))) == hull_of_circles((big,))


def test_polygons_from_within_and_without_enclose_the_area(rng):
    for _ in range(60):
        circles = _random_circles(rng)
        arcs = hull_of_circles(circles)
        if outline_area(arcs) < 1.0:
            continue
        inner = CrossSection([polygon_of_arcs(arcs, 64, outside=False)])
        outer = CrossSection([polygon_of_arcs(arcs, 64, outside=True)])
        assert inner.area() <= outline_area(arcs) * (1 + 1e-8) <= outer.area() * (1 + 2e-8)
        assert (inner - outer).area() < 1e-5
        assert outer.area() < inner.area() * 1.01


def test_depth_inside_is_the_distance_to_the_outline(rng):
    inside = 0
    for _ in range(60):
        arcs = hull_of_circles(_random_circles(rng))
        outline = np.array(polygon_of_arcs(arcs, 2000, outside=False))
        x, y = outline.mean(axis=0) + rng.uniform(-10, 10, 2)
        depth = depth_inside(arcs, x, y)
        if depth > 0:
            inside += 1
            along = np.roll(outline, -1, 0) - outline
            share = np.clip((((x, y) - outline) * along).sum(-1) / (along**2).sum(-1), 0, 1)
            distance = np.min(np.linalg.norm(outline + share[:, None] * along - (x, y), axis=-1))
            assert depth == pytest.approx(distance, abs=1e-4)
    assert inside > 20


def test_a_flush_boss_is_split_where_the_bar_is_tangent_to_it():
    bar, boss = hull_of_circles(((0, 0, 6), (150, 0, 6))), hull_of_circles(((0, 0, 6),))
    pieces = split_arcs(boss, bar)
    assert len(pieces) == 3
    ends = {tuple(np.round(p.point(a), 9) + 0.0) for p in pieces for a in (p.start, p.end)}
    assert {(0.0, 6.0), (0.0, -6.0)} <= ends
    assert split_arcs(bar, boss) == bar


def test_circles_of_another_place_do_not_split_a_boss():
    boss = hull_of_circles(((0, 0, 6),))
    assert split_arcs(boss, hull_of_circles(((0.1, 0, 6), (150, 0, 6)))) == boss
