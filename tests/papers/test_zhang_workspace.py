"""Zhang, Kong, Sun, Du: section IV. The workspace under kinematic limits alone: shape, size, Fig. 9's levelling."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.designs.hit.mechanism import Hit
from linkwright.designs.hit.parameters import HIT_REFERENCE, HitLimits

DEG = math.pi / 180.0
CENTRE = np.array([0.0, 0.0, 250.0])


def device(cone_deg=55.0, pin_deg=60.0):
    limits = HitLimits(cone_max=cone_deg * DEG, pin_max=pin_deg * DEG)
    return Hit({"parameters": HIT_REFERENCE, "joint_limits": limits})


def scan(hit, turns_deg, step_deg, grow=5.0):
    """Radii of the part seen from the centre, shape (n_zenith + 1, n_azimuth) [mm]: grown, then bisected.

    Source: eqs. (17)-(24). Printed: z with cos(beta) in (21), azimuths 0..J, which counts the seam twice. Used: z with
    cos(alpha) alone, azimuths 0..J-1.
    """
    zenith = np.arange(0.0, 180.0 + 1e-9, step_deg) * DEG
    azimuth = np.arange(0.0, 360.0 - 1e-9, step_deg) * DEG
    a, b = np.meshgrid(zenith, azimuth, indexing="ij")
    rays = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1).reshape(-1, 3)

    def feasible(radii):
        poses = np.tile([0.0, 0.0, 0.0, *np.array(turns_deg) * DEG], (len(radii), 1))
        poses[:, :3] = CENTRE + rays * radii[:, None]
        return hit.solve_inverse(poses).is_reachable

    low, is_growing = np.zeros(len(rays)), feasible(np.zeros(len(rays)))
    if not is_growing.all():
        return np.zeros(a.shape)
    while is_growing.any():
        is_growing &= feasible(low + grow)
        low = np.where(is_growing, low + grow, low)
    high = low + grow
    for _ in range(12):
        middle = 0.5 * (low + high)
        good = feasible(middle)
        low, high = np.where(good, middle, low), np.where(good, high, middle)
    return low.reshape(a.shape)


def volume(radii, step_deg):
    """Litres: sum of radius cubed over 3, times the solid angle of each cell."""
    zenith = np.arange(len(radii)) * step_deg * DEG
    edges = np.concatenate([[0.0], (zenith[1:] + zenith[:-1]) / 2.0, [math.pi]])
    return float(np.sum(radii**3 / 3.0 * (np.cos(edges[:-1]) - np.cos(edges[1:]))[:, None]) * step_deg * DEG) / 1e6


def test_its_size_with_the_reference_set_is_18_litres():
    assert volume(scan(device(), (0, 0, 0), 4.0), 4.0) == pytest.approx(18.2, rel=0.02)


def test_counting_the_seam_twice_as_printed_inflates_it_by_one_azimuth_in_ninety():
    radii = scan(device(), (0, 0, 0), 4.0)
    printed = np.concatenate([radii, radii[:, :1]], axis=1)
    assert volume(printed, 4.0) / volume(radii, 4.0) == pytest.approx(1.0 + 0.013, abs=0.004)


def test_radii_without_bisection_lose_volume():
    radii = scan(device(), (0, 0, 0), 8.0)
    assert volume(np.floor(radii / 10.0) * 10.0, 8.0) / volume(radii, 8.0) == pytest.approx(1.0 - 0.084, abs=0.02)


@pytest.mark.parametrize(("turns", "litres"), [
    ((0, 0, 0), {10: 1.26, 20: 4.74, 30: 9.55, 40: 14.46, 50: 17.68, 55: 18.22, 80: 18.40}),
    ((6, 6, 6), {10: 0.56, 20: 3.53, 30: 7.60, 40: 11.76, 50: 14.67, 55: 15.41, 80: 15.82}),
])  # fmt: skip
def test_figure_9_levels_beyond_50_degrees_of_half_cone_at_small_tilts(turns, litres):
    got = {cone: volume(scan(device(cone, 80.0), turns, 6.0), 6.0) for cone in litres}
    for cone, want in litres.items():
        assert got[cone] == pytest.approx(want, rel=0.05), cone
    assert got[50] / got[80] > 0.9
    assert got[20] / got[80] < 0.4


def test_figure_9_does_not_level_at_20_degrees_of_every_turn():
    """The paper draws small tilts only; at (20, 20, 20) the cone still costs a third at 50 degrees."""
    ratio = [volume(scan(device(cone, 80.0), (20, 20, 20), 6.0), 6.0) for cone in (50, 80)]
    assert ratio[1] > 0.0
    assert ratio[0] / ratio[1] == pytest.approx(0.662, abs=0.05)


def _section(hit, z):
    """Largest radius of the section at a height for 360 azimuths, by a fine scan from outside [mm]."""
    azimuth = np.arange(360) * DEG
    radii = np.arange(0.0, 300.0, 2.0)
    poses = np.zeros((len(azimuth) * len(radii), 6))
    poses[:, 0], poses[:, 1] = np.outer(np.cos(azimuth), radii).ravel(), np.outer(np.sin(azimuth), radii).ravel()
    poses[:, 2] = z
    good = hit.solve_inverse(poses).is_reachable.reshape(len(azimuth), len(radii))
    return np.array([radii[np.flatnonzero(row)[-1]] if row.any() else 0.0 for row in good]), good


@pytest.mark.parametrize("z", [270.0, 300.0, 320.0])
def test_upper_sections_are_circular(z):
    outline, _ = _section(device(), z)
    assert outline.min() > 50.0
    assert outline.max() / outline.min() < 1.06


@pytest.mark.parametrize("z", [140.0, 150.0])
def test_lower_sections_are_stars_of_six_points(z):
    outline, _ = _section(device(), z)
    spectrum = np.abs(np.fft.rfft(outline - outline.mean()))
    assert int(np.argmax(spectrum)) == 6
    assert outline.max() / outline.min() > 1.12


def test_a_low_section_is_multiply_connected():
    """Holes between the scan's rays and the rim, which a single radius per azimuth does not show."""
    _, good = _section(device(), 170.0)
    holes = [row for row in good if row.any() and not row[: np.flatnonzero(row)[-1]].all()]
    assert len(holes) > 10
