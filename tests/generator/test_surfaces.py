import math

import pytest

from linkwright.generator.surfaces import Surface, SurfaceKind, is_revolved_about, is_sphere_at

POINT, AXIS = (1.0, 2.0, 3.0), (0.0, 0.6, 0.8)
TILTED = math.asin(0.6) + 2e-6


def _on_axis(t):
    return tuple(p + t * a for p, a in zip(POINT, AXIS, strict=True))


@pytest.mark.parametrize("kind", [SurfaceKind.CYLINDER, SurfaceKind.CONE, SurfaceKind.TORUS])
@pytest.mark.parametrize("sign", [1.0, -2.5])
def test_a_coaxial_surface_is_revolved_about_the_axis_whatever_its_direction(kind, sign):
    surface = Surface(kind=kind, point=_on_axis(7.0), axis=AXIS, radius=4.0)
    assert is_revolved_about(surface, POINT, tuple(sign * a for a in AXIS))


@pytest.mark.parametrize("kind", [SurfaceKind.CYLINDER, SurfaceKind.CONE, SurfaceKind.TORUS])
def test_a_shifted_or_tilted_surface_is_not(kind):
    shifted = Surface(kind=kind, point=(1.0 + 2e-6, 2.0, 3.0), axis=AXIS, radius=4.0)
    tilted = Surface(kind=kind, point=POINT, axis=(0.0, math.sin(TILTED), math.cos(TILTED)), radius=4.0)
    assert not is_revolved_about(shifted, POINT, AXIS)
    assert is_revolved_about(shifted, POINT, AXIS, tol=1e-5)
    assert not is_revolved_about(tilted, POINT, AXIS)


def test_a_plane_across_the_axis_is_one_of_revolution_wherever_its_point_lies():
    assert is_revolved_about(Surface(kind=SurfaceKind.PLANE, point=(9, 9, 9), axis=AXIS, radius=0), POINT, AXIS)
    assert not is_revolved_about(Surface(kind=SurfaceKind.PLANE, point=POINT, axis=(1, 0, 0), radius=0), POINT, AXIS)


def test_a_sphere_counts_if_its_centre_is_on_the_line():
    sphere = Surface(kind=SurfaceKind.SPHERE, point=_on_axis(-5.0), axis=(0, 0, 1), radius=3)
    assert is_revolved_about(sphere, POINT, AXIS)
    assert not is_revolved_about(sphere, (0, 0, 0), AXIS)
    assert is_sphere_at(sphere, _on_axis(-5.0))
    assert not is_sphere_at(sphere, POINT)
    assert not is_sphere_at(Surface(kind=SurfaceKind.TORUS, point=POINT, axis=AXIS, radius=3), POINT)


def test_an_unknown_surface_is_never_one_of_revolution():
    assert not is_revolved_about(Surface(kind=SurfaceKind.OTHER, point=POINT, axis=AXIS, radius=0), POINT, AXIS)
