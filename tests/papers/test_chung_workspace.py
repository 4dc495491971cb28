"""Chung, Choo, Lee, section 4: SenSation against the plain five-bar, and what of the claims holds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from linkwright.designs.language.vocabulary import Requirements
from linkwright.designs.sensation.kinematics import solve_state
from linkwright.designs.sensation.mechanism import Sensation
from linkwright.designs.sensation.parameters import SensationParameters

DEG = math.pi / 180.0
P = SensationParameters()
D, L = P.pivot_distance, P.arm_length
HALF = D / 2.0
#: Elbows out on both sides: the posture of the comparison.
OUT = (-1.0, 1.0)
#: Cell of the grids [mm].
GRID = 2.0


def u(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _arms(pose, posture=OUT, p=P):
    """theta_1 to theta_4; with equal links those of both devices."""
    with np.errstate(divide="ignore", invalid="ignore"):
        state = solve_state(p, pose, posture, Requirements())
    return (*state.right, *state.left)


def _grid(p=P, least_y=None, step=GRID):
    """Angles over the lens of both reaches; x to the right, y upwards [mm]."""
    n = int(400.0 / step)
    x, y = np.meshgrid(step * np.arange(-n, n + 1), step * np.arange(-n, n + 1))
    t = np.stack(_arms((x, y), OUT, p))
    reach = p.arm_length + p.tip_link_length
    half = p.pivot_distance / 2.0
    lens = (np.hypot(x - half, y) < reach) & (np.hypot(x + half, y) < reach)
    if least_y is not None:
        lens &= y > least_y
    return x, y, t, lens


def _free_of_direct_singularities(t, lens, x, y, driven_tip, start):
    """Cells connected with the start on which the determinant of J_p keeps the start's sign."""
    det = np.sin(t[2] - t[0]) if driven_tip else np.sin(t[1] - t[3])
    labels, _ = ndimage.label(lens & (det > 0.0))
    return labels == labels[np.unravel_index(np.argmin(np.hypot(x - start[0], y - start[1])), x.shape)]


def _free_area(driven_tip, least_y=0.0, p=P):
    x, y, t, lens = _grid(p, least_y)
    # A start on the same side of the locus for both: beyond the five-bar's loop.
    return float(_free_of_direct_singularities(t, lens, x, y, driven_tip, (0.0, 220.0)).sum()) * GRID**2 * 1e-6


def test_above_the_motors_sensation_has_a_quarter_more_area_free_of_direct_singularities():
    lens = 2.0 * (2 * L) ** 2 * math.acos(HALF / (2 * L)) - HALF * math.sqrt((4 * L) ** 2 - D**2)
    assert lens * 1e-6 == pytest.approx(0.2789, abs=5e-5)
    assert _grid(P)[3].sum() * GRID**2 == pytest.approx(lens, rel=2e-3)
    mine, other = _free_area(True), _free_area(False)
    assert mine == pytest.approx(0.1360, abs=0.0010)
    assert other == pytest.approx(0.1088, abs=0.0010)
    assert mine / other == pytest.approx(1.25, abs=0.01)


def test_over_the_whole_plane_both_areas_are_equal_so_the_claim_needs_the_upper_half():
    mine, other = _free_area(True, None), _free_area(False, None)
    assert mine == pytest.approx(0.2441, abs=0.0010)
    assert other == pytest.approx(mine, rel=0.002)


@pytest.mark.parametrize(("d", "ratio"), [(90.0, 1.10), (120.0, 1.14), (150.0, 1.19), (240.0, 1.38), (300.0, 1.46)])
def test_the_gain_grows_with_the_distance_of_the_motors(d, ratio):
    p = SensationParameters(pivot_distance=d)
    assert _free_area(True, 0.0, p) / _free_area(False, 0.0, p) == pytest.approx(ratio, abs=0.015)


