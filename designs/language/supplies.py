"""What can be bought, by its catalogue name: bearings, screws, clips, shims and motors with their true dimensions.

The tables are `designs/supplies/*.csv`. Inside, lengths are mm, loads N, torques N mm, masses kg.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib.resources import files
from typing import Any, ClassVar

from .errors import ParameterError, UnknownNameError
from .materials import material, material_names
from .tables import Chain, read_table

__all__ = [
    "Bearing",
    "Clip",
    "Motor",
    "Screw",
    "ScrewKind",
    "Shim",
    "bearing",
    "clip",
    "material_names",
    "motor",
    "names",
    "screw",
    "shim",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Bearing:
    """A deep groove ball bearing with two metal shields.

    Attributes:
        name: designation ("MR104ZZ").
        bore, outer, width: boundary dimensions [mm].
        inner_land: outer diameter of the inner ring's face [mm].
        outer_land: inner diameter of the outer ring's face [mm].
        shaft_shoulder_min, shaft_shoulder_max: diameters between which a shoulder, sleeve or shim must lie that
            touches the inner ring only [mm].
        housing_shoulder_max: largest bore of a housing's lip that still holds the outer ring [mm].
        dynamic_load, static_load: basic radial load ratings [N].
        mass: [kg].
    """

    name: str
    bore: float
    outer: float
    width: float
    inner_land: float
    outer_land: float
    shaft_shoulder_min: float
    shaft_shoulder_max: float
    housing_shoulder_max: float
    dynamic_load: float
    static_load: float
    mass: float
    source: str

    grows: ClassVar[tuple[Chain, ...]] = (
        ("bore", "inner_land", "outer_land", "outer"),
        ("bore", "shaft_shoulder_min", "shaft_shoulder_max", "housing_shoulder_max", "outer"),
        ("static_load", "dynamic_load"),
    )
    may_be_zero: ClassVar[tuple[str, ...]] = ()


class ScrewKind(StrEnum):
    """The shape of a screw's head."""

    CAP = "cap"
    COUNTERSUNK = "countersunk"


@dataclass(frozen=True, slots=True, kw_only=True)
class Screw:
    """A screw with a hexagon socket, one thread size of one standard.

    Attributes:
        name: standard and thread ("ISO4762-M4").
        diameter, pitch: of the thread [mm].
        head_diameter: true diameter of the head [mm].
        countersink_diameter: diameter at which the head's cone meets the surface it is flush with; the diameter of the
            countersink to cut [mm]; 0 for a cap screw.
        head_height: cap: height of the head; countersunk: depth of the cone from the surface to the shank [mm].
        socket, socket_depth: across flats, depth [mm].
        tap_drill, clearance_hole: holes to drill [mm].
        thread_length: of screws that are not threaded to the head [mm].
        lengths: those that are sold, rising [mm].
    """

    name: str
    kind: ScrewKind
    diameter: float
    pitch: float
    head_diameter: float
    countersink_diameter: float
    head_height: float
    socket: float
    socket_depth: float
    tap_drill: float
    clearance_hole: float
    thread_length: float
    lengths: tuple[float, ...]
    source: str

    grows: ClassVar[tuple[Chain, ...]] = (
        ("pitch", "tap_drill", "diameter", "clearance_hole", "head_diameter"),
        ("socket", "head_diameter"),
        ("socket_depth", "head_height"),
    )
    may_be_zero: ClassVar[tuple[str, ...]] = ("countersink_diameter",)

    @property
    def thread(self) -> str:
        """Its thread ("M4")."""
        return f"M{self.diameter:g}"

    def check_length(self, length: float) -> None:
        """Refuse a length that is not sold.

        Raises:
            ParameterError: names the screw and the lengths there are.
        """
        if length not in self.lengths:
            raise ParameterError(
                f"length of {self.name}", length, "one of " + ", ".join(f"{known:g}" for known in self.lengths) + " mm"
            )

    def length_for(self, needed: float) -> float:
        """The shortest length [mm] that is sold and is not below `needed`.

        Raises:
            ParameterError: the longest is too short.
        """
        for known in self.lengths:
            if known >= needed - 1e-9:
                return known
        raise ParameterError(f"length of {self.name}", needed, f"at most {self.lengths[-1]:g} mm")

    def designation(self, length: float) -> str:
        """What to order ("ISO4762-M4x16")."""
        self.check_length(length)
        return f"{self.name}x{length:g}"

    def mass_of(self, length: float) -> float:
        """Mass [kg] from its shape in stainless steel; a thread weighs as much as a shank of its pitch diameter."""
        self.check_length(length)
        r_shank, r_head = (self.diameter - 0.6495 * self.pitch) / 2.0, self.head_diameter / 2.0
        if self.kind is ScrewKind.CAP:
            head, shank = math.pi * r_head**2 * self.head_height, length
        else:
            rim = (self.countersink_diameter - self.head_diameter) / 2.0
            cone, r_end = self.head_height - rim, self.diameter / 2.0
            head = math.pi * (r_head**2 * rim + cone * (r_head**2 + r_head * r_end + r_end**2) / 3.0)
            shank = length - self.head_height
        socket = math.sqrt(3.0) / 2.0 * self.socket**2 * self.socket_depth
        return (head + math.pi * r_shank**2 * shank - socket) * material("stainless_1_4301").density


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """A retaining washer (E-clip) that snaps into a groove from the side.

    Attributes:
        name: standard and groove diameter ("DIN6799-3.2").
        groove_diameter: of the groove's bottom [mm].
        shaft_min, shaft_max: diameters of shaft that it suits [mm].
        outer: diameter of the circle that it fills when snapped in [mm].
        thickness: [mm].
        groove_width, end_land: least width of the groove, and of the land between groove and shaft end [mm].
        mass: [kg].
    """

    name: str
    groove_diameter: float
    shaft_min: float
    shaft_max: float
    outer: float
    thickness: float
    groove_width: float
    end_land: float
    mass: float
    source: str

    grows: ClassVar[tuple[Chain, ...]] = (
        ("groove_diameter", "shaft_min", "shaft_max", "outer"),
        ("thickness", "groove_width"),
    )
    may_be_zero: ClassVar[tuple[str, ...]] = ()

    def groove(self, low: float) -> tuple[float, float, float]:
        """The groove for `hardware.pin` (z, diameter, width) [mm] whose lower side lies at z = low."""
        return low, self.groove_diameter, self.groove_width


