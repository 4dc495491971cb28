"""A design file is read as it says, and every mistake in it is named with its place."""

from __future__ import annotations

import math

import pytest

from linkwright.designs import catalogue
from linkwright.designs.file.keys import keys_of
from linkwright.designs.file.problems import DesignFileErrors
from linkwright.designs.file.reader import load_design, read_design
from linkwright.designs.language.errors import DesignFileError, UnknownNameError
from linkwright.designs.language.units import file_from_inside


@pytest.fixture
def read(arm):
    def find(name):
        if name != "arm":
            raise UnknownNameError("mechanism", name, ("arm",))
        return arm

    return lambda text, overrides=(): read_design(text, overrides, find_entry=find)


@pytest.fixture
def load(arm):
    def find(name):
        if name != "arm":
            raise UnknownNameError("mechanism", name, ("arm",))
        return arm

    return lambda design, overrides=(): load_design(design, overrides, find_entry=find)


def refused(read, text, overrides=()):
    with pytest.raises(DesignFileError) as caught:
        read(text, overrides)
    return caught.value


def test_reader_takes_what_the_file_gives_and_defaults_for_the_rest(read):
    design = read('mechanism = "arm"\nname = "long"\n[parameters]\nfore_mm = 90\n[parts.bars]\ntilt_deg = 45\n')
    assert design.name == "long"
    assert design.mechanism.sections["parameters"].fore == 90.0
    assert isinstance(design.mechanism.sections["parameters"].fore, float)
    assert design.mechanism.sections["parameters"].upper == 100.0
    assert design.mechanism.sections["parts.bars"].tilt == pytest.approx(math.pi / 4.0, rel=1e-15)


def test_reader_gives_the_catalogue_design_for_a_file_that_only_names_the_mechanism(read, arm):
    assert read('mechanism = "arm"').hash == arm.default_design().hash


def test_reader_keeps_the_exact_inside_value_of_a_default(read):
    assert read('mechanism = "arm"').mechanism.sections["parts.bars"].tilt == 0.3


def test_whole_numbers_and_floats_of_one_value_give_one_hash(read):
    texts = [
        f'mechanism = "arm"\n[parameters]\nfore_mm = {value}\n[workspace]\nx_min_mm = {zero}'
        for value, zero in (("90", "0"), ("90.0", "-0.0"), ("9e1", "+0"))
    ]
    assert len({read(text).hash for text in texts}) == 1


@pytest.mark.parametrize(
    ("line", "key", "allowed"),
    [
        ("fore_mm = -5", "parameters.fore_mm", "above 0 mm"),
        ("fore_mm = 0", "parameters.fore_mm", "above 0 mm"),
        ("fore_mm = 501", "parameters.fore_mm", "at most 500 mm"),
        ('fore_mm = "90"', "parameters.fore_mm", "must be a number, not text"),
        ("fore_mm = true", "parameters.fore_mm", "must be a number, not true or false"),
        ("fore_mm = nan", "parameters.fore_mm", "finite"),
        ("fore_mm = inf", "parameters.fore_mm", "must be"),
        ("fore_mm = [90]", "parameters.fore_mm", "must be a number, not a list"),
        ("fore_m = 90", "parameters.fore_m", "did you mean parameters.fore_mm?"),
        ("fore = 90", "parameters.fore", "did you mean parameters.fore_mm?"),
        ("tilt_deg = 9", "parameters.tilt_deg", "did you mean parts.bars.tilt_deg?"),
        ("qqqqq = 9", "parameters.qqqqq", "no such key; known: upper_mm, fore_mm"),
    ],
)
def test_a_wrong_line_is_named_with_its_line_key_and_what_is_allowed(read, line, key, allowed):
    error = refused(read, f'mechanism = "arm"\n\n[parameters]\nupper_mm = 100\n{line}\n')
    assert (error.line, error.key) == (5, key)
    assert allowed in error.allowed
    assert key in str(error)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("[parts.bars]\nn_screws = 2.0", 3, "must be a whole number"),
        ("[parts.bars]\nn_screws = true", 3, "must be a whole number, not true or false"),
        ("[parts.bars]\nn_screws = 13", 3, "at least 1 and at most 12"),
        ("[parts.bars]\nis_hollow = 1", 3, "must be true or false"),
        ("[parts.bars]\ntilt_deg = 91", 3, "at least -90 deg and at most 90 deg"),
        ('[supplies]\nbearing = "688"', 3, "did you mean 688ZZ?"),
        ("[supplies]\nbearing = 623", 3, "one of 623"),
        ("[paramters]\nfore_mm = 90", 2, "did you mean parameters?"),
        ("[parts.bar]\nq = 1", 2, "did you mean parts.bars?"),
        ("parts = 3", 2, "must be a table"),
        ('name = "a/b"', 2, "can name a file"),
        ('name = "../up"', 2, "can name a file"),
        ("[sampling]\nn_poses = 0", 3, "at least 1"),
        ("[workspace]\nx_min_mm = 95", 3, "must be at most x_max_mm = 90"),
        ("[workspace]\nx_max_mm = 10", 3, "must be at least x_min_mm = 60"),
        ('[[allowed]]\npair = ["base"]\nreason = "x"', 3, "exactly two bodies"),
        ('[[allowed]]\npair = ["base", "uper"]\nreason = "x"', 3, "did you mean upper?"),
        ('[[allowed]]\npair = ["base", "base"]\nreason = "x"', 3, "two different bodies"),
        ('[[allowed]]\npair = ["base", "fore"]\nreason = ""', 4, "must say why"),
        ('[[allowed]]\npair = ["base", "fore"]', 2, "is required"),
        ('allowed = "none"', 2, "[[allowed]] tables"),
    ],
)
def test_every_kind_of_mistake_is_placed(read, text, line, words):
    error = refused(read, f'mechanism = "arm"\n{text}\n')
    assert error.line == line
    assert words in str(error)


