"""`linkwright fk`: poses for values of the driven joints."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from linkwright.designs.file.reader import load_design

from ..cli import FINDINGS, PASS
from ..options import debug_option, design_argument, json_option, output_file_option, set_option
from ..rows import joint_columns, numbers_from_text, task_columns, text_of_rows
from ..streams import format_option, input_option, numbers_given, rows_given, tell_unreachable, write_text


@click.command("fk", short_help="Poses for values of the driven joints.")
@design_argument
@input_option
@output_file_option
@format_option
@click.option("--joints", multiple=True, metavar="Q1,Q2,...", help="Driven joint values in file units, repeatable.")
@click.option("--near", metavar="X,Y,...", help="A pose nearby: decides where several poses fit the joint values.")
@set_option
@json_option
@debug_option
def command(
    design: str,
    source: str | None,
    output: Path | None,
    form: str | None,
    joints: tuple[str, ...],
    near: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
) -> int:
    """Poses of DESIGN for values of its driven joints.

    Reads what `linkwright ik` writes: columns <joint>_deg or <joint>_mm as CSV or JSON lines; passive joints and the
    columns reachable and reason are accepted and not used. A row without values stays a row without a pose. Without a
    pipe, a file or --joints the joint values of the home pose are taken. --json writes JSON lines. Exit code 1 if any
    row has no pose.
    """
    mechanism = load_design(design, overrides).mechanism
    n_active, task = mechanism.n_active, task_columns(mechanism.task)
    columns = joint_columns(mechanism.joints)
    passive = tuple(column.key for column in columns[n_active:])
    home = mechanism.solve_inverse(mechanism.home[None, :]).joints[0, :n_active]
    rows = None if joints else rows_given(source, form)
    given = numbers_given(joints, "--joints", rows, columns[:n_active], passive, home)
    guess = None if near is None else numbers_from_text(near, task, "--near")
    solved = np.array([not blank for blank in given.blanks])
    reasons, poses = list(given.blanks), np.zeros((len(solved), len(task)))
    asked = np.flatnonzero(solved)
    if len(asked):
        starts = None if guess is None else np.tile(guess, (len(asked), 1))
        solution = mechanism.solve_forward(given.values[asked], starts)
        poses[asked], solved[asked] = solution.poses, solution.is_solved
        for i, row in enumerate(asked):
            reasons[row] = solution.reason(i)
    form = "jsonl" if as_json else form or (rows.form if rows else "csv")
    write_text(text_of_rows(task, poses, solved, reasons, form), output)
    tell_unreachable(int(np.sum(~solved)), len(solved), "rows")
    return PASS if solved.all() else FINDINGS
