"""A design as the text of its file: every number resolved, with its unit, letter, meaning and bounds beside it."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import tomlkit

from .. import catalogue
from ..design import Design
from ..language.units import file_from_inside
from .keys import Key, keys_of
from .model import doc_of_table

if TYPE_CHECKING:
    from ..catalogue import Entry

WIDTH = 120

#: A choice with more names than this is listed once above its table, not beside each key.
_FEW_CHOICES = 3

_UNITS_NOTE = (
    "Each key says its unit: _mm, _deg, _kg; no suffix is a plain number or a name. A key left out takes its default."
)


def text_of(design: Design, *, entry: Entry | None = None) -> str:
    """The resolved design file; reading it gives a design of the same hash.

    Args:
        design: what to write down.
        entry: the design's row of the catalogue, looked up by default.
    """
    entry = entry or catalogue.entry(design.mechanism.name)
    banner = [
        entry.title,
        f"Source: {entry.source}",
        "",
        "Resolved design: every number that was used, defaults included.",
        _UNITS_NOTE,
    ]
    return _text(entry, design.resolved(), banner)


def example_of(name: str, *, entry: Entry | None = None) -> str:
    """The commented default file of a mechanism, for `linkwright new`."""
    entry = entry or catalogue.entry(name)
    banner = [
        entry.title,
        f"Source: {entry.source}",
        "",
        _UNITS_NOTE,
        "",
        "linkwright show FILE       resolved and derived numbers",
        "linkwright check FILE      collisions, clearances and joint limits on the solids",
        "linkwright release FILE -o DIR",
    ]
    hint = _comment("Bodies that may touch are named, with the reason; all others must keep clearance.minimum_mm:")
    hint += ["# [[allowed]]", '# pair = ["one_body", "another_body"]', '# reason = "why they may touch"']
    return _text(entry, entry.default_design().resolved(), banner) + "\n" + "\n".join(hint) + "\n"


def _text(entry: Entry, resolved: Mapping[str, Any], banner: Sequence[str]) -> str:
    keys = keys_of(entry)
    lines = [line for text in banner for line in (_comment(text) if text else ["#"])]
    tables: dict[str, list[Key]] = {}
    for key in keys.values():
        tables.setdefault(key.table, []).append(key)
    for table, own in tables.items():
        lines.append("")
        if table:
            doc = doc_of_table(entry, table)
            lines += [*_comment(doc), *_shared_choices(own), f"[{table}]"]
        lines += _rows(own, [_look_up(resolved, key.dotted) for key in own])
    for contact in resolved.get("allowed", []):
        lines += ["", "[[allowed]]", f"pair = {_toml(contact['pair'])}", f"reason = {_toml(contact['reason'])}"]
    return "\n".join(lines) + "\n"


def _rows(keys: Sequence[Key], values: Sequence[Any]) -> Iterator[str]:
    """`key = value  # comment`, the comments of a table in one column, long ones continued below themselves."""
    pairs = [f"{key.leaf} = {_toml(value)}" for key, value in zip(keys, values, strict=True)]
    column = max(len(pair) for pair in pairs) + 2
    shared = _shared(keys)
    for key, value, pair in zip(keys, values, pairs, strict=True):
        first, *rest = _wrapped(_note(key, value, shared), max(WIDTH - column - 2, 40))
        yield f"{pair:<{column}}# {first}"
        yield from (f"{'':<{column}}# {line}" for line in rest)


def _note(key: Key, value: Any, shared: Mapping[tuple[str, ...], list[str]]) -> str:
    """Letter, unit and bounds in brackets, then the meaning, and the default where the value is another."""
    bounds = [] if key.meta.choices in shared else [_bounds(key)]
    bracket = ", ".join(word for word in [key.meta.symbol, key.meta.unit, *bounds] if word)
    changed = "" if value == key.default else f" (default {_toml(key.default)})"
    return (f"[{bracket}] " if bracket else "") + key.meta.doc + changed


def _bounds(key: Key) -> str:
    if key.meta.choices:
        return "one of " + ", ".join(key.meta.choices)

    def shown(bound: float) -> str:
        return f"{file_from_inside(bound, key.meta.unit):g}"

    words = [f"> {shown(key.meta.above)}"] if key.meta.above is not None else []
    if key.meta.least is not None and key.meta.most is not None:
        return f"{shown(key.meta.least)} to {shown(key.meta.most)}"
    words += [f">= {shown(key.meta.least)}"] if key.meta.least is not None else []
    words += [f"<= {shown(key.meta.most)}"] if key.meta.most is not None else []
    return ", ".join(words)


def _shared(keys: Sequence[Key]) -> dict[tuple[str, ...], list[str]]:
    """Long lists of choices -> the keys that choose from them."""
    lists: dict[tuple[str, ...], list[str]] = {}
    for key in keys:
        if len(key.meta.choices) > _FEW_CHOICES:
            lists.setdefault(key.meta.choices, []).append(key.leaf)
    return lists


def _shared_choices(keys: Sequence[Key]) -> list[str]:
    return [
        line
        for choices, leaves in _shared(keys).items()
        for line in _comment(f"{', '.join(leaves)}: one of {', '.join(choices)}")
    ]


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in _wrapped(text, WIDTH - 2)]


def _wrapped(text: str, width: int) -> list[str]:
    """Lines of a text; names such as MR104ZZ or DIN6799-4 stay whole."""
    return textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)


def _look_up(table: Mapping[str, Any], dotted: str) -> Any:
    here: Any = table
    for word in dotted.split("."):
        here = here[word]
    return here


def _toml(value: Any) -> str:
    return tomlkit.item(value).as_string()
