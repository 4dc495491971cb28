"""The table of materials: what others rely on, and tables that must be refused."""

from __future__ import annotations

import pytest

from linkwright.designs.language.errors import ParameterError, UnknownNameError
from linkwright.designs.language.materials import material, material_names, read_materials

PROMISED = [
    "aluminium_6082",
    "steel_100cr6",
    "steel_c45",
    "stainless_1_4301",
    "brass",
    "bronze_cusn8",
    "pom",
    "abs",
    "copper_motor",
]
HEAD = "name,density_kg_m3,red,green,blue,source"


def test_steel_is_heavier_than_aluminium_and_that_than_plastic():
    steel, aluminium, pom = (material(name) for name in ("steel_c45", "aluminium_6082", "pom"))
    assert steel.density_kg_m3 == 7850
    assert steel.density == pytest.approx(7.85e-6)
    assert steel.density > aluminium.density > pom.density


@pytest.mark.parametrize("name", PROMISED)
def test_every_promised_material_is_there_with_colour_and_source(name):
    row = material(name)
    assert row.name == name
    assert len(row.colour) == 3
    assert row.source


def test_an_unknown_material_is_answered_with_those_that_exist():
    with pytest.raises(UnknownNameError, match="unobtainium") as caught:
        material("unobtainium")
    assert caught.value.known == material_names()


@pytest.mark.parametrize("rows", [
    ["lead,-1,0.5,0.5,0.5,x"],
    ["lead,0,0.5,0.5,0.5,x"],
    ["lead,nan,0.5,0.5,0.5,x"],
    ["lead,11340,0.5,1.5,0.5,x"],
    ["lead,11340,0.5,0.5,0.5,x", "lead,11340,0.5,0.5,0.5,x"],
])  # fmt: skip
def test_a_spoilt_table_is_refused(rows):
    assert read_materials([HEAD, "lead,11340,0.5,0.5,0.5,x"])["lead"].density_kg_m3 == 11340
    with pytest.raises(ParameterError, match=r"materials\.lead"):
        read_materials([HEAD, *rows])
