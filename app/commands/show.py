"""`linkwright show`: a design with every number resolved."""

from __future__ import annotations

import json
from collections import Counter
from itertools import groupby
from typing import Any

import click

from linkwright.designs import catalogue
from linkwright.designs.design import Design
from linkwright.designs.file.keys import Key, keys_of
from linkwright.designs.file.reader import load_design
from linkwright.designs.file.writer import text_of
from linkwright.designs.language.joints import Joint
from linkwright.designs.language.units import file_from_inside

from ..options import debug_option, design_argument, json_option, set_option


@click.command("show", short_help="Resolved parameters and derived numbers.")
@design_argument
@click.option("--toml", "as_toml", is_flag=True, help="Print the resolved design file.")
@set_option
@json_option
@debug_option
def command(design: str, as_toml: bool, overrides: tuple[str, ...], as_json: bool) -> None:
    """Show DESIGN with every number resolved: parameters, derived numbers, joints, bodies, workspace."""
    loaded = load_design(design, overrides)
    if as_json:
        click.echo(json.dumps(_facts(loaded), indent=2, ensure_ascii=False, allow_nan=False))
    elif as_toml:
        click.echo(text_of(loaded), nl=False)
    else:
        _print(loaded)


def _facts(design: Design) -> dict[str, Any]:
    mechanism = design.mechanism
    return {
        "name": design.name,
        "title": mechanism.title,
        "source": mechanism.source,
        "path": design.path,
        "design_hash": design.hash,
        "branches": list(mechanism.branches),
        "assembly_mode": mechanism.assembly_mode,
        "design": design.resolved(),
        "derived": {
            key: {"value": file_from_inside(value, unit), "unit": unit, "meaning": meaning}
            for key, (value, unit, meaning) in mechanism.derived_numbers().items()
        },
        "home": {c.key: file_from_inside(v, c.unit) for c, v in zip(mechanism.task, mechanism.home, strict=True)},
        "joints": [_joint(joint) for joint in mechanism.joints],
        "bodies": [
            {
                "name": body.name,
                "kind": body.kind,
                "group": body.group,
                "n_parts": len(body.parts),
                "n_purchased": sum(bool(part.purchased) for part in body.parts),
            }
            for body in mechanism.bodies
        ],
    }


def _joint(joint: Joint) -> dict[str, Any]:
    return {
        "name": joint.name,
        "kind": joint.kind.value,
        "parent": joint.parent,
        "child": joint.child,
        "is_active": joint.is_active,
        "unit": joint.unit,
        f"lower_{joint.unit}": file_from_inside(joint.lower, joint.unit),
        f"upper_{joint.unit}": file_from_inside(joint.upper, joint.unit),
    }


def _print(design: Design) -> None:
    from ..console import digits, heading, page, table_of

    console, mechanism = page(), design.mechanism
    heading(console, f"{design.name}: {mechanism.title}")
    console.print(f"source    {mechanism.source}")
    console.print(f"file      {design.path or 'none, the defaults of the catalogue'}")
    console.print(f"hash      {design.hash}")
    console.print(f"branches  {', '.join(mechanism.branches)} (the first is the working one)")
    console.print(f"assembly  {mechanism.assembly_mode}")
    resolved = design.resolved()
    keys = [key for key in keys_of(catalogue.entry(mechanism.name)).values() if key.table]
    for table, own in groupby(keys, key=lambda key: key.table):
        heading(console, f"[{table}]")
        rows = [_row(key, resolved) for key in own]
        columns = ("key (* changed)", "value", "unit", "symbol", "meaning")
        console.print(table_of(columns, rows, right=(1,), whole=(0, 1)))
    heading(console, "derived numbers")
    derived = [
        (key, digits(file_from_inside(value, unit)), unit, meaning)
        for key, (value, unit, meaning) in mechanism.derived_numbers().items()
    ]
    console.print(table_of(("number", "value", "unit", "meaning"), derived, right=(1,)))
    heading(console, "home pose")
    home = [(c.key, digits(file_from_inside(v, c.unit))) for c, v in zip(mechanism.task, mechanism.home, strict=True)]
    console.print(table_of(("coordinate", "value"), home, right=(1,)))
    heading(console, f"{len(mechanism.joints)} joints, {mechanism.n_active} driven")
    joints = [
        (
            j.name,
            j.kind.value,
            f"{j.parent} - {j.child}",
            digits(file_from_inside(j.lower, j.unit)),
            digits(file_from_inside(j.upper, j.unit)),
            j.unit,
            "driven" if j.is_active else "",
        )
        for j in mechanism.joints
    ]
    console.print(table_of(("joint", "kind", "between", "lower", "upper", "unit", ""), joints, right=(3, 4)))
    n_parts = sum(len(body.parts) for body in mechanism.bodies)
    heading(console, f"{len(mechanism.bodies)} bodies, {n_parts} parts")
    console.print(table_of(("kind", "bodies", "parts", "of them bought"), _kinds(design), right=(1, 2, 3)))


def _row(key: Key, resolved: dict[str, Any]) -> tuple[str, str, str, str, str]:
    value: Any = resolved
    for word in key.dotted.split("."):
        value = value[word]
    shown = f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
    mark = "" if value == key.default else " *"
    return (key.leaf + mark, shown, key.meta.unit, key.meta.symbol, key.meta.doc)


def _kinds(design: Design) -> list[tuple[str, str, str, str]]:
    """Bodies of one kind are equal; one row each."""
    bodies = design.mechanism.bodies
    n_of_kind = Counter(body.kind for body in bodies)
    first = {body.kind: body for body in reversed(bodies)}
    return [
        (kind, str(n), str(len(first[kind].parts)), str(sum(bool(part.purchased) for part in first[kind].parts)))
        for kind, n in n_of_kind.items()
    ]
