"""The tables of purchased parts: standards' numbers, and tables that must be refused."""

from __future__ import annotations

import csv
import math
from importlib.resources import files
from itertools import pairwise

import pytest

from linkwright.designs.language import supplies
from linkwright.designs.language.errors import DesignFileError, ParameterError, UnknownNameError
from linkwright.designs.language.materials import material
from linkwright.designs.language.supplies import Bearing, Screw, ScrewKind
from linkwright.designs.language.tables import read_table

TABLES = ("bearings", "screws", "clips", "shims", "motors")
BEARINGS = [supplies.bearing(name) for name in supplies.names("bearings")]
SCREWS = [supplies.screw(name) for name in supplies.names("screws")]
CLIPS = [supplies.clip(name) for name in supplies.names("clips")]
MOTORS = [supplies.motor(name) for name in supplies.names("motors")]

#: ISO 15: bore, outside diameter, width [mm].
ISO_15 = {
    "623ZZ": (3, 10, 4),
    "MR104ZZ": (4, 10, 4),
    "684ZZ": (4, 9, 4),
    "694ZZ": (4, 11, 4),
    "624ZZ": (4, 13, 5),
    "MR105ZZ": (5, 10, 4),
    "625ZZ": (5, 16, 5),
    "MR126ZZ": (6, 12, 4),
    "626ZZ": (6, 19, 6),
    "688ZZ": (8, 16, 5),
    "608ZZ": (8, 22, 7),
    "6000ZZ": (10, 26, 8),
}
#: ISO 4762: head diameter, head height, across flats, pitch [mm].
ISO_4762 = {
    "M2": (3.8, 2, 1.5, 0.4),
    "M2.5": (4.5, 2.5, 2, 0.45),
    "M3": (5.5, 3, 2.5, 0.5),
    "M4": (7, 4, 3, 0.7),
    "M5": (8.5, 5, 4, 0.8),
    "M6": (10, 6, 5, 1),
}
#: ISO 10642: theoretical head diameter, head height, across flats [mm].
ISO_10642 = {"M3": (6.72, 1.86, 2), "M4": (8.96, 2.48, 2.5), "M5": (11.2, 3.1, 3), "M6": (13.44, 3.72, 4)}
#: DIN 6799: smallest and largest shaft, thickness [mm].
DIN_6799 = {
    "1.9": (2.5, 3, 0.5),
    "2.3": (3, 4, 0.6),
    "3.2": (4, 5, 0.6),
    "4": (5, 7, 0.7),
    "5": (6, 8, 0.7),
    "6": (7, 9, 0.7),
}


@pytest.mark.parametrize(("name", "dimensions"), ISO_15.items())
def test_a_bearing_has_the_boundary_dimensions_of_iso_15(name: str, dimensions: tuple[float, ...]) -> None:
    row = supplies.bearing(name)
    assert (row.bore, row.outer, row.width) == dimensions


@pytest.mark.parametrize(("thread", "dimensions"), ISO_4762.items())
def test_a_cap_screw_has_the_dimensions_of_iso_4762(thread: str, dimensions: tuple[float, ...]) -> None:
    row = supplies.screw(f"ISO4762-{thread}")
    assert row.kind is ScrewKind.CAP and row.thread == thread and row.countersink_diameter == 0.0
    assert (row.head_diameter, row.head_height, row.socket, row.pitch) == dimensions


@pytest.mark.parametrize(("thread", "dimensions"), ISO_10642.items())
def test_a_countersunk_screw_has_the_dimensions_of_iso_10642(thread: str, dimensions: tuple[float, ...]) -> None:
    row = supplies.screw(f"ISO10642-{thread}")
    assert row.kind is ScrewKind.COUNTERSUNK and row.thread == thread
    assert (row.countersink_diameter, row.head_height, row.socket) == dimensions


@pytest.mark.parametrize(("size", "dimensions"), DIN_6799.items())
def test_a_clip_has_the_dimensions_of_din_6799(size: str, dimensions: tuple[float, ...]) -> None:
    row = supplies.clip(f"DIN6799-{size}")
    assert row.groove_diameter == float(size)
    assert (row.shaft_min, row.shaft_max, row.thickness) == dimensions


