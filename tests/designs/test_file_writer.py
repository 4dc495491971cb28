"""What is written reads back as the same design, and says beside each number what it is."""

from __future__ import annotations

import itertools
import tomllib

import pytest

from linkwright.designs.file.keys import keys_of
from linkwright.designs.file.reader import read_design
from linkwright.designs.file.writer import WIDTH, example_of, text_of


@pytest.fixture
def read(arm):
    return lambda text, overrides=(): read_design(text, overrides, find_entry=lambda name: arm)


def test_the_example_is_the_default_design(read, arm):
    assert read(example_of("arm", entry=arm)).hash == arm.default_design().hash


def test_the_example_names_every_key_of_the_mechanism(read, arm):
    design = read(example_of("arm", entry=arm))
    assert set(keys_of(arm)) <= set(design.lines)


def test_a_resolved_design_reads_back_with_its_hash_and_is_stable(read, arm, rng):
    for _ in range(50):
        upper, fore, tilt = rng.uniform(1.0, 400.0), rng.uniform(1.0, 400.0), rng.uniform(-89.0, 89.0)
        numbers = {"parameters.upper_mm": upper, "parameters.fore_mm": fore, "parts.bars.tilt_deg": tilt}
        design = read(
            'mechanism = "arm"\n[[allowed]]\npair = ["base", "fore"]\nreason = "a \\"tight\\" fit\\n#1"\n',
            [f"{key}={value!r}" for key, value in numbers.items()],
        )
        text = text_of(design, entry=arm)
        again = read(text)
        assert again.hash == design.hash
        assert again.allowed == design.allowed
        assert text_of(again, entry=arm) == text


def test_no_line_is_wider_than_the_page(read, arm):
    assert max(map(len, example_of("arm", entry=arm).splitlines())) <= WIDTH


def test_comments_carry_unit_letter_bounds_and_meaning(arm):
    text = example_of("arm", entry=arm)
    assert "upper_mm = 100.0  # [l_1, mm, > 0] shoulder to elbow" in text
    assert "# bearing, spare: one of 623, 688ZZ, MR104ZZ, MR105ZZ" in text
    assert "n_screws = 4                 # [1 to 12] screws per joint" in text


def test_a_changed_value_says_its_default(read, arm):
    text = text_of(read('mechanism = "arm"\n[parameters]\nupper_mm = 70\n'), entry=arm)
    assert "upper_mm = 70.0  # [l_1, mm, > 0] shoulder to elbow (default 100.0)" in text


def test_one_blank_line_stands_before_each_table(arm):
    lines = example_of("arm", entry=arm).splitlines()
    assert "" in lines
    assert all(a or b for a, b in itertools.pairwise(lines))


def test_the_shown_hint_of_an_allowed_contact_is_toml(arm):
    text = example_of("arm", entry=arm)
    hint = text[text.index("# [[allowed]]") :].replace("# ", "")
    assert tomllib.loads(hint)["allowed"][0]["reason"]


def test_every_example_of_the_catalogue_is_its_default_design(each_design):
    text = example_of(each_design.mechanism.name)
    assert read_design(text).hash == each_design.hash
    assert max(map(len, text.splitlines())) <= WIDTH
