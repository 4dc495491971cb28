"""`linkwright check`: the solids of a design against what the design asks of them."""

from __future__ import annotations

import json

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


@click.command("check", short_help="Check the solids: collisions, clearances, joint limits.")
@design_argument
@set_option
@seed_option
@poses_option
@strict_option
@json_option
@debug_option
def command(
    design: str, overrides: tuple[str, ...], seed: int | None, poses: int | None, strict: bool, as_json: bool
) -> int:
    """Build the solids of DESIGN and check them: interference, clearance, joint limits as measured, and more.

    Exit code 1 if the design fails: on any error, with --strict on any warning too.
    """
    loaded = load_design(design, sampling_overrides(overrides, seed, poses))
    # Kernels and meshers take seconds to load: only here, where they are used.
    from linkwright.analysis.feasibility import check_design
    from linkwright.analysis.report import findings_json
    from linkwright.generator.assembly import build_assembly
    from linkwright.generator.store import Store

    with progress_bars(is_wanted=not as_json) as progress:
        store = Store(None)
        assembly = build_assembly(loaded, store=store, progress=progress)
        report = check_design(assembly, store=store, progress=progress)
    if as_json:
        table = findings_json(report, loaded, strict=strict, with_places=True)
        click.echo(json.dumps(table, indent=2, ensure_ascii=False, allow_nan=False))
    else:
        from ..report_page import print_report

        print_report(report, loaded, strict=strict)
    return PASS if report.passes(strict=strict) else FINDINGS
