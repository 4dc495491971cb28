from __future__ import annotations

from types import SimpleNamespace

from linkwright.designs.language.bodies import Body, Part
from linkwright.designs.language.features import Turned
from linkwright.exports.products import products_of, slug


def placed(body, kind, *parts):
    made = tuple(
        SimpleNamespace(
            solid=SimpleNamespace(key=key),
            part=Part(name=name, feature=Turned(profile=()), material=material, purchased=purchased),
        )
        for name, key, material, purchased in parts
    )
    return SimpleNamespace(body=Body(name=body, kind=kind, group="", parts=()), parts=made)


def names_of(*bodies):
    return [p.name for p in products_of(SimpleNamespace(bodies=bodies)).values()]


def test_products_share_equal_solids_of_one_material(assembly):
    products = products_of(assembly)
    count = {p.name: len(p.uses) for p in products.values()}
    assert count == {"base_plate": 1, "base_pin": 2, "arm_bar": 2, "MR106ZZ": 2, "arm_seat": 2, "rod_ball_bar": 2}


def test_products_of_one_solid_in_two_materials_are_two():
    body = placed("base", "base", ("a", "k", "brass", ""), ("b", "k", "pom", ""))
    assert names_of(body) == ["base_a", "base_b"]


def test_products_used_by_several_kinds_are_named_by_what_the_kinds_share():
    left = placed("left", "lower_left", ("bar", "k", "brass", ""))
    right = placed("right", "lower_right", ("bar", "k", "brass", ""))
    assert names_of(left, right) == ["lower_bar"]


def test_products_that_would_share_a_name_get_longer_ones():
    bodies = (
        placed("a", "lower_left", ("bar", "k", "brass", "")),
        placed("b", "lower_right", ("bar", "k", "brass", "")),
        placed("c", "lower", ("bar", "m", "brass", "")),
    )
    names = names_of(*bodies)
    assert len(set(names)) == 2


def test_products_that_cannot_be_told_apart_by_words_are_numbered():
    one = placed("a", "x", ("bar", "k", "brass", ""), ("bar ", "m", "brass", ""))
    assert names_of(one) == ["x_bar", "x_bar_2"]


def test_purchased_products_are_named_by_their_designation():
    assert names_of(placed("a", "x", ("screw_1", "k", "brass", "ISO 4762 M3x8"))) == ["ISO_4762_M3x8"]


def test_slug_is_safe_in_every_file_system():
    assert slug("M3 x 8/ü..") == "M3_x_8"
    assert slug("...") == "unnamed"


def test_products_say_each_word_once_and_leave_out_what_differs():
    bodies = (
        placed("a", "upper_bar", ("bar", "k", "brass", "")), placed("b", "base", ("base_plate", "m", "brass", "")),
        placed("c", "base", ("leg_1_left_pedestal", "n", "brass", ""), ("leg_2_left_pedestal", "n", "brass", "")),
        placed("d", "base", ("leg_1_right_pedestal", "o", "brass", ""), ("leg_2_right_pedestal", "o", "brass", "")),
    )  # fmt: skip
    assert names_of(*bodies) == ["upper_bar", "base_plate", "base_leg_left_pedestal", "base_leg_right_pedestal"]