@dataclass(frozen=True, slots=True, kw_only=True)
class Shim:
    """A shim ring.

    Attributes:
        name: standard and diameters ("DIN988-4x8").
        bore, outer: diameters [mm].
        thicknesses: those that are sold, rising [mm].
    """

    name: str
    bore: float
    outer: float
    thicknesses: tuple[float, ...]
    source: str

    grows: ClassVar[tuple[Chain, ...]] = (("bore", "outer"),)
    may_be_zero: ClassVar[tuple[str, ...]] = ()

    def check_thickness(self, thickness: float) -> None:
        """Refuse a thickness that is not sold.

        Raises:
            ParameterError: names the shim and the thicknesses there are.
        """
        if thickness not in self.thicknesses:
            raise ParameterError(
                f"thickness of {self.name}",
                thickness,
                "one of " + ", ".join(f"{known:g}" for known in self.thicknesses) + " mm",
            )

    def designation(self, thickness: float) -> str:
        """What to order ("DIN988-4x8x0.2")."""
        self.check_thickness(thickness)
        return f"{self.name}x{thickness:g}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Motor:
    """A motor held by screws in its face around a pilot.

    Attributes:
        name: maker, series, power ("maxon-EC45flat-70W").
        body_diameter, body_length: behind the mounting face [mm].
        shaft_diameter, shaft_length: length counts from the mounting face [mm].
        pilot_diameter, pilot_length: the centring boss before the face [mm].
        mount_screw, mount_depth: thread ("M3") and depth [mm] of the holes in the face.
        mount_circle, n_mount: diameter of the circle of holes [mm], and how many.
        rear_diameter, rear_length: encoder behind the body [mm]; 0 for none.
        nominal_torque, stall_torque: continuous, and at standstill [N mm].
        mass: [kg].
    """

    name: str
    body_diameter: float
    body_length: float
    shaft_diameter: float
    shaft_length: float
    pilot_diameter: float
    pilot_length: float
    mount_screw: str
    mount_depth: float
    mount_circle: float
    n_mount: int
    rear_diameter: float
    rear_length: float
    nominal_torque: float
    stall_torque: float
    mass: float
    source: str

    grows: ClassVar[tuple[Chain, ...]] = (
        ("shaft_diameter", "pilot_diameter", "mount_circle", "body_diameter"),
        ("pilot_length", "shaft_length"),
        ("mount_depth", "body_length"),
        ("nominal_torque", "stall_torque"),
    )
    may_be_zero: ClassVar[tuple[str, ...]] = ("rear_diameter", "rear_length")

    @property
    def first_hole(self) -> float:
        """Angle of the first mounting hole from x [rad]: half a division, so a flipped motor has the same pattern."""
        return math.pi / self.n_mount


_KINDS: dict[str, type] = {"bearings": Bearing, "screws": Screw, "clips": Clip, "shims": Shim, "motors": Motor}


@cache
def _table(name: str) -> dict[str, Any]:
    if name not in _KINDS:
        raise UnknownNameError("table of supplies", name, tuple(_KINDS))
    place = files(str(__package__).rpartition(".")[0] + ".supplies").joinpath(f"{name}.csv")
    return read_table(f"supplies/{name}.csv", place.read_text(encoding="utf-8").splitlines(), _KINDS[name])


def _row(table: str, kind: str, name: str) -> Any:
    try:
        return _table(table)[name]
    except KeyError:
        raise UnknownNameError(kind, name, names(table)) from None


def names(table: str) -> tuple[str, ...]:
    """All names of a table ("bearings", "screws", "clips", "shims", "motors"), in its order."""
    return tuple(_table(table))


def bearing(name: str) -> Bearing:
    """The bearing of this name; UnknownNameError lists those there are."""
    return _row("bearings", "bearing", name)


def screw(name: str) -> Screw:
    """The screw of this name, such as "ISO4762-M4"; UnknownNameError lists those there are."""
    return _row("screws", "screw", name)


def clip(name: str) -> Clip:
    """The clip of this name, such as "DIN6799-3.2"; UnknownNameError lists those there are."""
    return _row("clips", "clip", name)


def shim(name: str) -> Shim:
    """The shim ring of this name, such as "DIN988-4x8"; UnknownNameError lists those there are."""
    return _row("shims", "shim", name)


def motor(name: str) -> Motor:
    """The motor of this name; UnknownNameError lists those there are."""
    return _row("motors", "motor", name)
