"""The JSON Schema says what the reader says."""

from __future__ import annotations

import tomllib

import jsonschema
import pytest

from linkwright.designs.file.model import combined_schema, json_schema
from linkwright.designs.file.reader import read_design
from linkwright.designs.file.writer import example_of
from linkwright.designs.language.errors import DesignFileError

RIGHT = [
    "[parameters]\nfore_mm = 90",
    '[supplies]\nbearing = "623"',
    "[parts.bars]\ntilt_deg = -90",
    '[[allowed]]\npair = ["base", "fore"]\nreason = "x"',
    "[workspace]\nx_min_mm = 1",
]
WRONG = [
    "[parameters]\nfore_mm = -1",
    "[parameters]\nfore_mm = 501",
    "[parameters]\nq = 1",
    '[parameters]\nfore_mm = "9"',
    '[supplies]\nbearing = "1"',
    "[parts.bars]\nn_screws = 0",
    "[parts.bars]\nn_screws = 1.5",
    "[parts.x]\nq = 1",
    '[[allowed]]\npair = ["base"]\nreason = "x"',
    '[[allowed]]\npair = ["base", "fore"]',
    'name = "a b"',
    "[parts.bars]\nis_hollow = 1",
    "[parts.bars]\ntilt_deg = 91",
]


@pytest.fixture(params=["own", "combined"])
def validator(request, arm):
    schema = json_schema(arm) if request.param == "own" else combined_schema([arm])
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("text", RIGHT)
def test_schema_and_reader_take_the_same(validator, arm, text):
    text = f'mechanism = "arm"\n{text}\n'
    assert validator.is_valid(tomllib.loads(text))
    read_design(text, find_entry=lambda name: arm)


@pytest.mark.parametrize("text", WRONG)
def test_schema_and_reader_refuse_the_same(validator, arm, text):
    text = f'mechanism = "arm"\n{text}\n'
    assert not validator.is_valid(tomllib.loads(text))
    with pytest.raises(DesignFileError):
        read_design(text, find_entry=lambda name: arm)


def test_schema_refuses_another_mechanism(validator):
    assert not validator.is_valid({"mechanism": "robot"})
    assert not validator.is_valid({})


def test_schema_carries_units_bounds_and_defaults_of_the_file(arm):
    schema = json_schema(arm)
    parameters = schema["$defs"]["ArmParameters"]["properties"]
    assert parameters["fore_mm"]["exclusiveMinimum"] == 0.0
    assert parameters["fore_mm"]["maximum"] == 500.0
    assert parameters["upper_mm"]["description"] == "l_1: shoulder to elbow [mm]"
    assert schema["$defs"]["ArmPartsBars"]["properties"]["tilt_deg"]["maximum"] == 90.0


def test_every_example_of_the_catalogue_fits_its_schema(each_design):
    from linkwright.designs import catalogue

    name = each_design.mechanism.name
    table = tomllib.loads(example_of(name))
    jsonschema.validate(table, json_schema(catalogue.entry(name)))
    jsonschema.validate(table, combined_schema(catalogue.entry(n) for n in catalogue.names()))
