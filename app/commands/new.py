"""`linkwright new`: a commented design file to start from."""

from __future__ import annotations

import json
from pathlib import Path

import click

from linkwright.designs import catalogue
from linkwright.designs.file.writer import example_of

from ..options import debug_option, json_option


@click.command("new", short_help="Write a commented design file to start from.")
@click.argument("mechanism")
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to write (default: MECHANISM.toml); - writes to stdout.",
)
@click.option("--force", is_flag=True, help="Overwrite the file if it exists.")
@json_option
@debug_option
def command(mechanism: str, output: Path | None, force: bool, as_json: bool) -> None:
    """Write a commented design file of MECHANISM, every key with its default, unit, meaning and bounds."""
    entry = catalogue.entry(mechanism)
    text = example_of(entry.name, entry=entry)
    if output is not None and str(output) == "-":
        click.echo(text, nl=False)
        return
    path = output or Path(f"{entry.name}.toml")
    if path.exists() and not force:
        raise click.ClickException(f"{path} exists; give another name with -o, or --force to overwrite it")
    path.write_text(text, encoding="utf-8")
    if as_json:
        click.echo(json.dumps({"path": str(path), "mechanism": entry.name}))
    else:
        click.echo(f"wrote {path}; next: linkwright show {path}, linkwright check {path}")