def _with_margins(driven_tip):
    x, y, t, lens = _grid(P, 20.0)
    least = math.sin(20.0 * DEG)
    direct = np.sin(t[2] - t[0]) if driven_tip else np.sin(t[1] - t[3])
    good = lens & (np.sin(t[1] - t[0]) >= least) & (np.sin(t[2] - t[3]) >= least) & (direct >= least)
    labels, _ = ndimage.label(good)
    start = (0.0, 180.0) if driven_tip else (0.0, 265.0)
    return x, y, labels == labels[np.unravel_index(np.argmin(np.hypot(x - start[0], y - start[1])), x.shape)]


@pytest.mark.parametrize(("driven_tip", "area"), [(True, 0.1107), (False, 0.0836)])
def test_with_20_degrees_of_margin_sensation_keeps_a_third_more_area(driven_tip, area):
    _, _, good = _with_margins(driven_tip)
    assert good.sum() * GRID**2 * 1e-6 == pytest.approx(area, abs=0.0010)


def test_with_20_degrees_of_margin_sensation_holds_a_circle_three_times_as_large_in_area():
    """Largest circle on the middle line, by distance on the grid: radius 132 and 75 mm within a cell."""
    found = []
    for driven_tip, declared in ((True, (180.0, 130.0)), (False, (265.0, 72.0))):
        x, y, good = _with_margins(driven_tip)
        depth = (ndimage.distance_transform_edt(good) * GRID)[:, np.flatnonzero(x[0] == 0.0)[0]]
        found.append((float(depth.max()), float(y[int(np.argmax(depth)), 0])))
        inside = np.hypot(x, y - declared[0]) <= declared[1]
        assert good[inside].all()
    assert found[0] == pytest.approx((132.5, 177.0), abs=1.5 * GRID)
    assert found[1] == pytest.approx((75.0, 264.0), abs=1.5 * GRID)
    assert (found[0][0] / found[1][0]) ** 2 == pytest.approx(3.1, abs=0.2)


def _conditions(driven_tip, step=GRID):
    x, y, t, lens = _grid(P, 0.0, step)
    free = _free_of_direct_singularities(t, lens, x, y, driven_tip, (0.0, 220.0))
    t1, t2, t3, t4 = (angle[free] for angle in t)
    a, b, ga, gb = (t1, t3, t2, t4) if driven_tip else (t2, t4, t1, t3)
    with np.errstate(divide="ignore"):
        rows = np.stack([u(a) / np.sin(a - ga)[:, None], u(b) / np.sin(b - gb)[:, None]], axis=1)
    norm = np.sum(rows**2, axis=(1, 2))
    det = np.abs(np.linalg.det(rows))
    return (norm + np.sqrt(np.maximum(norm**2 - 4.0 * det**2, 0.0))) / (2.0 * det)


def test_inside_their_free_areas_both_devices_are_equally_isotropic():
    """The paper's ellipses look better only because the inner locus is gone; isotropy everywhere does not hold."""
    mine, other = _conditions(True), _conditions(False)
    assert np.median(mine) == pytest.approx(2.11, abs=0.02)
    assert np.median(other) == pytest.approx(2.17, abs=0.02)
    assert np.percentile(mine, 90) == pytest.approx(6.0, abs=0.2)
    assert np.percentile(other, 90) == pytest.approx(8.8, abs=0.4)
    assert np.mean(1.0 / mine) == pytest.approx(0.441, abs=0.003)
    assert np.mean(1.0 / other) == pytest.approx(0.445, abs=0.003)
    for limit, share, other_share in ((2.0, 0.45, 0.45), (3.0, 0.72, 0.66), (5.0, 0.87, 0.81)):
        assert np.mean(mine < limit) == pytest.approx(share, abs=0.01)
        assert np.mean(other < limit) == pytest.approx(other_share, abs=0.01)


def test_sensation_is_nowhere_isotropic_on_its_middle_line():
    y = np.arange(40.0, 330.0, 1.0)
    J = Sensation({}).compute_jacobian(np.stack([np.zeros_like(y), y], axis=-1))
    assert np.linalg.cond(J).min() == pytest.approx(1.73, abs=0.01)
