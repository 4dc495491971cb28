"""The page that `check` and `release` print: findings, what was looked at, what was measured, where the files are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.padding import Padding
from rich.text import Text
from rich.tree import Tree

from linkwright.analysis.findings import Finding, Report, Severity
from linkwright.analysis.report import line_of, plain
from linkwright.designs.design import Design
from linkwright.designs.language.units import file_from_inside

from .console import digits, heading, page, table_of

if TYPE_CHECKING:
    from linkwright.exports.release import ReleaseResult

_STYLES = {Severity.ERROR: "bold red", Severity.WARNING: "bold yellow", Severity.NOTE: "bold cyan"}

#: A table of facts with more rows than this is cut on the page; `--json` holds all of it.
_MAX_ROWS = 40

_MANIFEST = "manifest.json"

#: A longer list of numbers is told by its range.
_MAX_NUMBERS = 8

#: What lies in a release's folder, and for whom.
_PURPOSES = {
    "cad/assembly.step": "the whole device for the CAD system: names, colours, nesting",
    "cad/parts": "a STEP file per part, for the machinist",
    "mesh": "an STL per part, for the 3D printer, in mm",
    "controller/kinematics.json": "for the controller, SI units",
    "design.toml": "the design, every number resolved",
    "findings.json": "all checks and what they measured",
    "preview.png": "picture of the assembly",
    _MANIFEST: "parts list, masses, sha256 of every file, versions of the tools",
}

#: A folder with more files is told by their number.
_MAX_FILES = 6


def print_report(report: Report, design: Design, *, strict: bool, with_facts: bool = True) -> None:
    """Findings with their places, what each check looked at, and the measured facts."""
    console = page()
    for finding in report.findings:
        _print_finding(console, finding, design)
    heading(console, "looked at")
    rows = [
        (r.check, ", ".join(f"{n} {what}" for what, n in r.looked_at.items()), str(len(r.findings)))
        for r in report.results
    ]
    console.print(table_of(("check", "looked at", "findings"), rows, right=(2,)))
    if with_facts:
        for result in report.results:
            if result.facts:
                heading(console, f"{result.check}: measured")
                _print_facts(console, plain(result.facts, result.check))
    counts = ", ".join(f"{report.count(s)} {s.value}{'' if report.count(s) == 1 else 's'}" for s in Severity)
    passes = report.passes(strict=strict)
    console.print()
    console.print(
        Text.assemble(
            (("PASS" if passes else "FAIL"), "bold green" if passes else "bold red"),
            f"  {design.name}: {counts}{' (strict)' if strict else ''}, design {design.hash[:12]}",
        )
    )


def print_release(result: ReleaseResult) -> None:
    """Where the files are and what each is for; large folders as their number of files."""
    console = page()
    if result.manifest is None:
        console.print(f"nothing was written to {result.path}")
        return
    manifest = result.manifest
    names = [*(row.path for row in manifest.files), _MANIFEST]
    folders: dict[str, list[str]] = {}
    for name in sorted(names):
        folders.setdefault(str(PurePosixPath(name).parent), []).append(name)
    tree = Tree(Text(str(result.path), style="bold"))
    for folder, files in folders.items():
        branch = tree if folder == "." else tree.add(_labelled(f"{folder}/", folder))
        if len(files) > _MAX_FILES and folder != ".":
            endings = ", ".join(sorted({PurePosixPath(name).suffix for name in files}))
            branch.add(Text(f"{len(files)} files {endings}"))
            continue
        for name in files:
            branch.add(_labelled(PurePosixPath(name).name, name))
    console.print(tree)
    n_made = sum(row.count for row in manifest.parts if not row.purchased)
    n_bought = sum(row.count for row in manifest.parts if row.purchased)
    console.print(f"{len(names)} files; {n_made} parts to make, {n_bought} to buy; {digits(manifest.mass_kg, 4)} kg")


def _labelled(shown: str, name: str) -> Text:
    purpose = _PURPOSES.get(name)
    return Text.assemble(shown, (f"  {purpose}", "dim")) if purpose else Text(shown)


def _print_finding(console: Console, finding: Finding, design: Design) -> None:
    """Rule and subjects; the message; then one line each for numbers, pose, place and cure."""
    console.print(
        Text.assemble(
            (finding.severity.value, _STYLES[finding.severity]),
            f" [{finding.rule}] ",
            (" / ".join(finding.subject), "bold"),
        )
    )
    _indented(console, finding.message)
    if finding.measured is not None:
        limit = "" if finding.limit is None else f", limit {digits(finding.limit)} {finding.unit}"
        _indented(console, f"measured {digits(finding.measured)} {finding.unit}{limit}")
    if finding.pose:
        _indented(console, f"at pose {', '.join(f'{key} = {digits(v)}' for key, v in finding.pose.items())}")
    if finding.location is not None:
        _indented(console, f"at point {', '.join(digits(v) for v in finding.location)} mm in the base")
    if finding.key:
        line = line_of(design, finding.key)
        place = f" ({design.path}:{line})" if line is not None else f" ({design.path})" if design.path else ""
        _indented(console, f"governed by {finding.key}{place}")
    if finding.suggestion:
        _indented(console, f"to cure it: {finding.suggestion}")


def _indented(console: Console, text: str) -> None:
    console.print(Padding(Text(text), (0, 0, 0, 4)))


def _print_facts(console: Console, facts: Mapping[str, Any]) -> None:
    """Plain facts as a list; a list of mappings, or a mapping of them, as a table."""
    for name, value in facts.items():
        rows = _as_limits(value) or _as_rows(value)
        if rows is None:
            console.print(f"{name}: {_shown(value)}")
            continue
        columns = list(dict.fromkeys(column for row in rows for column in row))
        cells = [[_shown(row.get(column, "")) for column in columns] for row in rows[:_MAX_ROWS]]
        right = [i for i, c in enumerate(columns) if all(_is_number(row.get(c)) for row in rows)]
        console.print(f"{name}:")
        console.print(table_of(columns, cells, right=right))
        if len(rows) > _MAX_ROWS:
            console.print(f"... and {len(rows) - _MAX_ROWS} more; --json shows all")


def _as_limits(value: Any) -> Sequence[Mapping[str, Any]] | None:
    """Measured joint limits beside the declared ones, angles in degrees; None for any other fact."""
    if not isinstance(value, dict) or not value or not all(isinstance(v, dict) for v in value.values()):
        return None
    if not all({"lower", "upper", "declared_lower", "declared_upper", "unit"} <= set(v) for v in value.values()):
        return None
    rows = []
    for joint, row in value.items():
        unit = "deg" if row["unit"] == "rad" else row["unit"]
        ends = {end: file_from_inside(row[end], unit) for end in ("lower", "declared_lower", "declared_upper", "upper")}
        stops = [row.get(f"stopped_{side}_by") for side in ("below", "above")]
        stopped = "nothing" if row.get("unlimited") else "; ".join(dict.fromkeys(stop for stop in stops if stop))
        rows.append(
            {
                "joint": joint,
                **{end.replace("_", " "): f"{v:.2f}" for end, v in ends.items()},
                "unit": unit,
                "stopped by": stopped,
            }
        )
    return rows


def _as_rows(value: Any) -> Sequence[Mapping[str, Any]] | None:
    if isinstance(value, list) and value and all(isinstance(v, dict) for v in value):
        return value
    if isinstance(value, dict) and value and all(isinstance(v, dict) for v in value.values()):
        return [{"": key, **row} for key, row in value.items()]
    return None


def _shown(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return "-" if value is None else str(value).lower()
    if isinstance(value, float):
        return digits(value)
    if isinstance(value, dict):
        return ", ".join(f"{k} {_shown(v)}" for k, v in value.items())
    if isinstance(value, list):
        if len(value) > _MAX_NUMBERS and all(isinstance(v, int | float) for v in value):
            return f"{len(value)} numbers, {digits(min(value))} to {digits(max(value))}"
        return ", ".join(_shown(v) for v in value) or "none"
    return str(value)


def _is_number(value: Any) -> bool:
    """A number, or a text that shows one."""
    if isinstance(value, str):
        return value.removeprefix("-").replace(".", "", 1).isdigit()
    return isinstance(value, int | float)
