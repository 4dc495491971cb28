"""`linkwright dexterity`: how well a design moves and holds, at a pose and over a workspace."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from linkwright.designs.file.reader import load_design
from linkwright.designs.language.units import DEG, SUFFIXES, file_from_inside

from ..cli import FINDINGS, PASS
from ..options import (
    debug_option,
    design_argument,
    json_option,
    poses_option,
    sampling_overrides,
    seed_option,
    set_option,
)
from ..progress import progress_bars
from ..rows import numbers_from_text, task_columns
from ..streams import write_text

if TYPE_CHECKING:
    from rich.console import Console

    from linkwright.analysis.dexterity.report import DexterityReport

#: Requirements that the page lists; --json holds all.
_N_MARGINS = 8


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
@poses_option
@seed_option
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="CSV file to write beside the page: every pose surveyed, with its measures.",
)
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
    default that at which moves and turns weigh alike at home. The index takes every pose; of a set of more than 50000
    the other measures take so many, evenly spread. Exit code 1 if a pose visited is out of reach.
    """
    loaded = load_design(design, sampling_overrides(overrides, seed, poses))
    # Kernels take a moment to load: only here, where they are used.
    from linkwright.analysis.dexterity.report import PoseRequest, build_report, report_facts
    from linkwright.analysis.dexterity.scaling import Form, Scaling

    request = PoseRequest(
        grid=tuple(int(n) for n in _numbers(grid, "--grid", whole=True)),
        cone=None if rings is None else rings * DEG,
        n_rings=ring_count,
        rolls=tuple(roll * DEG for roll in _numbers(rolls, "--rolls")),
        tool=tool or "",
    )
    scaling = None
    if motors or hand:
        scaling = Scaling(motors=_numbers(motors, "--motors"), hand=_numbers(hand, "--hand"), form=Form(form))
    at = None if pose is None else numbers_from_text(pose, task_columns(loaded.mechanism.task), "--pose")
    with progress_bars(is_wanted=not as_json) as progress:
        report = build_report(loaded, at, request, length=length, scaling=scaling, progress=progress)
    if output is not None:
        write_text(_rows_of_survey(report), output)
    if as_json:
        click.echo(json.dumps(report_facts(report), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        _print(report)
    return PASS if report.survey.is_reachable.all() and not report.isotropy.n_unreachable else FINDINGS


def _numbers(text: str | None, option: str, *, whole: bool = False) -> tuple[float, ...]:
    """The numbers of an option; none if it is not given."""
    try:
        return tuple(float(int(cell)) if whole else float(cell) for cell in text.split(",")) if text else ()
    except ValueError:
        raise click.BadParameter(f"{text!r} is no list of numbers with commas between", param_hint=option) from None


def _rows_of_survey(report: DexterityReport) -> str:
    """Every pose visited with its measures, as CSV; no measures where the pose is out of reach."""
    from linkwright.analysis.dexterity.measures import MEASURES

    survey, task = report.survey, report.design.mechanism.task
    factors = np.array([SUFFIXES[c.unit] for c in task])
    lines = [",".join([*(c.key for c in task), "reachable", *MEASURES])]
    for pose, ok, values in zip(survey.poses / factors, survey.is_reachable, survey.values, strict=True):
        cells = [f"{v:.15g}" if ok and np.isfinite(v) else "" for v in values]
        lines.append(",".join([*(f"{v + 0.0:.15g}" for v in pose), "true" if ok else "false", *cells]))
    return "\n".join(lines) + "\n"


def _print(report: DexterityReport) -> None:
    from ..console import digits, heading, page, table_of

    console = page()
    _print_pose(console, report)
    _print_workspace(console, report)
    isotropy = report.isotropy
    heading(console, f"global isotropy index over {isotropy.n_poses} poses: {digits(isotropy.index, 4)}")
    if isotropy.n_unreachable:
        rest = digits(isotropy.index_of_reachable, 4)
        console.print(f"{isotropy.n_unreachable} poses are out of reach; over the others it is {rest}")
    console.print(f"least singular value {digits(isotropy.least)} at {_place(report, isotropy.pose_of_least)}")
    console.print(f"greatest singular value {digits(isotropy.greatest)} at {_place(report, isotropy.pose_of_greatest)}")
    if report.loci:
        heading(console, "singular curves (points: --json)")
        curves = [(q.name, q.kind.value, str(len(q.points))) for q in report.loci]
        console.print(table_of(("curve", "kind", "points"), curves, right=(2,)))


def _print_pose(console: Console, report: DexterityReport) -> None:
    """What holds at the pose, and the singular poses nearest to it."""
    from linkwright.analysis.dexterity.measures import MEASURES
    from linkwright.analysis.dexterity.report import active_joints

    from ..console import digits, heading, table_of

    heading(console, f"{report.design.name} at {_place(report, report.pose)}")
    if report.length != 1.0:
        console.print(f"a radian of turn counts as {digits(report.length, 4)} mm")
    values = [(name, digits(v)) for name, v in zip(MEASURES, report.values, strict=True)]
    console.print(table_of(("measure", "value"), values, right=(1,)))
    least = min(zip(report.levers, active_joints(report.design.mechanism), strict=True), key=lambda row: row[0])
    console.print(f"shortest lever: {least[1].name}, {digits(least[0], 4)} mm per unit of its motor")
    for of, ellipsoid in zip(("moves [mm]", "turns [rad]"), report.ellipsoids, strict=False):
        axes = ", ".join(digits(v, 4) for v in ellipsoid.semi_axes)
        console.print(f"ellipsoid of {of} for motor rates of length one: semi-axes {axes}")
    heading(console, "nearest singular poses")
    rows = [(s.kind.value, digits(s.distance, 4), _place(report, s.pose)) for s in report.singularities]
    console.print(table_of(("kind", "mm away", "pose"), rows, right=(1,)) if rows else "none found near the workspace")


def _print_workspace(console: Console, report: DexterityReport) -> None:
    """Ends and middle of every measure, and the requirements that come nearest."""
    from ..console import digits, heading, table_of

    survey = report.survey
    n, n_out = len(survey.poses), int(np.sum(~survey.is_reachable))
    of_all = "" if n == report.isotropy.n_poses else f" of {report.isotropy.n_poses}"
    heading(console, f"workspace: {n}{of_all} poses, {n_out} out of reach")
    spreads = [
        (s.name, digits(s.least, 4), digits(s.median, 4), digits(s.greatest, 4), _place(report, s.pose_of_least))
        for s in survey.spreads
    ]
    columns = ("measure", "least", "median", "greatest", "least at")
    console.print(table_of(columns, spreads, right=(1, 2, 3), whole=(0,)))
    console.print(f"poses beyond a parallel singularity, seen from home: {survey.n_other_assembly}")
    heading(console, "requirements that come nearest")
    nearest = [(m.requirement, digits(m.margin, 4), _place(report, m.pose)) for m in survey.margins[:_N_MARGINS]]
    console.print(table_of(("requirement", "margin [mm, rad, or none]", "at"), nearest, right=(1,)))


def _place(report: DexterityReport, pose: np.ndarray) -> str:
    """A pose in file units, for reading."""
    named = zip(report.design.mechanism.task, pose, strict=True)
    return ", ".join(f"{c.name} {file_from_inside(float(v), c.unit):.4g}" for c, v in named)