def test_the_flat_motor_has_the_published_numbers_in_inside_units() -> None:
    row = supplies.motor("maxon-EC45flat-70W")
    assert (row.body_diameter, row.nominal_torque, row.stall_torque) == (42.8, 128.0, 1460.0)
    assert row.mass == pytest.approx(0.141, rel=1e-12)
    assert (row.mount_screw, row.n_mount) == ("M3", 4)


@pytest.mark.parametrize("row", BEARINGS, ids=lambda row: row.name)
def test_a_bearing_weighs_between_half_and_all_of_a_full_ring(row: Bearing) -> None:
    ring = math.pi / 4.0 * (row.outer**2 - row.bore**2) * row.width * material("steel_100cr6").density
    assert 0.5 * ring < row.mass < ring


@pytest.mark.parametrize("row", BEARINGS, ids=lambda row: row.name)
def test_a_sleeve_of_the_largest_shoulder_stays_clear_of_the_outer_ring(row: Bearing) -> None:
    assert row.shaft_shoulder_max < row.outer_land
    assert row.housing_shoulder_max > row.inner_land


@pytest.mark.parametrize("row", SCREWS, ids=lambda row: row.name)
def test_a_cone_of_90_degrees_leads_from_the_countersink_to_the_shank(row: Screw) -> None:
    if row.kind is ScrewKind.COUNTERSUNK:
        assert row.head_height == pytest.approx((row.countersink_diameter - row.diameter) / 2.0, abs=1e-9)
        assert row.diameter < row.head_diameter < row.countersink_diameter
    else:
        assert row.head_height == row.diameter


@pytest.mark.parametrize("row", SCREWS, ids=lambda row: row.name)
def test_a_hexagon_socket_fits_into_its_head_and_a_tap_drill_leaves_a_thread(row: Screw) -> None:
    assert 2.0 * row.socket / math.sqrt(3.0) < row.head_diameter - 0.5
    assert row.tap_drill == pytest.approx(row.diameter - row.pitch, abs=0.06)


@pytest.mark.parametrize("standard", ["ISO4762", "ISO10642"])
def test_the_sizes_of_a_standard_grow_in_every_dimension(standard: str) -> None:
    rows = [row for row in SCREWS if row.name.startswith(standard)]
    assert len(rows) >= 5
    for field in ("diameter", "pitch", "head_diameter", "head_height", "socket", "clearance_hole", "thread_length"):
        assert all(getattr(a, field) < getattr(b, field) for a, b in pairwise(rows)), field


def test_the_clips_grow_and_every_shaft_from_2_to_14_mm_has_one() -> None:
    assert all(a.groove_diameter < b.groove_diameter and a.outer < b.outer for a, b in pairwise(CLIPS))
    for shaft in [2.0 + 0.5 * k for k in range(25)]:
        assert any(row.shaft_min <= shaft <= row.shaft_max for row in CLIPS), shaft


def test_a_clip_weighs_about_half_of_the_closed_ring_that_stands_for_it() -> None:
    for row in CLIPS:
        ring = math.pi / 4.0 * (row.outer**2 - row.groove_diameter**2) * row.thickness * material("steel_c45").density
        assert 0.45 * ring < row.mass < 0.75 * ring, row.name


def test_a_motor_weighs_as_much_as_a_solid_of_motor_density_within_a_factor_of_two() -> None:
    for row in MOTORS:
        can = math.pi / 4.0 * row.body_diameter**2 * row.body_length * material("copper_motor").density
        assert 0.5 < row.mass / can < 2.0, row.name


def test_a_screw_weighs_more_the_longer_it_is_and_an_m6x20_about_seven_grams() -> None:
    for row in SCREWS:
        masses = [row.mass_of(length) for length in row.lengths]
        assert all(0.0 < a < b for a, b in pairwise(masses)), row.name
    assert supplies.screw("ISO4762-M6").mass_of(20.0) == pytest.approx(7.0e-3, rel=0.15)


