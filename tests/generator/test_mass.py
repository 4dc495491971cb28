import math

import numpy as np
import pytest
import trimesh

from linkwright.designs.language.bodies import Part
from linkwright.designs.language.errors import BuildError, UnknownNameError
from linkwright.designs.language.poses import frame
from linkwright.generator.mass import MassProperties, check_physical, compose_masses, compute_part_mass, move_mass
from linkwright.generator.solids import build_solid


def test_a_steel_rod_weighs_what_the_textbook_says(rod):
    solid = build_solid(rod, 0.05, where="rod")
    mass = compute_part_mass(Part(name="rod", feature=rod, material="steel_c45"), solid, "rod")
    m = math.pi * 25 * 10 * 7850e-9
    assert mass.mass == pytest.approx(m, rel=1e-12)
    assert mass.centre == pytest.approx([0, 0, 5], abs=1e-9)
    assert mass.inertia == pytest.approx(np.diag([m * 175 / 12] * 2 + [m * 12.5]), rel=1e-9, abs=1e-15)


def test_a_catalogue_mass_scales_the_inertia_and_leaves_the_centre(rod):
    solid = build_solid(rod, 0.05, where="rod")
    made = compute_part_mass(Part(name="rod", feature=rod, material="pom"), solid, "rod")
    bought = compute_part_mass(Part(name="rod", feature=rod, material="pom", mass=0.25), solid, "rod")
    assert bought.mass == pytest.approx(0.25, rel=1e-15)
    assert bought.inertia == pytest.approx(made.inertia * 0.25 / made.mass, rel=1e-12)
    assert np.array_equal(bought.centre, made.centre)


@pytest.mark.parametrize("name", ["rod", "ball_with_neck", "bar", "plate"])
def test_mass_properties_agree_with_those_of_the_mesh(features, name):
    solid = build_solid(features[name], 0.01, where=name)
    mesh = trimesh.Trimesh(solid.mesh.vertices, solid.mesh.triangles, process=False)
    assert mesh.is_volume
    assert solid.volume == pytest.approx(mesh.volume, rel=4e-3)
    assert solid.area == pytest.approx(mesh.area, rel=4e-3)
    assert solid.centre == pytest.approx(mesh.center_mass, abs=2e-2)
    scale = np.max(np.abs(solid.inertia))
    assert solid.inertia == pytest.approx(mesh.moment_inertia, rel=4e-3, abs=4e-3 * scale)
    assert solid.lower == pytest.approx(mesh.bounds[0], abs=2e-2)
    assert solid.upper == pytest.approx(mesh.bounds[1], abs=2e-2)


def test_a_body_of_turned_parts_equals_the_joined_mesh(features, rng):
    joined, several = [], []
    for name in ("rod", "bar", "ball_with_neck"):
        solid = build_solid(features[name], 0.005, where=name)
        T = frame(tuple(rng.uniform(-80, 80, 3)), tuple(rng.normal(size=3)), tuple(rng.normal(size=3)))
        own = MassProperties(mass=solid.volume, centre=solid.centre, inertia=solid.inertia)
        several.append(move_mass(own, T))
        joined.append(trimesh.Trimesh(solid.mesh.vertices, solid.mesh.triangles, process=False).apply_transform(T))
    whole, mesh = compose_masses(several, "body"), trimesh.util.concatenate(joined)
    assert whole.mass == pytest.approx(mesh.volume, rel=4e-3)
    assert whole.centre == pytest.approx(mesh.center_mass, abs=0.05)
    assert whole.inertia == pytest.approx(mesh.moment_inertia, abs=2e-3 * np.max(np.abs(whole.inertia)))


def test_two_halves_of_a_rod_make_the_whole_rod(rod):
    m = 3.0
    half = np.diag([m / 2 * (75 + 25) / 12] * 2 + [m / 2 * 12.5])
    halves = [MassProperties(mass=m / 2, centre=np.array([0, 0, z]), inertia=half) for z in (2.5, 7.5)]
    whole = compose_masses(halves, "rod")
    assert whole.centre == pytest.approx([0, 0, 5])
    assert whole.inertia == pytest.approx(np.diag([m * 175 / 12] * 2 + [m * 12.5]), rel=1e-14)


@pytest.mark.parametrize(("mass", "moments", "says"), [
    (0.0, (1, 1, 1), "mass of 0 kg"),
    (math.nan, (1, 1, 1), "mass of nan kg"),
    (1.0, (0, 1, 1), "must be positive"),
    (1.0, (-1, 1, 1), "must be positive"),
    (1.0, (1, 1, 2.1), "sum of the other two"),
])  # fmt: skip
def test_an_unreal_mass_is_refused(mass, moments, says):
    R = frame((0, 0, 0), (1, 2, 3), (3, 1, 0))[:3, :3]
    properties = MassProperties(mass=mass, centre=np.zeros(3), inertia=R @ np.diag(moments) @ R.T)
    with pytest.raises(BuildError, match=f"hit: rod: .*{says}"):
        check_physical(properties, "hit: rod")


def test_parts_without_any_mass_have_no_centre_and_are_refused():
    nothing = MassProperties(mass=0.0, centre=np.zeros(3), inertia=np.zeros((3, 3)))
    with pytest.raises(BuildError, match="hit: rod: has a mass of 0 kg"):
        compose_masses([nothing, nothing], "hit: rod")


def test_a_thin_disc_is_real_and_passes():
    check_physical(MassProperties(mass=1.0, centre=np.zeros(3), inertia=np.diag([1.0, 1.0, 2.0])), "disc")


def test_an_unknown_material_and_a_negative_catalogue_mass_are_refused(rod):
    solid = build_solid(rod, 0.05, where="rod")
    with pytest.raises(UnknownNameError, match="unobtainium"):
        compute_part_mass(Part(name="rod", feature=rod, material="unobtainium"), solid, "rod")
    with pytest.raises(BuildError, match=r"catalogue mass of -0.1 kg"):
        compute_part_mass(Part(name="rod", feature=rod, material="pom", mass=-0.1), solid, "rod")
