"""From a design file or a catalogue name to a design; errors name file, line, key, value and what is allowed."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import catalogue
from ..design import Allowed, Design, Workspace
from ..language.errors import DesignFileError, ParameterError, UnknownNameError
from ..language.mechanism import Mechanism
from ..language.units import inside_from_file
from .keys import COMMON, Key, did_you_mean, keys_of, replaced, workspace_leaf
from .overrides import Override, lay_over, parse_overrides
from .positions import lines_of
from .problems import Places, describe, raise_all

if TYPE_CHECKING:
    from pydantic import BaseModel

    from ..catalogue import Entry

FindEntry = Callable[[str], "Entry"]

#: Shown in place of a path where a design came as text.
TEXT = "design"


def load_design(design: str, overrides: Sequence[str] = (), *, find_entry: FindEntry = catalogue.entry) -> Design:
    """The design that a user names on the command line.

    Args:
        design: a path (an existing file, or anything that ends with .toml or holds a separator), else a catalogue name.
        overrides: `key=value` texts, see `parse_overrides`.
        find_entry: where mechanisms are looked up.

    Raises:
        DesignFileError: the file is missing, unreadable or wrong.
        UnknownNameError: the catalogue has no such mechanism.
    """
    path = Path(design)
    if path.is_file() or path.suffix == ".toml" or "/" in design or "\\" in design:
        return read_design(path, overrides, find_entry=find_entry)
    try:
        entry = find_entry(design)
    except UnknownNameError as error:
        files = sorted(str(p) for p in Path().glob("*.toml"))
        hint = did_you_mean(design, [*error.known, *files])
        known = ", ".join(error.known)
        raise DesignFileError(
            design, None, "design", None, f"is neither a file nor a mechanism{hint}; mechanisms: {known}"
        ) from error
    if not overrides:
        return entry.default_design()
    return _resolve({"mechanism": entry.name}, parse_overrides(overrides), "", {}, find_entry)


def read_design(
    source: str | Path, overrides: Sequence[str] = (), *, find_entry: FindEntry = catalogue.entry
) -> Design:
    """The design in a file (`Path`) or in a TOML text (`str`).

    Raises:
        DesignFileError: with a line per error if there are several (`DesignFileErrors`).
    """
    path, text = (str(source), _text_of_file(source)) if isinstance(source, Path) else ("", source)
    given = parse_overrides(overrides)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(path or TEXT, text, error) from error
    return _resolve(table, given, path, lines_of(text), find_entry)


def _resolve(
    table: dict[str, Any], overrides: Sequence[Override], path: str, lines: dict[str, int], find_entry: FindEntry
) -> Design:
    """Lay the overrides over the table, validate it, and build the design."""
    places = Places(path or TEXT, lines, {o.dotted for o in overrides})
    entry = _entry_of(table, overrides, places, find_entry)
    keys = keys_of(entry)
    given = _plain_keys(table)
    lay_over(table, overrides, keys)
    model = _validated(entry, table, keys, places)
    sections, common = _sections(entry, model, keys, given, places)
    workspace = _workspace(entry, model, keys, places)
    mechanism = _built(partial(entry.build, sections), keys, given, places)
    return Design(
        name=_value(model, "name"),
        mechanism=mechanism,
        workspace=workspace,
        **common,
        allowed=_allowed(model, mechanism, places),
        path=path,
        lines=lines,
    )


def _text_of_file(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError as error:
        folder = path.parent if path.parent.is_dir() else Path()
        hint = did_you_mean(path.name, [p.name for p in sorted(folder.glob("*.toml"))])
        raise DesignFileError(str(path), None, "file", None, f"does not exist{hint}") from error
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise DesignFileError(str(path), line, "file", None, "must be UTF-8 text") from error
    except OSError as error:
        raise DesignFileError(str(path), None, "file", None, f"cannot be read: {error.strerror}") from error


def _syntax_error(path: str, text: str, error: tomllib.TOMLDecodeError) -> DesignFileError:
    """The parser says the place in words only."""
    words = str(error)
    place = re.search(r"\s*\(at line (\d+), column (\d+)\)$", words)
    if place is None:
        message = re.sub(r"\s*\(at end of document\)$", " (at the end of the file)", words)
        return DesignFileError(path, max(1, len(text.splitlines())), "not TOML", None, message)
    line = int(place[1])
    lines = text.splitlines()
    shown = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    return DesignFileError(
        path,
        line,
        f"not TOML in `{shown}`" if shown else "not TOML",
        None,
        f"{words[: place.start()]} (column {place[2]})",
    )


def _entry_of(table: Mapping[str, Any], overrides: Sequence[Override], places: Places, find_entry: FindEntry) -> Entry:
    name = next((o.text.strip("\"'") for o in overrides if o.dotted == "mechanism"), table.get("mechanism"))
    known = ", ".join(catalogue.names())
    if name is None:
        raise places.error("mechanism", None, f"is required: a name of the catalogue ({known})")
    if not isinstance(name, str):
        raise places.error(
            "mechanism",
            None if isinstance(name, dict | list) else name,
            f"must be text in quotes: a name of the catalogue ({known})",
        )
    try:
        return find_entry(name)
    except UnknownNameError as error:
        hint = did_you_mean(name, error.known) or "; one of your own: linkwright --mechanisms FILE.py ..."
        raise places.error("mechanism", name, f"one of {', '.join(error.known)}{hint}") from error


def _plain_keys(table: Mapping[str, Any], prefix: str = "") -> set[str]:
    """Dotted names of all values that the file itself gives."""
    found = set()
    for word, value in table.items():
        dotted = f"{prefix}.{word}" if prefix else word
        found |= _plain_keys(value, dotted) if isinstance(value, dict) else {dotted}
    return found


def _validated(entry: Entry, table: Mapping[str, Any], keys: Mapping[str, Key], places: Places) -> BaseModel:
    # The model costs a quarter of a start-up; a catalogue design without overrides does not need it.
    from pydantic import ValidationError

    from .model import build_model

    try:
        return build_model(entry).model_validate(table)
    except ValidationError as error:
        raise_all([places.error(*describe(detail, keys)) for detail in error.errors(include_url=False)])
        raise


def _sections(
    entry: Entry, model: BaseModel, keys: Mapping[str, Key], given: set[str], places: Places
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The mechanism's sections and the common ones, with what the file gives taken over."""
    defaults = {**entry.default_sections(), **{name: kind() for name, kind in COMMON.items()}}
    taken = {
        table: _built(partial(replaced, section, table, _given_values(model, table)), keys, given, places)
        for table, section in defaults.items()
    }
    return {t: s for t, s in taken.items() if t not in COMMON}, {t: s for t, s in taken.items() if t in COMMON}


