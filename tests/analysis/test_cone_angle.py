"""The cone of the wide ball joint: formula S1 against the solids, and the ways in which it breaks, found on them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from linkwright.analysis.joint_limits import measure_joint_limits
from linkwright.designs.chains.pivot import Lay
from linkwright.designs.chains.spherical_joint import (
    SOCKET_16,
    SOCKET_20,
    SphericalJointDimensions,
    ball_bar,
    cone_half_angle,
    formula_warnings,
    shell_cover,
    socket_parts,
    upper_ring,
)
from linkwright.designs.language.bodies import Part
from linkwright.designs.language.features import Turned
from linkwright.designs.language.joints import JointKind

DEG = math.pi / 180.0

#: Designs in which the rim stops the root: ball, root, rim, face, countersink and land vary, alone and together.
RIM_LIMITED = {
    "the default": SOCKET_16,
    "ball of 20": SOCKET_20,
    "narrow rim": replace(SOCKET_16, rim_diameter=15.2, cover_face=4.4),
    "wide rim": replace(SOCKET_16, rim_diameter=15.8),
    "deep face": replace(SOCKET_16, cover_face=3.9, root_fillet=0.25),
    "high face": replace(SOCKET_16, cover_face=4.6, land=0.9),
    "shallow countersink": replace(SOCKET_16, countersink_depth=0.7, land=0.9),
    "deep countersink": replace(SOCKET_16, countersink_depth=1.2, countersink_angle=124.0 * DEG),
    "thin root": replace(SOCKET_16, root_diameter=2.8, root_fillet=0.3, shoulder_height=15.0),
    "thick root": replace(SOCKET_16, root_diameter=5.0),
    "no root at all": replace(SOCKET_16, root_diameter=8.0, shoulder_chamfer=0.0),
    "flat countersink": replace(SOCKET_16, countersink_angle=126.0 * DEG),
    "ball of 12": replace(
        SOCKET_16,
        ball_diameter=12.0,
        root_diameter=3.0,
        root_fillet=0.3,
        rim_diameter=11.6,
        cover_face=3.2,
        land=0.6,
        countersink_depth=0.8,
        cover_thickness=2.8,
        ring_outer=18.0,
        screw_circle=23.0,
        cover_diameter=30.0,
        stem_diameter=7.0,
        stem_length=21.0,
    ),
}


@pytest.fixture(scope="module")
def measured(assemble):
    """Leans of a joint of these dimensions [deg], measured on its solids, and what stops the least of them."""

    def measure(d: SphericalJointDimensions, n_azimuths: int = 2) -> tuple[list[float], str]:
        bar = Part(name="ball_bar", feature=ball_bar(d), material="steel_100cr6", runs_in_joint=True)
        socket = socket_parts(d, "socket", Lay(), housing="aluminium_6082", seats="bronze_cusn8")
        assembly = assemble(JointKind.SPHERICAL, socket, (bar,), 0.0, 0.5)
        facts = measure_joint_limits(assembly, n_azimuths=n_azimuths).facts
        return facts["cones"]["hinge_0"]["tilts"], facts["limits"]["hinge_0"]["stopped_above_by"]

    return measure


def test_at_least_ten_designs_are_compared():
    assert len(RIM_LIMITED) >= 10
    assert len({round(cone_half_angle(d), 6) for d in RIM_LIMITED.values()}) >= 10


@pytest.mark.parametrize("name", RIM_LIMITED)
def test_the_solids_lean_as_far_as_the_formula_says(measured, name):
    d = RIM_LIMITED[name]
    assert formula_warnings(d) == ()
    tilts, stop = measured(d)
    assert tilts == pytest.approx([math.degrees(cone_half_angle(d))] * len(tilts), abs=0.05)
    assert "cover" in stop and "ball_bar" in stop


def test_the_default_leans_equally_to_all_azimuths(measured):
    tilts, _ = measured(SOCKET_16, 24)
    assert len(tilts) == 24 and max(tilts) - min(tilts) < 0.01
    assert min(tilts) == pytest.approx(55.517, abs=0.01)


def test_a_root_as_thick_as_the_stem_costs_sixteen_degrees():
    assert math.degrees(cone_half_angle(RIM_LIMITED["no root at all"])) == pytest.approx(39.07, abs=0.005)


#: Name -> dimensions, the lean found by revolved distance in the reference calculation [deg], its tolerance.
BREAKS = {
    "plain hole instead of a countersink": (replace(SOCKET_16, countersink_angle=0.0), 50.09, 0.01),
    "countersink too narrow, 30": (replace(SOCKET_16, countersink_angle=60.0 * DEG), 52.42, 0.01),
    "countersink too narrow, 45": (replace(SOCKET_16, countersink_angle=90.0 * DEG), 53.97, 0.01),
    "countersink too narrow, 55": (replace(SOCKET_16, countersink_angle=110.0 * DEG), 55.43, 0.01),
    "shoulder too near, 9": (replace(SOCKET_16, shoulder_height=9.0), 43.3, 0.05),
    "shoulder too near, 10": (replace(SOCKET_16, shoulder_height=10.0), 47.2, 0.05),
    "shoulder too near, 12": (replace(SOCKET_16, shoulder_height=12.0), 53.6, 0.05),
    # The reference drew its fillets as chords, which makes them thicker: 0.15 less than the arc allows.
    "root fillet reaches the rim": (replace(SOCKET_16, root_fillet=2.0, land=0.88), 52.77, 0.2),
    "root fillet reaches the rim, 0.8": (replace(SOCKET_16, root_fillet=0.8), 55.27, 0.02),
}


@pytest.mark.parametrize("name", BREAKS)
def test_a_known_break_of_the_formula_is_found_on_the_solids(measured, name):
    d, reference, tolerance = BREAKS[name]
    tilts, _ = measured(d, 1)
    assert min(tilts) == pytest.approx(reference, abs=tolerance)
    assert min(tilts) == pytest.approx(math.degrees(lean_by_profiles(d)), abs=0.02)
    assert min(tilts) < math.degrees(cone_half_angle(d)) - 0.05
    warnings = {w.name: math.degrees(w.allows) for w in formula_warnings(d)}
    assert name.split(",")[0] in warnings
    assert min(warnings.values()) <= min(tilts) + 0.01


def test_the_edge_of_the_upper_ring_stops_a_thick_fillet_before_the_rim_does(measured):
    d = replace(SOCKET_16, root_fillet=2.0)
    tilts, stop = measured(d)
    warning = min(formula_warnings(d), key=lambda w: w.allows)
    assert warning.name == "edge of the upper ring too high"
    assert min(tilts) == pytest.approx(math.degrees(warning.allows), abs=0.02)
    assert "upper_ring" in stop


def lean_by_profiles(d: SphericalJointDimensions) -> float:
    """A second way [rad]: both bodies are of revolution about lines through one point, so distances from it are kept.

    At each distance the bar takes up an angle about its axis and the socket leaves one about its own; the bar may
    lean by the least difference.
    """
    bar, socket = sample(ball_bar(d)), np.concatenate([sample(shell_cover(d)), sample(upper_ring(d))])
    far = np.hypot(*bar.T)
    bar = bar[(far > d.ball_radius + 1e-7) & (bar[:, 1] > 0.0) & (bar[:, 1] <= d.stem_length)]
    order = np.argsort(np.hypot(*bar.T))
    distance, taken = np.hypot(*bar[order].T), np.arctan2(*bar[order].T)
    left_at = np.hypot(*socket.T)
    inside = (left_at >= distance[0]) & (left_at <= distance[-1])
    return float(np.min(np.arctan2(*socket[inside].T) - np.interp(left_at[inside], distance, taken)))


def sample(turned: Turned, n: int = 20000) -> np.ndarray:
    """Points (r, z) along a turned profile [mm]."""
    points, before = [], turned.profile[-1]
    for vertex in turned.profile:
        a, b = np.array([before.r, before.z]), np.array([vertex.r, vertex.z])
        t = np.linspace(0.0, 1.0, n)[:, None]
        if vertex.mid is None:
            points.append(a + t * (b - a))
        else:
            m = np.array(vertex.mid)
            centre = np.linalg.solve(2.0 * np.array([m - a, b - a]), [m @ m - a @ a, b @ b - a @ a])
            angles = np.unwrap([math.atan2(*(p - centre)[::-1]) for p in (a, m, b)])
            turn = angles[0] + t[:, 0] * (angles[2] - angles[0])
            points.append(centre + np.linalg.norm(a - centre) * np.stack([np.cos(turn), np.sin(turn)], axis=-1))
        before = vertex
    return np.concatenate(points)
