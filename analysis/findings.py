"""What a check says: findings as data. A check reports and decides nothing; the report draws the sum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any


class Severity(StrEnum):
    """How bad it is: an error fails the design, a warning does so only under --strict."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One fact about a design that its designer must know.

    Attributes:
        rule: short id of the rule ("interference", "joint-limit").
        severity: see `Severity`.
        subject: the parts, bodies or joint concerned.
        message: who, what, how far, against what.
        pose: task coordinates of the pose, in file units, keyed by column; None if it does not depend on one.
        measured, limit, unit: the numbers compared; None where there are none.
        location: point in the base frame [mm], or None.
        key: dotted key of the design file that governs it; its line is known to the design.
        suggestion: what would cure it.
    """

    rule: str
    severity: Severity
    subject: tuple[str, ...]
    message: str
    pose: Mapping[str, float] | None = None
    measured: float | None = None
    limit: float | None = None
    unit: str = ""
    location: tuple[float, float, float] | None = None
    key: str = ""
    suggestion: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckResult:
    """What one check looked at, what it measured, and what it found.

    Attributes:
        check: name of the check ("clearance").
        looked_at: counts of what was looked at ({"poses": 1000, "pairs": 406}); never all zero.
        findings: possibly none.
        facts: measured numbers worth keeping even when nothing is wrong (plain JSON values).
    """

    check: str
    looked_at: Mapping[str, int]
    findings: tuple[Finding, ...] = ()
    facts: Mapping[str, Any] = field(default_factory=dict)


def facts_from_result(result: CheckResult) -> dict[str, Any]:
    """A result as plain JSON values, to be noted and recalled."""
    return asdict(result)


def result_from_facts(facts: Mapping[str, Any]) -> CheckResult:
    """The inverse of `facts_from_result`."""
    findings = []
    for row in facts["findings"]:
        place = row["location"]
        kept = {**row, "severity": Severity(row["severity"]), "subject": tuple(row["subject"])}
        findings.append(Finding(**{**kept, "location": None if place is None else (place[0], place[1], place[2])}))
    return CheckResult(**{**facts, "findings": tuple(findings)})


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """The results of all checks of one design."""

    results: tuple[CheckResult, ...]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, errors first."""
        order = list(Severity)
        return tuple(sorted((f for r in self.results for f in r.findings), key=lambda f: order.index(f.severity)))

    def count(self, severity: Severity) -> int:
        """How many findings are of this severity."""
        return sum(f.severity is severity for f in self.findings)

    def passes(self, *, strict: bool = False) -> bool:
        """No error, and under `strict` no warning either."""
        return self.count(Severity.ERROR) == 0 and not (strict and self.count(Severity.WARNING))