def test_all_errors_of_a_file_are_told_at_once_in_its_order(read):
    error = refused(read, 'mechanism = "arm"\n[parameters]\nupper_mm = -1\nfor = 2\n[sampling]\nseed = "x"\n')
    assert isinstance(error, DesignFileErrors)
    assert [e.line for e in error.errors] == [3, 4, 6]
    assert len(str(error).splitlines()) == 3


def test_a_rule_of_the_mechanism_that_spans_two_keys_is_placed_too(read):
    error = refused(read, 'mechanism = "arm"\n[parameters]\nfore_mm = 100\n')
    assert (error.line, error.key) == (3, "parameters.fore_mm")
    assert "must differ from upper_mm" in error.allowed


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ('mechanism = "arm"\n[parameters\n', 2, "not TOML in `[parameters`"),
        ('mechanism = "arm"\n[parameters]\nfore_mm = 1\nfore_mm = 2\n', 4, "overwrite"),
        ('mechanism = "arm"\n[parameters]\nfore_mm = 1,5\n', 3, "not TOML"),
        ('mechanism = "arm"\n[parameters]\nfore_mm =', 3, "not TOML"),
    ],
)
def test_a_text_that_is_no_toml_is_refused_with_the_line(read, text, line, words):
    error = refused(read, text)
    assert abs(error.line - line) <= (1 if "overwrite" in words else 0)
    assert words in str(error)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('name = "x"', "is required"),
        ('mechanism = "amr"', "did you mean arm?"),
        ("mechanism = 3", "text in quotes"),
    ],
)
def test_a_file_without_a_known_mechanism_is_refused(read, text, words):
    error = refused(read, text)
    assert error.key == "mechanism"
    assert words in str(error)


def test_overrides_hold_over_the_file_and_the_last_one_over_the_first(read):
    text = 'mechanism = "arm"\n[parameters]\nfore_mm = 90\n'
    design = read(
        text,
        [
            "parameters.fore_mm=91",
            "parameters.fore_mm = 92",
            "name=7",
            "supplies.bearing=623",
            "parts.bars.is_hollow=true",
            "sampling.n_poses=3",
        ],
    )
    assert design.mechanism.sections["parameters"].fore == 92.0
    assert (design.name, design.mechanism.sections["supplies"].bearing) == ("7", "623")
    assert design.mechanism.sections["parts.bars"].is_hollow is True
    assert design.sampling.n_poses == 3


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("parameters.fore_mm=-1", "above 0 mm"),
        ("parameters.fore_mm=x", "must be a number, not text"),
        ("parameters.fore_mm=1\nname='x'", "must be a number, not text"),
        ("parameters.fore_mm=100", "must differ from upper_mm"),
        ("fore_mm=90", "did you mean parameters.fore_mm?"),
        ("nothing.here=90", "no such table"),
        ("novalue", "must be key=value"),
        ("=3", "must be key=value"),
        ("name.x=3", "can name a file"),
        ("supplies.bearing=69", "one of 623"),
        ("mechanism=robot", "one of arm"),
    ],
)
def test_a_wrong_override_is_blamed_on_the_command_line(read, override, words):
    error = refused(read, 'mechanism = "arm"\n[parts.bars]\nwidth_mm = 3\n', [override])
    assert error.path == "--set"
    assert error.line is None
    assert words in str(error)


