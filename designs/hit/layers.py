"""Where along the motor axes each bar of a sub-chain lies, so that bars may cross in projection without touching.

From inside to outside: upper bars | lower bars and top bar (the plane of the pin and the ball) | inner upper bar |
elbow plate | inner lower bar. The elbow plate lies between the two inner bars, because at low poses the inner upper
bar passes straight over the pin on which the inner lower bar turns.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..chains.pivot import Run
from ..language.supplies import Bearing
from .parameters import HitLinks


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A layer from z = low to z = high along the motor axes [mm]."""

    low: float
    high: float

    def run(self, lip: float, *, opens_up: bool) -> Run:
        """The bearings in this layer's eyes: all of it but the lip."""
        return Run(low=self.low + lip, high=self.high) if opens_up else Run(low=self.low, high=self.high - lip)


@dataclass(frozen=True, slots=True, kw_only=True)
class Layers:
    """All layers of a sub-chain."""

    upper: Layer
    middle: Layer
    inner_upper: Layer
    elbow: Layer
    inner_lower: Layer


def stack_layers(links: HitLinks, row: Bearing) -> Layers:
    """Layers as thick as two bearings and a lip (elbow plate: one bearing), with equal air between them."""
    thick, thin, gap = 2.0 * row.width + links.lip, row.width + links.lip, links.layer_gap
    half = thick / 2.0
    inner_upper = Layer(low=half + gap, high=half + gap + thick)
    elbow = Layer(low=inner_upper.high + gap, high=inner_upper.high + gap + thin)
    return Layers(
        upper=Layer(low=-half - gap - thick, high=-half - gap),
        middle=Layer(low=-half, high=half),
        inner_upper=inner_upper,
        elbow=elbow,
        inner_lower=Layer(low=elbow.high + gap, high=elbow.high + gap + thick),
    )
