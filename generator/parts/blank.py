"""A blank: the uncut solid of a part, the tools that cut it, and the volumes that the numbers imply."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .holes import Tool


@dataclass(frozen=True, slots=True, kw_only=True)
class Blank:
    """The solid before anything is cut from it.

    Attributes:
        shape: of the kernel.
        volume: lower and upper bound that follow from the numbers alone [mm3].
        tools: what is cut from it.
        cut_volume: bounds of the finished part's volume [mm3].
    """

    shape: Any
    volume: tuple[float, float]
    tools: tuple[Tool, ...]
    cut_volume: tuple[float, float]
