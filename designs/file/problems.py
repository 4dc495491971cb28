"""What is wrong with a design file, in sentences: each names file, line, key, value and what would be right."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..language.errors import DesignFileError
from .keys import Key, did_you_mean, did_you_mean_key

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

#: Stands where a file's name would stand when the command line gave the value.
COMMAND_LINE = "--set"

_KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "text in quotes"}
_TYPES = {bool: "true or false", int: "a whole number", float: "a number", str: "text", dict: "a table", list: "a list"}


class DesignFileErrors(DesignFileError):
    """Several errors in one design file; one line each.

    Attributes:
        errors: all of them, in the order of the file.
    """

    def __init__(self, errors: Sequence[DesignFileError]) -> None:
        first = errors[0]
        super().__init__(first.path, first.line, first.key, first.value, first.allowed)
        self.errors = tuple(errors)
        self.args = ("\n".join(str(error) for error in errors),)


class Places:
    """Where each key of one design was given: a line of the file, or the command line."""

    def __init__(self, path: str, lines: Mapping[str, int], overridden: Collection[str]) -> None:
        self.path, self.lines, self.overridden = path, lines, overridden

    def error(self, dotted: str, value: object, allowed: str) -> DesignFileError:
        """An error about one key, placed."""
        if self._is_overridden(dotted):
            return DesignFileError(COMMAND_LINE, None, dotted, value, allowed)
        return DesignFileError(self.path, self.line_of(dotted), dotted, value, allowed)

    def _is_overridden(self, dotted: str) -> bool:
        """The command line gave the key, a table around it, or all that a table holds which the file lacks."""
        is_absent = dotted not in self.lines
        return any(
            dotted == given or dotted.startswith(f"{given}.") or (is_absent and given.startswith(f"{dotted}."))
            for given in self.overridden
        )

    def line_of(self, dotted: str) -> int | None:
        """Line of the key, or of the nearest table around it that the file has."""
        while dotted:
            if dotted in self.lines:
                return self.lines[dotted]
            dotted = dotted.rpartition(".")[0]
        return None


def raise_all(errors: Sequence[DesignFileError]) -> None:
    """Raise what was found: nothing, the one error, or all together in the order of the file."""
    if len(errors) == 1:
        raise errors[0]
    if errors:
        raise DesignFileErrors(sorted(errors, key=lambda e: (e.line is None, e.line or 0)))


def describe(detail: ErrorDetails, keys: Mapping[str, Key]) -> tuple[str, object, str]:
    """Dotted key, offending value (None for a table) and what is allowed, for one error of the model."""
    dotted = ".".join(str(word) for word in detail["loc"])
    value = detail["input"]
    shown = None if isinstance(value, dict | list) else value
    if detail["type"] == "extra_forbidden":
        return dotted, shown, _unknown(dotted, value, keys)
    if detail["type"] == "missing":
        return dotted, None, f"is required{_about(keys.get(dotted))}"
    if dotted.startswith("allowed"):
        return dotted, shown, _allowed_contact(detail)
    key = keys.get(dotted)
    if key is None:
        return dotted, shown, f"must be a table of keys, not {_type_of(value)}"
    return dotted, shown, _wrong_value(key, value, detail["type"])


def _unknown(dotted: str, value: Any, keys: Mapping[str, Key]) -> str:
    tables = sorted({key.table for key in keys.values() if key.table} | {"allowed"})
    if isinstance(value, dict):
        return f"there is no such table{did_you_mean(dotted, tables) or '; known: ' + ', '.join(tables)}"
    hint = did_you_mean_key(dotted, keys)
    if not hint:
        table = dotted.rpartition(".")[0]
        leaves = [key.leaf for key in keys.values() if key.table == table]
        leaves += [t for t in tables if not table and "." not in t]
        hint = f"; known: {', '.join(leaves)}" if leaves else ""
    return f"there is no such key{hint}"


def _wrong_value(key: Key, value: Any, kind_of_error: str) -> str:
    if key.meta.choices:
        hint = did_you_mean(value, key.meta.choices) if isinstance(value, str) else ""
        return key.meta.allowed() + hint
    if key.dotted == "name":
        return "must be text of letters, digits, _ - and . that can name a file"
    if not isinstance(value, key.kind) or isinstance(value, bool):
        is_number = key.kind is float and isinstance(value, int) and not isinstance(value, bool)
        if not is_number:
            bounds = "" if key.kind in (str, bool) else f"; {key.meta.allowed()}"
            other = "" if isinstance(value, float) else f", not {_type_of(value)}"
            return f"must be {_KINDS[key.kind]}{other}{bounds}"
    if kind_of_error == "finite_number":
        return "must be a finite number"
    return f"{key.meta.allowed()} (default {_number(key)})"


def _allowed_contact(detail: ErrorDetails) -> str:
    kind = detail["type"]
    if kind in ("too_short", "too_long"):
        return 'must name exactly two bodies, such as pair = ["base", "platform"]'
    if kind == "string_too_short":
        return "must say why the two bodies may touch"
    return "must be text in quotes" if kind == "string_type" else "must be [[allowed]] tables of `pair` and `reason`"


def _type_of(value: Any) -> str:
    return next((word for kind, word in _TYPES.items() if isinstance(value, kind)), type(value).__name__)


def _about(key: Key | None) -> str:
    return f": {key.meta.doc}" if key else ""


def _number(key: Key) -> str:
    return f"{key.default:g} {key.meta.unit}".strip() if isinstance(key.default, int | float) else str(key.default)
