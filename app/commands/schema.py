"""`linkwright schema`: the JSON Schema of design files, for editors and other tools."""

from __future__ import annotations

import json
from pathlib import Path

import click

from linkwright.designs import catalogue
from linkwright.designs.file.model import combined_schema, json_schema

from ..options import debug_option, json_option, output_file_option
from ..streams import write_text


@click.command("schema", short_help="JSON Schema of design files.")
@click.argument("mechanism", required=False)
@output_file_option
@json_option
@debug_option
def command(mechanism: str | None, output: Path | None, as_json: bool) -> None:
    """JSON Schema (2020-12) of MECHANISM's design files, or of all mechanisms' together."""
    if mechanism is None:
        schema = combined_schema(catalogue.entry(name) for name in catalogue.names())
    else:
        schema = json_schema(catalogue.entry(mechanism))
    write_text(json.dumps(schema, indent=2, ensure_ascii=False) + "\n", output)
