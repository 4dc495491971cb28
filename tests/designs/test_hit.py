"""The HIT device as it is shipped: its workspace, its parts, its layers, and designs that must be refused."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from linkwright.designs import catalogue
from linkwright.designs.chains.spherical_joint import SphericalJointDimensions
from linkwright.designs.hit.mechanism import Hit
from linkwright.designs.hit.parameters import HitFrame, HitLimits, HitParameters
from linkwright.designs.language.errors import ParameterError, UnknownNameError


def test_every_corner_and_face_of_the_declared_workspace_is_reachable(rng):
    design = catalogue.entry("hit").default_design()
    lower, upper = design.box()
    grid = np.array(list(itertools.product(*zip(lower, (lower + upper) / 2.0, upper, strict=True))))
    poses = np.concatenate([grid, rng.uniform(lower, upper, (20000, 6))])
    inverse = design.mechanism.solve_inverse(poses)
    assert inverse.is_reachable.all(), [inverse.reason(i) for i in np.flatnonzero(~inverse.is_reachable)[:3]]


def test_a_larger_box_is_not_all_reachable_so_that_the_check_can_fail():
    design = catalogue.entry("hit").default_design()
    upper = design.box()[1]
    corner = np.where(np.arange(6) < 3, upper + 60.0, upper)
    assert not design.mechanism.solve_inverse(corner[None]).is_reachable[0]


def test_each_sub_chain_has_nine_links_and_eleven_pins_besides_the_base_pin():
    mechanism = catalogue.entry("hit").default_design().mechanism
    for leg in ("leg_1", "leg_2", "leg_3"):
        assert sum(body.group == leg for body in mechanism.bodies) == 9
        assert sum(j.name.startswith(leg) and j.kind == "revolute" for j in mechanism.joints) == 12
    assert [j.name for j in mechanism.joints[:6]] == [f"leg_{i}_theta_{k}" for i in (1, 2, 3) for k in (1, 2)]


def test_parts_have_unique_names_and_every_made_part_says_how_it_is_held():
    for body in catalogue.entry("hit").default_design().mechanism.bodies:
        names = [part.name for part in body.parts]
        assert len(set(names)) == len(names), body.name
        for part in body.parts:
            assert (
                part.purchased
                or part.fit
                or part is body.parts[0]
                or part.name.startswith(("side_plate", "bar", "plate"))
            ), part.name


def test_links_of_the_three_legs_are_the_same_parts():
    bodies = catalogue.entry("hit").default_design().mechanism.bodies
    by_kind = {}
    for body in bodies:
        by_kind.setdefault(body.kind, []).append(body.parts)
    assert all(parts == group[0] for group in by_kind.values() for parts in group)
    assert len(by_kind["upper_bar"]) == 6


@pytest.mark.parametrize(
    ("section", "key"),
    [
        ({"parameters": HitParameters(base_radius=-70.0)}, "parameters.base_radius_mm"),
        ({"parameters": HitParameters(lower_link_length=float("nan"))}, "parameters.lower_link_length_mm"),
        ({"joint_limits": HitLimits(theta_1_min=3.2)}, "joint_limits.theta_1_max_deg"),
        ({"parts.frame": HitFrame(plate_gap=0.0)}, "parts.frame.plate_gap_mm"),
    ],
)
def test_impossible_numbers_are_refused_with_the_key_of_the_design_file(section, key):
    with pytest.raises(ParameterError, match=key.replace(".", r"\.")):
        Hit(section)


def test_an_unknown_branch_is_refused_with_the_known_ones():
    hit = Hit({})
    with pytest.raises(UnknownNameError, match="up-out"):
        hit.solve_inverse(hit.home[None], "sideways")


@pytest.mark.parametrize("name", catalogue.names())
def test_the_shipped_example_is_the_commented_default_design(name):
    from importlib.resources import files

    from linkwright.designs.file.reader import read_design
    from linkwright.designs.file.writer import example_of

    shipped = files("linkwright.designs").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8")
    assert shipped == example_of(name), f"renew it: linkwright new {name} -o designs/examples/{name}.toml --force"
    assert read_design(shipped).hash == catalogue.entry(name).default_design().hash


def test_the_stem_of_the_ball_bar_follows_the_ball_and_a_wrong_one_is_refused():
    hit = Hit({"parameters": HitParameters(ball_height=32.0)})
    assert hit.sections["parts.spherical_joint"].stem_length == 24.0
    with pytest.raises(ParameterError, match=r"stem_length_mm = 25.*must be 22"):
        Hit({"parts.spherical_joint": SphericalJointDimensions(stem_length=25.0)})
