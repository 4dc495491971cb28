"""`linkwright release`: a design checked, written, and read back."""

from __future__ import annotations

import json
from pathlib import Path

import click

from linkwright.designs.file.reader import load_design

from ..cli import FINDINGS, PASS
from ..options import (
    debug_option,
    design_argument,
    json_option,
    poses_option,
    sampling_overrides,
    seed_option,
    set_option,
    strict_option,
)
from ..progress import progress_bars


@click.command("release", short_help="Check a design and write all its files.")
@design_argument
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to write; all or nothing.",
)
@set_option
@seed_option
@poses_option
@strict_option
@json_option
@debug_option
def command(
    design: str,
    output: Path,
    overrides: tuple[str, ...],
    seed: int | None,
    poses: int | None,
    strict: bool,
    as_json: bool,
) -> int:
    """Check DESIGN and write its manufacturing files and controller configuration into a folder.

    Everything is verified from the written bytes before the folder appears; an older release there is replaced. A
    design that fails its checks (on any error, with --strict on any warning too) is not written: exit code 1.
    """
    loaded = load_design(design, sampling_overrides(overrides, seed, poses))
    from linkwright.analysis.report import findings_json
    from linkwright.exports.release import release
    from linkwright.generator.store import Store

    with progress_bars(is_wanted=not as_json) as progress:
        result = release(loaded, output, store=Store(None), progress=progress, strict=strict)
    if as_json:
        manifest = None if result.manifest is None else result.manifest.model_dump(mode="json")
        table = {
            "path": str(result.path),
            "written": result.written,
            "manifest": manifest,
            "findings": findings_json(result.report, loaded, strict=strict, with_places=True),
        }
        click.echo(json.dumps(table, indent=2, ensure_ascii=False, allow_nan=False))
    else:
        from ..report_page import print_release, print_report

        print_report(result.report, loaded, strict=strict, with_facts=False)
        print_release(result)
    return PASS if result.written else FINDINGS
