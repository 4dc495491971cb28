"""`linkwright ik`: joint values for poses."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from linkwright.designs.file.reader import load_design

from ..cli import FINDINGS, PASS
from ..options import debug_option, design_argument, json_option, output_file_option, set_option
from ..rows import joint_columns, task_columns, text_of_rows
from ..streams import format_option, input_option, numbers_given, rows_given, tell_unreachable, write_text


@click.command("ik", short_help="Joint values for poses.")
@design_argument
@input_option
@output_file_option
@format_option
@click.option("--pose", "poses", multiple=True, metavar="X,Y,...", help="A pose in file units, repeatable.")
@click.option("--branch", help="Working mode of the inverse (default: the first; `show` lists them).")
@click.option("--all", "with_passive", is_flag=True, help="Passive joints too, after the active ones.")
@set_option
@json_option
@debug_option
def command(
    design: str,
    source: str | None,
    output: Path | None,
    form: str | None,
    poses: tuple[str, ...],
    branch: str | None,
    with_passive: bool,
    overrides: tuple[str, ...],
    as_json: bool,
) -> int:
    """Joint values for poses of DESIGN.

    Poses come as CSV or JSON lines with a column per task coordinate (for a platform in space
    x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg, turned about the fixed axes X, Y, Z in this order). Joint values go out as
    <joint>_deg or <joint>_mm with the columns reachable and reason. Without a pipe, a file or --pose the home pose is
    taken. --json writes JSON lines. Exit code 1 if any pose is out of reach.
    """
    mechanism = load_design(design, overrides).mechanism
    rows = None if poses else rows_given(source, form)
    given = numbers_given(poses, "--pose", rows, task_columns(mechanism.task), (), mechanism.home)
    solution = mechanism.solve_inverse(given.values, branch)
    reachable = np.array([ok and not blank for ok, blank in zip(solution.is_reachable, given.blanks, strict=True)])
    reasons = [blank or solution.reason(i) for i, blank in enumerate(given.blanks)]
    n_shown = len(mechanism.joints) if with_passive else mechanism.n_active
    columns = joint_columns(mechanism.joints[:n_shown])
    form = "jsonl" if as_json else form or (rows.form if rows else "csv")
    write_text(text_of_rows(columns, solution.joints[:, :n_shown], reachable, reasons, form), output)
    tell_unreachable(int(np.sum(~reachable)), len(reachable), "poses")
    return PASS if reachable.all() else FINDINGS
