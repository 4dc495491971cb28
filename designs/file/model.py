"""What a design file may hold, as one strict pydantic model per mechanism, and as JSON Schema.

pydantic stays at this border: the model is made from the sections' own fields and its values go straight back into
the frozen dataclasses.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, create_model

from ..language.units import file_from_inside
from .keys import COMMON, NAME_PATTERN, Key, keys_of

if TYPE_CHECKING:
    from ..catalogue import Entry

_CONFIG = ConfigDict(extra="forbid", protected_namespaces=())

SCHEMA_DIALECT = "https://json-schema.org/draft/2020-12/schema"


class AllowedTable(BaseModel):
    """A contact of two bodies that the designer declares, and why it is one."""

    model_config = ConfigDict(extra="forbid")

    pair: Annotated[list[Annotated[str, Field(strict=True)]], Field(min_length=2, max_length=2, strict=True)] = Field(
        description="names of the two bodies"
    )
    reason: Annotated[str, Field(strict=True, min_length=1)] = Field(description="why they may touch")


def build_model(entry: Entry) -> type[BaseModel]:
    """The model of one mechanism's design files; its fields are reached by alias, which is the key of the file."""
    keys = keys_of(entry)
    tables = _nested(keys.values())
    fields = _fields_of_table(entry, tables, "", entry.title)
    fields["field_allowed"] = (
        list[AllowedTable],
        Field(default_factory=list, alias="allowed", description="contacts that are no collision"),
    )
    title = _camel(entry.name) + "Design"
    return create_model(title, __config__=_CONFIG, __doc__=f"A design file of {entry.title}.", **fields)


def json_schema(entry: Entry) -> dict[str, Any]:
    """JSON Schema (2020-12) of one mechanism's design files, bounds and defaults in the units of the file."""
    schema = build_model(entry).model_json_schema(by_alias=True)
    _tidy(schema)
    return {"$schema": SCHEMA_DIALECT, **schema, "title": f"linkwright design: {entry.title}"}


def combined_schema(entries: Iterable[Entry]) -> dict[str, Any]:
    """One schema for the design files of all mechanisms, told apart by their key `mechanism`."""
    branches, names = [], []
    for entry in entries:
        schema = json_schema(entry)
        del schema["$schema"]
        prefix = _camel(entry.name)
        schema = _renamed(schema, {name: f"{prefix}.{name}" for name in schema.get("$defs", {})})
        branches.append(schema)
        names.append(entry.name)
    definitions = {name: d for schema in branches for name, d in schema.pop("$defs", {}).items()}
    conditions = [
        {"if": {"properties": {"mechanism": {"const": name}}}, "then": schema}
        for name, schema in zip(names, branches, strict=True)
    ]
    return {
        "$schema": SCHEMA_DIALECT,
        "title": "linkwright design",
        "type": "object",
        "required": ["mechanism"],
        "properties": {"mechanism": {"enum": names, "description": "a name of the catalogue"}},
        "allOf": conditions,
        "$defs": definitions,
    }


def _fields_of_table(entry: Entry, tables: Mapping[str, list[Key]], table: str, doc: str) -> dict[str, Any]:
    """Pydantic fields of one table: its keys, then the tables inside it."""
    fields: dict[str, Any] = {}
    for key in tables.get(table, []):
        fields[f"field_{key.field}"] = _field(entry, key)
    for inner in tables:
        parent, _, leaf = inner.rpartition(".")
        if not inner or parent != table:
            continue
        inner_doc = doc_of_table(entry, inner)
        name = _camel(entry.name) + "".join(_camel(word) for word in inner.split("."))
        inner_fields = _fields_of_table(entry, tables, inner, inner_doc)
        model = create_model(name, __config__=_CONFIG, __doc__=inner_doc, **inner_fields)
        fields[f"table_{leaf}"] = (model, Field(default_factory=model, alias=leaf, description=inner_doc))
    return fields


def _field(entry: Entry, key: Key) -> Any:
    """(annotation, field info) of one key."""
    about: dict[str, Any] = {"alias": key.leaf, "description": _description(key)}
    if key.dotted == "mechanism":
        return Literal[entry.name], Field(**about)  # type: ignore[valid-type]
    if key.dotted == "name":
        return Annotated[str, Field(strict=True, pattern=NAME_PATTERN)], Field(key.default, **about)
    if key.meta.choices:
        return Literal[key.meta.choices], Field(key.default, **about)  # type: ignore[valid-type]
    rules: dict[str, Any] = {"strict": True} if key.kind in (str, bool) else {"strict": True, **_bounds(key)}
    if key.kind is float:
        rules["allow_inf_nan"] = False
    return Annotated[key.kind, Field(**rules)], Field(key.default, **about)


def _bounds(key: Key) -> dict[str, float]:
    words = {"gt": key.meta.above, "ge": key.meta.least, "le": key.meta.most}
    return {word: file_from_inside(bound, key.meta.unit) for word, bound in words.items() if bound is not None}


def _description(key: Key) -> str:
    symbol = f"{key.meta.symbol}: " if key.meta.symbol else ""
    unit = f" [{key.meta.unit}]" if key.meta.unit else ""
    return f"{symbol}{key.meta.doc}{unit}"


def doc_of_table(entry: Entry, table: str) -> str:
    """What a table holds, in one sentence: the first paragraph of its dataclass's docstring."""
    if table == "workspace":
        return "The box of task coordinates in which the design must work."
    section = entry.sections.get(table) or COMMON.get(table)
    if section is None:
        return ""
    return " ".join((section.__doc__ or "").strip().split("\n\n")[0].split())


def _nested(keys: Iterable[Key]) -> dict[str, list[Key]]:
    """Keys by table; a table that only holds tables appears with no keys of its own."""
    tables: dict[str, list[Key]] = {"": []}
    for key in keys:
        words = key.table.split(".") if key.table else []
        for i in range(len(words)):
            tables.setdefault(".".join(words[: i + 1]), [])
        tables[key.table].append(key)
    return tables


def _tidy(schema: Any) -> None:
    """Drop the titles that pydantic derives from Python's names: they would tell an editor's user nothing."""
    if isinstance(schema, dict):
        for name, value in schema.items():
            if name == "properties" and isinstance(value, dict):
                for described in value.values():
                    described.pop("title", None)
            _tidy(value)
    elif isinstance(schema, list):
        for value in schema:
            _tidy(value)


def _renamed(schema: Any, names: Mapping[str, str]) -> Any:
    """The schema with its definitions and the references to them under new names."""
    if isinstance(schema, dict):
        out = {k: _renamed(v, names) for k, v in schema.items()}
        if isinstance(out.get("$defs"), dict):
            out["$defs"] = {names[k]: v for k, v in out["$defs"].items()}
        if isinstance(out.get("$ref"), str):
            out["$ref"] = "#/$defs/" + names[out["$ref"].removeprefix("#/$defs/")]
        return out
    if isinstance(schema, list):
        return [_renamed(v, names) for v in schema]
    return schema


def _camel(name: str) -> str:
    return "".join(word[:1].upper() + word[1:] for word in name.replace("-", "_").split("_"))
