"""The sections of numbers of a mechanism: given ones checked, missing ones at their defaults."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..language.errors import ParameterError
from ..language.parameters import check_section


def resolve_sections(classes: Mapping[str, type], given: Mapping[str, Any]) -> dict[str, Any]:
    """An instance of every section, in the order of `classes`.

    Raises:
        ParameterError: a number outside its bounds; names section and key.
    """
    sections = {key: given.get(key) or cls() for key, cls in classes.items()}
    for key, section in sections.items():
        try:
            check_section(section)
        except ParameterError as error:
            raise ParameterError(f"{key}.{error.field}", error.value, error.allowed) from None
    return sections


def check_order(limits: Any, names: Sequence[str]) -> None:
    """Refuse joint limits whose `<name>_min` is not below their `<name>_max`.

    Raises:
        ParameterError: names the upper limit.
    """
    for name in names:
        low, high = getattr(limits, f"{name}_min"), getattr(limits, f"{name}_max")
        if low >= high:
            raise ParameterError(
                f"joint_limits.{name}_max_deg",
                math.degrees(high),
                f"must be above {name}_min_deg = {math.degrees(low):g}",
            )