def _given_values(model: BaseModel, table: str) -> dict[str, Any]:
    """Leaf key -> value of one table, only of keys that were given."""
    for word in table.split("."):
        model = getattr(model, f"table_{word}")
    fields = type(model).model_fields
    return {
        str(fields[name].alias): getattr(model, name)
        for name in fields
        if name in model.model_fields_set and name.startswith("field_")
    }


def _workspace(entry: Entry, model: BaseModel, keys: Mapping[str, Key], places: Places) -> Workspace:
    values = _given_values(model, "workspace")
    ends: dict[str, list[float]] = {"min": list(entry.workspace.lower), "max": list(entry.workspace.upper)}
    errors = []
    for i, coordinate in enumerate(entry.task):
        leaves = {end: workspace_leaf(coordinate, end) for end in ends}
        for end, leaf in leaves.items():
            if leaf in values:
                ends[end][i] = inside_from_file(values[leaf], coordinate.unit) + 0.0
        if ends["min"][i] > ends["max"][i]:
            given, other, side = "max", "min", "at least"
            if leaves["min"] in values:
                given, other, side = "min", "max", "at most"
            shown = {end: values.get(leaf, keys[f"workspace.{leaf}"].default) for end, leaf in leaves.items()}
            errors.append(
                places.error(
                    f"workspace.{leaves[given]}", shown[given], f"must be {side} {leaves[other]} = {shown[other]:g}"
                )
            )
    raise_all(errors)
    return Workspace(lower=tuple(ends["min"]), upper=tuple(ends["max"]))


def _allowed(model: BaseModel, mechanism: Mechanism, places: Places) -> tuple[Allowed, ...]:
    names = [body.name for body in mechanism.bodies]
    allowed, errors = [], []
    for i, contact in enumerate(_value(model, "allowed")):
        first, second = contact.pair
        for j, name in enumerate((first, second)):
            if name not in names:
                hint = did_you_mean(name, names) or f"; bodies: {', '.join(names)}"
                errors.append(places.error(f"allowed.{i}.pair.{j}", name, f"there is no such body{hint}"))
        if first == second:
            errors.append(places.error(f"allowed.{i}.pair", None, "must name two different bodies"))
        allowed.append(Allowed(pair=(first, second), reason=contact.reason))
    raise_all(errors)
    return tuple(allowed)


def _built(make: Callable[[], Any], keys: Mapping[str, Key], given: set[str], places: Places) -> Any:
    """What `make` makes; a number that it refuses becomes an error at its place in the file."""
    try:
        return make()
    except ParameterError as error:
        raise places.error(
            _dotted(error.field, keys, given | set(places.overridden)), error.value, error.allowed
        ) from error


def _dotted(field: str, keys: Mapping[str, Key], given: set[str]) -> str:
    """The dotted key that a mechanism means: it names a leaf, a field or a dotted key."""
    if field in keys:
        return field
    meant = [key.dotted for key in keys.values() if field in (key.leaf, key.field)]
    return next((dotted for dotted in meant if dotted in given), meant[0] if meant else field)


def _value(model: BaseModel, leaf: str) -> Any:
    return getattr(model, f"field_{leaf}")