def test_the_screw_to_buy_is_the_shortest_that_reaches() -> None:
    row = supplies.screw("ISO4762-M4")
    assert row.length_for(12.0) == 12.0
    assert row.length_for(12.1) == 16.0
    assert row.designation(16.0) == "ISO4762-M4x16"
    with pytest.raises(ParameterError, match="at most 40 mm"):
        row.length_for(41.0)
    with pytest.raises(ParameterError, match="16, 20"):
        row.designation(17.0)


def test_a_shim_is_bought_in_a_thickness_that_is_sold() -> None:
    row = supplies.shim("DIN988-4x8")
    assert (row.bore, row.outer) == (4.0, 8.0)
    assert row.designation(0.2) == "DIN988-4x8x0.2"
    with pytest.raises(ParameterError, match=r"0\.1, 0\.2"):
        row.designation(0.25)


@pytest.mark.parametrize(
    ("read", "kind"),
    [
        (supplies.bearing, "bearing"),
        (supplies.screw, "screw"),
        (supplies.clip, "clip"),
        (supplies.shim, "shim"),
        (supplies.motor, "motor"),
    ],
)
def test_an_unknown_name_lists_the_known_ones(read, kind: str) -> None:
    with pytest.raises(UnknownNameError) as caught:
        read("no-such-thing")
    assert caught.value.kind == kind
    assert caught.value.known == supplies.names(f"{kind}s") != ()


def test_an_unknown_table_lists_the_tables() -> None:
    with pytest.raises(UnknownNameError, match="bearings, screws, clips, shims, motors"):
        supplies.names("bolts")


@pytest.mark.parametrize("table", TABLES)
def test_every_row_says_where_its_numbers_are_from(table: str) -> None:
    lines = files("linkwright.designs.supplies").joinpath(f"{table}.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(lines))
    assert [row["name"] for row in rows] == list(supplies.names(table))
    assert all(len(row["source"]) > 5 for row in rows)


SHIMS = "name,bore_mm,outer_mm,thicknesses_mm,source\n"


@pytest.mark.parametrize(
    ("text", "key", "line", "message"),
    [
        (SHIMS + "a,8,4,0.1,x", "bore", 2, "must not exceed outer = 4"),
        (SHIMS + "a,0,4,0.1,x", "bore", 2, "above 0"),
        (SHIMS + "a,nan,4,0.1,x", "bore", 2, "above 0"),
        (SHIMS + "a,inf,4,0.1,x", "bore", 2, "above 0"),
        (SHIMS + "a,two,4,0.1,x", "bore", 2, "two"),
        (SHIMS + "a,2,4,0.2 0.1,x", "thicknesses", 2, "grow"),
        (SHIMS + "a,2,4,,x", "thicknesses", 2, "grow"),
        (SHIMS + "a,2,4", "thicknesses", 2, "ends before"),
        (SHIMS + "a,2,4,0.1,x,y", "row", 2, "more cells"),
        (SHIMS + "a,2,4,0.1,x\na,2,5,0.1,x", "name", 3, "twice"),
        (SHIMS.replace("bore_mm", "bore") + "a,2,4,0.1,x", "bore", 2, "must name its unit"),
        (SHIMS.replace("bore_mm", "hole_mm") + "a,2,4,0.1,x", "bore", 1, "missing"),
        (SHIMS.replace("source", "source,colour") + "a,2,4,0.1,x,red", "colour", 1, "no column"),
    ],
)
def test_a_bad_table_is_refused_with_its_line_and_column(text: str, key: str, line: int, message: str) -> None:
    with pytest.raises(DesignFileError) as caught:
        read_table("shims.csv", text.splitlines(), supplies.Shim)
    assert (caught.value.path, caught.value.line, caught.value.key) == ("shims.csv", line, key)
    assert message in str(caught.value)


def test_a_good_table_of_the_same_columns_is_taken() -> None:
    rows = read_table("shims.csv", (SHIMS + "a,2,4,0.1 0.2,x").splitlines(), supplies.Shim)
    assert rows["a"].thicknesses == (0.1, 0.2)
