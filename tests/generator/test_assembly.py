from dataclasses import replace

import numpy as np
import pytest

from linkwright.designs.design import Design, Workspace
from linkwright.designs.language.bodies import Body, Part, Placement
from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Turned, Vertex
from linkwright.designs.language.mechanism import Mechanism
from linkwright.generator.assembly import build_assembly
from linkwright.generator.store import Store


class Bodies(Mechanism):
    """A mechanism of which only the bodies matter here."""

    name, sections, task = "bodies", {}, ()

    def __init__(self, *bodies):
        self.bodies = bodies

    solve_inverse = solve_forward = compute_jacobian = place_bodies = None
    derived_numbers = controller_parameters = None


def _design(*bodies):
    return Design(name="toy", mechanism=Bodies(*bodies), workspace=Workspace(lower=(), upper=()))


def _body(name, *parts, kind="arm"):
    return Body(name=name, kind=kind, group="", parts=parts)


@pytest.fixture
def arm(rod, bar):
    """A bar with a rod upright in each eye."""
    return (
        Part(name="bar", feature=bar, material="aluminium_6082"),
        Part(name="pin_1", feature=rod, material="steel_c45"),
        Part(name="pin_2", feature=replace(rod), material="steel_c45", at=Placement(origin=(150, 0, 0), z=(0, 0, -1))),
    )


def test_equal_features_are_one_solid_and_bodies_of_a_kind_share_all(arm):
    told = []
    design = _design(_body("one", *arm), _body("two", *arm), _body("base", arm[1], kind="base"))
    assembly = build_assembly(design, progress=lambda *step: told.append(step))
    one, two, base = assembly.bodies
    assert [b.body.name for b in assembly.bodies] == ["one", "two", "base"]
    assert one.parts is two.parts
    assert one.inertia is two.inertia
    assert one.parts[1].solid is one.parts[2].solid is base.parts[0].solid
    assert told == [(0, 2, "arm: bar"), (1, 2, "arm: pin_1"), (2, 2, "")]
    assert assembly.body("two") is two
    assert one.parts[0].solid.mesh.deviation == design.clearance.mesh_deviation


def test_a_body_is_the_sum_of_its_placed_parts(arm):
    (body,) = build_assembly(_design(_body("one", *arm)), deviation=0.1).bodies
    bar, pin_1, pin_2 = body.parts
    rod_mass, bar_mass = pin_1.solid.volume * 7850e-9, bar.solid.volume * 2700e-9
    assert body.mass == pytest.approx(bar_mass + 2 * rod_mass, rel=1e-12)
    z = (bar_mass * bar.solid.centre[2] + rod_mass * 5 - rod_mass * 5) / body.mass
    assert body.centre == pytest.approx([75, 0, z], abs=1e-6)
    assert pin_2.T_body_part[:3, 3] == pytest.approx([150, 0, 0])
    assert pin_2.T_body_part[:3, 2] == pytest.approx([0, 0, -1])
    assert np.allclose(body.inertia, body.inertia.T)
    # Long along x: turning about y or z is harder by far.
    assert body.inertia[1, 1] > 20 * body.inertia[0, 0]
    assert body.parts[0].solid.mesh.deviation == 0.1


def test_an_assembly_from_the_store_equals_the_built_one(arm, tmp_path):
    design = _design(_body("one", *arm))
    (cold,) = build_assembly(design, store=Store(tmp_path)).bodies
    (warm,) = build_assembly(design, store=Store(tmp_path)).bodies
    assert (cold.mass, cold.centre.tolist(), cold.inertia.tolist()) == (
        warm.mass,
        warm.centre.tolist(),
        warm.inertia.tolist(),
    )
    assert [p.solid.key for p in cold.parts] == [p.solid.key for p in warm.parts]


def test_a_massless_purchased_part_adds_a_shape_and_no_mass(arm):
    shaft = replace(arm[1], name="shaft", purchased="motor (shaft)", mass=0.0)
    (bare,) = build_assembly(_design(_body("one", *arm))).bodies
    (more,) = build_assembly(_design(_body("one", *arm, shaft))).bodies
    assert len(more.parts) == 4
    assert more.mass == pytest.approx(bare.mass, rel=1e-15)
    assert more.inertia == pytest.approx(bare.inertia, rel=1e-12)


def test_a_part_that_cannot_be_made_is_named_with_design_kind_and_part(arm):
    bad = Turned(profile=(Vertex(r=0, z=0), Vertex(r=5, z=0), Vertex(r=5, z=-10), Vertex(r=0, z=-10)))
    with pytest.raises(BuildError, match=r"^toy: arm: pin_2: the profile's corners run clockwise"):
        build_assembly(_design(_body("one", *arm[:2], replace(arm[2], feature=bad))))


@pytest.mark.parametrize(("bodies", "says"), [
    (lambda arm: (), "toy: the mechanism has no bodies"),
    (lambda arm: (_body("one", *arm), _body("two")), "toy: two: the body has no parts"),
    (lambda arm: (_body("one", *arm), _body("one", *arm)), "toy: one: two bodies have this name"),
    (lambda arm: (_body("one", *arm), _body("two", *arm[:2])), "toy: two: its parts differ from those of one"),
    (lambda arm: (_body("one", arm[0], arm[0]),), "toy: one: several of its parts are called bar"),
    (lambda arm: (_body("one", replace(arm[0], at=Placement(z=(1, 0, 0)))),), "toy: arm: bar: its place has z along"),
    (lambda arm: (_body("one", replace(arm[0], mass=0.0)),), "toy: arm: has a mass of 0 kg"),
])  # fmt: skip
def test_bodies_that_contradict_themselves_are_refused(arm, bodies, says):
    with pytest.raises(BuildError, match=says):
        build_assembly(_design(*bodies(arm)), deviation=0.5)


def test_a_mechanism_without_parts_is_refused_by_name(arm):
    with pytest.raises(BuildError, match=r"^toy: .* has kinematics but no parts yet"):
        build_assembly(_design(_body("one"), _body("two")))