def test_an_override_through_a_value_is_refused(read):
    assert "name is not a table" in str(refused(read, 'mechanism = "arm"\nname = "x"\n', ["name.deep=3"]))


def test_an_error_of_the_file_keeps_its_line_beside_overrides(read):
    error = refused(read, 'mechanism = "arm"\n[parameters]\nfore_mm = -1\n', ["parameters.upper_mm=10"])
    assert error.line == 3


def test_lines_of_all_keys_are_known_to_the_design(read):
    design = read('mechanism = "arm"\n[parameters]\nfore_mm = 90\n[[allowed]]\npair = ["base", "fore"]\nreason = "r"\n')
    assert design.lines["parameters.fore_mm"] == 3
    assert design.lines["allowed.0.reason"] == 6
    assert design.allowed[0].pair == ("base", "fore")


def test_a_missing_file_is_one_error_that_names_its_neighbours(load, tmp_path):
    (tmp_path / "device.toml").write_text('mechanism = "arm"\n')
    with pytest.raises(DesignFileError, match=r"does not exist; did you mean device\.toml\?"):
        load(str(tmp_path / "devise.toml"))


def test_a_folder_and_a_binary_file_are_refused_clearly(load, tmp_path):
    (tmp_path / "x.toml").write_bytes(b'mechanism = "arm"\n\xff\xfe')
    with pytest.raises(DesignFileError, match=r"x\.toml:2: .*UTF-8"):
        load(str(tmp_path / "x.toml"))
    with pytest.raises(DesignFileError, match="cannot be read"):
        load(str(tmp_path))


def test_a_file_is_preferred_to_the_catalogue_and_a_folder_is_not(load, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm").mkdir()
    assert load("arm").path == ""
    (tmp_path / "arm").rmdir()
    (tmp_path / "arm").write_text('mechanism = "arm"\nname = "from_file"\n')
    assert load("arm").name == "from_file"


def test_an_unknown_design_lists_the_mechanisms(load):
    with pytest.raises(DesignFileError, match=r"neither a file nor a mechanism; did you mean arm\?"):
        load("amr")


def test_a_byte_order_mark_and_windows_line_ends_do_no_harm(load, tmp_path):
    (tmp_path / "w.toml").write_bytes(b'\xef\xbb\xbfmechanism = "arm"\r\n[parameters]\r\nfore_mm = 90\r\n')
    design = load(str(tmp_path / "w.toml"))
    assert design.mechanism.sections["parameters"].fore == 90.0
    assert design.lines["parameters.fore_mm"] == 3


def beyond_bounds(key):
    """A value that the key's bounds refuse, or None if every number is legal."""
    meta = key.meta
    if meta.choices:
        return "no_such_choice"
    bounds = {"above": meta.above, "least": meta.least, "most": meta.most}
    low = next((bounds[b] for b in ("above", "least") if bounds[b] is not None), None)
    if low is not None:
        return file_from_inside(low, meta.unit) - (0 if meta.above is not None else 1)
    return None if meta.most is None else file_from_inside(meta.most, meta.unit) + 1


def test_every_bound_of_every_mechanism_is_kept_and_all_breaches_are_told_together(each_design):
    keys = keys_of(catalogue.entry(each_design.mechanism.name))
    bad = {dotted: value for dotted, key in keys.items() if (value := beyond_bounds(key)) is not None}
    assert len(bad) > 10
    with pytest.raises(DesignFileErrors) as caught:
        load_design(each_design.mechanism.name, [f"{dotted}={value}" for dotted, value in bad.items()])
    assert {error.key for error in caught.value.errors} == set(bad)
    assert all(error.path == "--set" for error in caught.value.errors)


def test_every_default_of_every_mechanism_can_be_set_to_itself(each_design):
    keys = keys_of(catalogue.entry(each_design.mechanism.name))
    shown = {dotted: str(key.default).lower() if key.kind is bool else key.default for dotted, key in keys.items()}
    texts = [f"{dotted}={value}" for dotted, value in shown.items()]
    assert load_design(each_design.mechanism.name, texts).hash == each_design.hash
