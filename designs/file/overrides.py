"""Values given on the command line as `--set key=value`, laid over a design file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..language.errors import DesignFileError
from .keys import Key
from .positions import words_of
from .problems import COMMAND_LINE


@dataclass(frozen=True, slots=True, kw_only=True)
class Override:
    """One `key=value`: the words of its dotted key and the text of its value."""

    words: tuple[str, ...]
    text: str

    @property
    def dotted(self) -> str:
        """The key as written."""
        return ".".join(self.words)


def parse_overrides(texts: Sequence[str]) -> tuple[Override, ...]:
    """The overrides in their order; of two for one key the later holds.

    Raises:
        DesignFileError: a text is not `key=value`.
    """
    parsed: dict[str, Override] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        try:
            words = words_of(key.strip()) if equals and "\n" not in key else []
        except tomllib.TOMLDecodeError:
            words = []
        if not words:
            raise DesignFileError(
                COMMAND_LINE, None, text, None, "must be key=value with a dotted key, such as sampling.n_poses=200"
            )
        override = Override(words=tuple(words), text=value.strip())
        parsed.pop(override.dotted, None)
        parsed[override.dotted] = override
    return tuple(parsed.values())


def lay_over(table: dict[str, Any], overrides: Sequence[Override], keys: Mapping[str, Key]) -> None:
    """Write the overrides into a nested table as if the file held them.

    Raises:
        DesignFileError: a key goes through something that is no table.
    """
    for override in overrides:
        here = table
        for i, word in enumerate(override.words[:-1]):
            here = here.setdefault(word, {})
            if not isinstance(here, dict):
                through = ".".join(override.words[: i + 1])
                raise DesignFileError(COMMAND_LINE, None, override.dotted, None, f"{through} is not a table")
        here[override.words[-1]] = value_of(override.text, keys.get(override.dotted))


def value_of(text: str, key: Key | None) -> Any:
    """The value that TOML reads in this text, or the text itself where TOML reads none.

    Under a key that holds text an unquoted value is text too, even if it looks like a number (a bearing "688").
    """
    try:
        table = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    value = table["value"]
    if set(table) != {"value"} or (key is not None and key.kind is str and not isinstance(value, str)):
        return text
    return value
