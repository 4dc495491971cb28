"""A report as plain JSON values: what `check --json` prints and `findings.json` of a release holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum
from typing import Any

import numpy as np

from linkwright.designs.design import Design

from .findings import CheckResult, Finding, Report, Severity

#: Grows when a key changes its meaning or goes away; new keys do not change it.
SCHEMA_VERSION = 1


def findings_json(report: Report, design: Design, *, strict: bool = False, with_places: bool = False) -> dict[str, Any]:
    """The report as nested JSON values, equal for equal designs.

    Args:
        report: of all checks.
        design: that was checked; named by its hash.
        strict: whether warnings fail the design.
        with_places: add file and line of each finding's key. They depend on how the design file is laid out, so a
            release leaves them out.

    Raises:
        ValueError: a fact is no JSON value (NaN, infinity, an object); it names where.
    """
    summary = {f"n_{severity.value}s": report.count(severity) for severity in Severity}
    return {
        "schema_version": SCHEMA_VERSION,
        "design": design.name,
        "mechanism": design.mechanism.name,
        "design_hash": design.hash,
        "summary": {"passes": report.passes(strict=strict), "strict": strict, **summary},
        "checks": [_check(result, design, with_places) for result in report.results],
    }


def line_of(design: Design, key: str) -> int | None:
    """Line of a dotted key in the design's file, or of the nearest table around it that the file has."""
    while key:
        if key in design.lines:
            return design.lines[key]
        key = key.rpartition(".")[0]
    return None


def _check(result: CheckResult, design: Design, with_places: bool) -> dict[str, Any]:
    return {
        "check": result.check,
        "looked_at": plain(result.looked_at, f"{result.check}.looked_at"),
        "facts": plain(result.facts, f"{result.check}.facts"),
        "findings": [_finding(f, design, with_places) for f in result.findings],
    }


def _finding(finding: Finding, design: Design, with_places: bool) -> dict[str, Any]:
    where = f"finding {finding.rule}"
    table: dict[str, Any] = {
        "rule": finding.rule,
        "severity": finding.severity.value,
        "subject": list(finding.subject),
        "message": finding.message,
        "pose": plain(finding.pose, where),
        "measured": plain(finding.measured, where),
        "limit": plain(finding.limit, where),
        "unit": finding.unit,
        "location_mm": plain(finding.location, where),
        "key": finding.key,
        "suggestion": finding.suggestion,
    }
    if with_places:
        table |= {"path": design.path, "line": line_of(design, finding.key)}
    return table


def plain(value: Any, where: str) -> Any:
    """The value with numpy's numbers and arrays, tuples and enums as plain JSON values.

    Raises:
        ValueError: it is no JSON value; `where` is named.
    """
    if isinstance(value, Enum):
        return plain(value.value, where)
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), where)
    if isinstance(value, Mapping):
        return {str(k): plain(v, f"{where}.{k}") for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v, f"{where}.{i}") for i, v in enumerate(value)]
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{where} is {value}, which no report may hold")
        return value
    raise ValueError(f"{where} is a {type(value).__name__}, which is no JSON value")
