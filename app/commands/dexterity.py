"""`linkwright dexterity`: how well a design moves and holds, at a pose and over a workspace."""

from __future__ import annotations

import json
from pathlib import Path

import click
import numpy as np

from linkwright.designs.file.reader import load_design

from ..cli import FINDINGS, PASS
from ..options import debug_option, design_argument, json_option, output_file_option, sampling_overrides, set_option
from ..options import poses_option as n_poses_option
from ..options import seed_option
from ..progress import progress_bars
from ..rows import numbers_from_text, task_columns
from ..streams import write_text


@click.command("dexterity", short_help="Condition, manipulability, isotropy, singularities.")
@design_argument
@click.option("--pose", metavar="X,Y,...", help="The pose to measure, in file units (default: home).")
@click.option("--grid", metavar="N[,N...]", help="Visit a grid of so many places per coordinate of position.")
@click.option("--rings", type=click.FloatRange(0.0, 180.0, min_open=True), metavar="DEG", help="Tilts in a cone.")
@click.option("--ring-count", type=click.IntRange(min=1), default=3, show_default=True, help="Rings in the cone.")
@click.option("--rolls", metavar="DEG,DEG,...", default="0", show_default=True, help="Rolls at every tilt of --rings.")
@click.option("--tool", type=click.Choice(["y", "z"]), help="Hand axis that --rings tilts (default: z, of a pen y).")
@click.option("--length", type=click.FloatRange(0.0, min_open=True), metavar="MM", help="Length for a radian of turn.")
@click.option("--motors", metavar="S,S,...", help="S_J of the index: a scale per motor (default: ones).")
@click.option("--hand", metavar="S,S,...", help="S_T of the index, N and N mm or mm/s and rad/s (default: --length).")
@click.option("--form", type=click.Choice(["force", "velocity"]), default="force", show_default=True)
@n_poses_option
@seed_option
@output_file_option
@set_option
@json_option
@debug_option
def command(
    design: str,
    pose: str | None,
    grid: str | None,
    rings: float | None,
    ring_count: int,
    rolls: str,
    tool: str | None,
    length: float | None,
    motors: str | None,
    hand: str | None,
    form: str,
    poses: int | None,
    seed: int | None,
    output: Path | None,
    overrides: tuple[str, ...],
    as_json: bool,
) -> int:
    """Measure the dexterity of DESIGN at a pose and over its workspace.

    The workspace is the declared box, sampled; with --grid or --rings it is a grid over the box's positions with tilts
    in a cone (Stocco, Salcudean, Sassani, eqs. 14-16). Turns count as lengths by --length millimetres per radian; by
    default that at which moves and turns weigh alike at home. -o writes the measures of every pose visited as CSV.
    Exit code 1 if a pose visited is out of reach.
    """
    from ..dexterity_page import PoseRequest, ScaleRequest, build_report, facts_of, print_report, text_of_survey

    loaded = load_design(design, sampling_overrides(overrides, seed, poses))
    columns = task_columns(loaded.mechanism.task)
    at = loaded.mechanism.home if pose is None else numbers_from_text(pose, columns, "--pose")
    request = PoseRequest(
        grid=_numbers(grid, "--grid", int),
        cone=None if rings is None else float(np.radians(rings)),
        n_rings=ring_count,
        rolls=tuple(float(np.radians(r)) for r in _numbers(rolls, "--rolls", float)),
        tool=tool or "",
    )
    scales = ScaleRequest(
        length=length, motors=_numbers(motors, "--motors", float), hand=_numbers(hand, "--hand", float), form=form
    )
    with progress_bars(is_wanted=not as_json) as progress:
        report = build_report(loaded, at, request, scales, progress)
    if output is not None:
        write_text(text_of_survey(report), output)
    if as_json:
        click.echo(json.dumps(facts_of(report), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print_report(report)
    return PASS if report.survey.is_reachable.all() else FINDINGS


def _numbers(text: str | None, option: str, kind: type) -> tuple:
    try:
        return tuple(kind(cell) for cell in text.split(",")) if text else ()
    except ValueError:
        raise click.BadParameter(f"{text!r} is no list of numbers with commas between", param_hint=option) from None
