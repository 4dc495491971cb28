"""Every key that a mechanism's design file may hold, in one flat table: kind, default in the file's unit, bounds."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..design import Clearance, Outputs, Sampling
from ..language.mechanism import Coordinate
from ..language.parameters import Meta, fields_of
from ..language.units import file_from_inside, inside_from_file

if TYPE_CHECKING:
    from ..catalogue import Entry

#: Tables that every design has, whatever its mechanism.
COMMON: dict[str, type] = {"sampling": Sampling, "clearance": Clearance, "outputs": Outputs}

#: A design's name becomes the name of files: no blanks, no separators, no leading dot.
NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9_.-]*$"

#: Share of equal letters from which a word counts as a slip of another, and how much less a second guess may have.
_NEAR, _ABOUT_AS_NEAR = 0.6, 0.05

Plain = float | int | str | bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """One key of the file.

    Attributes:
        table: dotted name of its table, empty at the top.
        leaf: the key itself, with its unit ("base_radius_mm").
        field: name of the dataclass field that it fills ("base_radius").
        kind: float, int, str or bool.
        default: in the unit of the file.
        meta: unit, meaning and bounds.
    """

    table: str
    leaf: str
    field: str
    kind: type
    default: Plain
    meta: Meta

    @property
    def dotted(self) -> str:
        """The key as one writes it on the command line."""
        return f"{self.table}.{self.leaf}" if self.table else self.leaf


def sections_of(entry: Entry) -> dict[str, Any]:
    """Default instances of all tables made of fields: the mechanism's own, then the common ones."""
    return {**entry.default_sections(), **{table: kind() for table, kind in COMMON.items()}}


def keys_of(entry: Entry) -> dict[str, Key]:
    """All keys by their dotted name, in the order in which the file shows them."""
    keys = [_text_key("mechanism", entry.name, "a name of the catalogue (linkwright list)")]
    keys += [_text_key("name", entry.name, "names the files of a release")]
    for table, section in entry.default_sections().items():
        keys += section_keys(table, section)
    keys += _workspace_keys(entry)
    for table, kind in COMMON.items():
        keys += section_keys(table, kind())
    return {key.dotted: key for key in keys}


def section_keys(table: str, section: Any) -> list[Key]:
    """The keys of one table; defaults are the values of the instance."""
    return [
        Key(
            table=table,
            leaf=f.key,
            field=f.name,
            kind=type(f.default),
            meta=f.meta,
            default=shown(getattr(section, f.name), type(f.default), f.meta.unit),
        )
        for f in fields_of(section)
    ]


def shown(value: Plain, kind: type, unit: str) -> Plain:
    """A value as the file shows it."""
    return file_from_inside(float(value), unit) if kind is float else value


def taken(value: Plain, kind: type, unit: str) -> Plain:
    """A file's value as the house uses it; a whole number under a measured key becomes a float."""
    # Adding zero turns -0.0 into 0.0, so that the two give the same design hash.
    return inside_from_file(float(value), unit) + 0.0 if kind is float else value


def replaced(section: Any, table: str, values: Mapping[str, Plain]) -> Any:
    """The section with the given keys (in file units) taken over; other fields keep their exact inside value."""
    keys = {key.leaf: key for key in section_keys(table, section)}
    changes = {keys[leaf].field: taken(v, keys[leaf].kind, keys[leaf].meta.unit) for leaf, v in values.items()}
    return dataclasses.replace(section, **changes)


def workspace_leaf(coordinate: Coordinate, end: str) -> str:
    """Key of one end ("min", "max") of a coordinate's range in [workspace]."""
    words = [coordinate.name, end, coordinate.unit]
    return "_".join(word for word in words if word)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The words "; did you mean a or b?" if known words are near (b only if about as near as a), else nothing."""
    near = near_words(word, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def near_words(word: str, known: Iterable[str]) -> list[str]:
    """The nearest known word and the next, if they are near."""
    shares = {other: difflib.SequenceMatcher(None, word, other).ratio() for other in known}
    near = sorted((other for other in shares if shares[other] >= _NEAR), key=lambda other: (-shares[other], other))
    return [other for other in near[:2] if shares[other] >= shares[near[0]] - _ABOUT_AS_NEAR]


def did_you_mean_key(dotted: str, keys: Mapping[str, Key]) -> str:
    """The same for a dotted key: first the same leaf in another table, then a near leaf of its own table, then any."""
    table, _, leaf = dotted.rpartition(".")
    same = [key.dotted for key in keys.values() if leaf in (key.leaf, key.field)]
    if same:
        return f"; did you mean {' or '.join(same[:2])}?"
    own = {key.leaf: key.dotted for key in keys.values() if key.table == table}
    anywhere = {key.leaf: key.dotted for key in keys.values()}
    for candidates in (own, anywhere):
        near = near_words(leaf, candidates)
        if near:
            return f"; did you mean {' or '.join(candidates[word] for word in near)}?"
    return ""


def _text_key(leaf: str, default: str, doc: str) -> Key:
    return Key(table="", leaf=leaf, field=leaf, kind=str, default=default, meta=_meta("", doc))


def _workspace_keys(entry: Entry) -> list[Key]:
    keys = []
    for c, low, high in zip(entry.task, entry.workspace.lower, entry.workspace.upper, strict=True):
        for end, value in (("min", low), ("max", high)):
            leaf = workspace_leaf(c, end)
            meta = _meta(c.unit, f"{'least' if end == 'min' else 'greatest'} {c.name} at which the design must work")
            keys.append(
                Key(
                    table="workspace",
                    leaf=leaf,
                    field=f"{c.name}_{end}",
                    kind=float,
                    meta=meta,
                    default=file_from_inside(value, c.unit),
                )
            )
    return keys


def _meta(unit: str, doc: str) -> Meta:
    return Meta(unit=unit, doc=doc, symbol="", above=None, least=None, most=None, choices=())
