"""`linkwright list`: the mechanisms of the catalogue."""

from __future__ import annotations

import json

import click

from linkwright.designs import catalogue

from ..options import debug_option, json_option
from ..supplies_page import print_supplies, read_supplies


@click.command("list", short_help="The mechanisms of the catalogue.")
@click.option(
    "--supplies",
    "with_supplies",
    is_flag=True,
    help="Instead the bearings, screws, motors and materials that a design file can name.",
)
@json_option
@debug_option
def command(with_supplies: bool, as_json: bool) -> None:
    """The mechanisms of the catalogue: name, what it is, source."""
    if with_supplies:
        tables = read_supplies()
        if as_json:
            click.echo(json.dumps(tables, indent=2, ensure_ascii=False))
        else:
            print_supplies(tables)
        return
    entries = [catalogue.entry(name) for name in catalogue.names()]
    if as_json:
        rows = [
            {"name": e.name, "title": e.title, "source": e.source, "task": [c.key for c in e.task]} for e in entries
        ]
        click.echo(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    width = max(len(e.name) for e in entries)
    for e in entries:
        click.echo(f"{e.name:<{width}}  {e.title}")
        click.echo(f"{'':<{width}}  {e.source}")
