"""What can go wrong, by name. Every message says who, what, how far, against what, and what would be right."""

from __future__ import annotations

from collections.abc import Sequence


class LinkwrightError(Exception):
    """Root of all errors that a user can cause or cure."""


class UnknownNameError(LinkwrightError):
    """A name that no table holds."""

    def __init__(self, kind: str, name: str, known: Sequence[str]) -> None:
        super().__init__(f"there is no {kind} called {name!r}; known: {', '.join(known)}")
        self.kind, self.name, self.known = kind, name, tuple(known)


class ParameterError(LinkwrightError):
    """A number outside what its field allows."""

    def __init__(self, field: str, value: object, allowed: str) -> None:
        super().__init__(f"{field} = {value!r} is not allowed: {allowed}")
        self.field, self.value, self.allowed = field, value, allowed


class DesignFileError(LinkwrightError):
    """A design file that cannot be taken: says file, line, key, value and what is allowed."""

    def __init__(self, path: str, line: int | None, key: str, value: object, allowed: str) -> None:
        place = f"{path}:{line}" if line is not None else path
        shown = "" if value is None else f" = {value!r}"
        super().__init__(f"{place}: {key}{shown}: {allowed}")
        self.path, self.line, self.key, self.value, self.allowed = path, line, key, value, allowed


class KinematicsError(LinkwrightError):
    """A pose or a set of joint values for which the mechanism has no answer."""


class BuildError(LinkwrightError):
    """A solid or a mesh that could not be made: names design, body and feature."""

    def __init__(self, where: str, what: str) -> None:
        super().__init__(f"{where}: {what}")
        self.where, self.what = where, what


class VacuousCheckError(LinkwrightError):
    """A check that would pass because it looked at nothing."""


class ReleaseError(LinkwrightError):
    """A release that could not be written or did not survive its own re-reading."""
