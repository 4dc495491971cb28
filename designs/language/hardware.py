"""The shapes of purchased and simple turned parts as features: bearings, pins, spacers, clips, shims, screws, motors.

All stand on z: what slides on or is screwed in points up. Purchased shapes take a name of the tables in `supplies`.
"""

from __future__ import annotations

from collections.abc import Sequence

from . import supplies
from .bodies import Part, Placement
from .errors import ParameterError
from .features import Feature, Hole, Turned, Vertex

#: Depth of the shields behind the rings' faces [mm]: small ZZ bearings have 0.1 to 0.3.
SHIELD_RECESS = 0.2
#: Air around a motor's shaft in the feature of its body [mm]: the shaft turns with another body, and the motor's own
#: bearings, which are inside, are not drawn.
SHAFT_GAP = 0.6
#: Depth of that air below the mounting face, where the shaft's feature ends [mm].
SHAFT_GAP_DEPTH = 1.0
#: Chamfer of a screw's tip [mm], at most; fine threads have half their pitch.
TIP_CHAMFER = 0.5


def _turned(
    *corners: tuple[float, float], holes: tuple[Hole, ...] = (), hex_socket: tuple[float, float, float] | None = None
) -> Turned:
    """A turned feature from corners (r, z); a corner equal to the one before it is left out."""
    kept = [corner for i, corner in enumerate(corners) if i == 0 or corner != corners[i - 1]]
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in kept), holes=holes, hex_socket=hex_socket)


def _require(holds: bool, field: str, value: float, allowed: str) -> None:
    """Refuse `value` unless the claim holds (false for NaN, too)."""
    if not holds:
        raise ParameterError(field, value, allowed)


def bearing(name: str) -> Turned:
    """A whole bearing, z from 0 to its width: both rings and the shields between them, recessed on both sides.

    The rings are one solid, so it serves where nothing turns against it that is checked by contact; `chains.pivot`
    makes the two rings as separate parts.
    """
    row = supplies.bearing(name)
    bore, inner, outer, rim = row.bore / 2.0, row.inner_land / 2.0, row.outer_land / 2.0, row.outer / 2.0
    low, high = SHIELD_RECESS, row.width - SHIELD_RECESS
    return _turned(
        (bore, 0.0),
        (inner, 0.0),
        (inner, low),
        (outer, low),
        (outer, 0.0),
        (rim, 0.0),
        (rim, row.width),
        (outer, row.width),
        (outer, high),
        (inner, high),
        (inner, row.width),
        (bore, row.width),
    )


def pin(
    diameter: float,
    length: float,
    *,
    head_diameter: float = 0.0,
    head_height: float = 0.0,
    grooves: Sequence[tuple[float, float, float]] = (),
    bore: float = 0.0,
    bore_depth: float = 0.0,
    chamfer: float = 0.3,
    thread: str = "",
    thread_depth: float = 0.0,
) -> Turned:
    """A round pin, z from 0 to `length`; its head, if any, lies below, z from -head_height to 0.

    Args:
        diameter: of the pin [mm].
        length: of the pin, without its head [mm].
        head_diameter: of the head [mm]; 0 for none.
        head_height: of the head [mm]; 0 for none.
        grooves: for clips, each (z of its lower side, diameter of its bottom, width) [mm].
        bore: diameter of a hole along the axis from the lower end [mm]; 0 for none.
        bore_depth: from the lower end, the head's if there is one [mm]; 0 goes through.
        chamfer: at 45 degrees on both outer ends [mm]; 0 for none.
        thread: of a tapped hole in the upper end ("M3"); empty for none.
        thread_depth: of that hole [mm].

    Raises:
        ParameterError: names the number that the others do not allow.
    """
    has_head = head_diameter > 0.0 or head_height > 0.0
    _check_pin(diameter, length, head_diameter, head_height, has_head, bore, chamfer)
    low, r, r_bore = (-head_height if has_head else 0.0), diameter / 2.0, bore / 2.0
    r_low = head_diameter / 2.0 if has_head else r
    is_through = bore > 0.0 and bore_depth == 0.0
    _require(0.0 <= bore_depth < length - low, "pin.bore_depth", bore_depth, f"must be below {length - low:g} mm")
    corners = [(r_bore, low), (r_low - chamfer, low), (r_low, low + chamfer)]
    if has_head:
        corners += [(r_low, 0.0), (r, 0.0)]
    corners += _groove_corners(r, length, chamfer, 0.0 if has_head else chamfer, r_bore, grooves)
    corners += [(r, length - chamfer), (r - chamfer, length)]
    if is_through:
        corners += [(r_bore, length)]
    else:
        corners += [(0.0, length)]
        corners += [(0.0, low + bore_depth), (r_bore, low + bore_depth)] if bore > 0.0 else []
    return _turned(
        *corners,
        holes=_end_thread(thread, thread_depth, r, length, 0.0 if is_through else low + bore_depth, is_through),
    )


def _check_pin(
    diameter: float,
    length: float,
    head_diameter: float,
    head_height: float,
    has_head: bool,
    bore: float,
    chamfer: float,
) -> None:
    _require(diameter > 0.0, "pin.diameter", diameter, "must be above 0 mm")
    _require(
        0.0 <= bore < diameter - 2.0 * chamfer,
        "pin.bore",
        bore,
        f"must leave a wall: below diameter less chamfers, {diameter - 2.0 * chamfer:g} mm",
    )
    _require(0.0 <= chamfer < diameter / 2.0, "pin.chamfer", chamfer, f"must lie in 0 to {diameter / 2.0:g} mm")
    _require(length > 2.0 * chamfer, "pin.length", length, f"must be above both chamfers, {2.0 * chamfer:g} mm")
    if has_head:
        _require(
            head_diameter > diameter, "pin.head_diameter", head_diameter, f"must be above the pin's {diameter:g} mm"
        )
        _require(head_height > chamfer, "pin.head_height", head_height, f"must be above the chamfer, {chamfer:g} mm")


def _groove_corners(
    r: float, length: float, chamfer: float, start: float, r_bore: float, grooves: Sequence[tuple[float, float, float]]
) -> list[tuple[float, float]]:
    corners: list[tuple[float, float]] = []
    edge = start
    for i, (z, diameter, width) in enumerate(sorted(grooves)):
        _require(
            z > edge, f"pin.grooves[{i}].z", z, f"must lie above {edge:g} mm, where a chamfer, groove or head ends"
        )
        _require(
            2.0 * r_bore < diameter < 2.0 * r,
            f"pin.grooves[{i}].diameter",
            diameter,
            f"must lie between the bore, {2.0 * r_bore:g} mm, and the pin, {2.0 * r:g} mm",
        )
        _require(width > 0.0, f"pin.grooves[{i}].width", width, "must be above 0 mm")
        edge = z + width
        _require(
            edge < length - chamfer,
            f"pin.grooves[{i}].width",
            width,
            f"must end below the chamfer at {length - chamfer:g} mm",
        )
        corners += [(r, z), (diameter / 2.0, z), (diameter / 2.0, edge), (r, edge)]
    return corners


def _end_thread(thread: str, depth: float, r: float, length: float, floor: float, is_through: bool) -> tuple[Hole, ...]:
    if not thread:
        return ()
    nominal = float(thread.removeprefix("M"))
    _require(not is_through, "pin.thread_depth", depth, "a pin bored through has no end to tap")
    _require(nominal < 2.0 * r, "pin.thread", nominal, f"must be below the pin's {2.0 * r:g} mm")
    _require(0.0 < depth < length - floor, "pin.thread_depth", depth, f"must lie in 0 to {length - floor:g} mm")
    return (Hole(top=length, diameter=nominal, depth=depth, thread=thread),)


def spacer(bore: float, outer: float, length: float) -> Turned:
    """A plain ring or tube, z from 0 to `length` [mm].

    Raises:
        ParameterError: no wall or no length is left.
    """
    _require(bore > 0.0, "spacer.bore", bore, "must be above 0 mm")
    _require(outer > bore, "spacer.outer", outer, f"must be above the bore, {bore:g} mm")
    _require(length > 0.0, "spacer.length", length, "must be above 0 mm")
    r, rim = bore / 2.0, outer / 2.0
    return _turned((r, 0.0), (rim, 0.0), (rim, length), (r, length))


def clip(name: str) -> Turned:
    """A snapped-in clip as a closed ring with the groove's diameter as bore, z from 0 to its thickness.

    The true clip is open on one side; the ring is the space that it takes in any position about the axis.
    """
    row = supplies.clip(name)
    return spacer(row.groove_diameter, row.outer, row.thickness)


def shim(name: str, thickness: float) -> Turned:
    """A shim ring, z from 0 to its thickness [mm].

    Raises:
        ParameterError: a thickness that is not sold.
    """
    row = supplies.shim(name)
    row.check_thickness(thickness)
    return spacer(row.bore, row.outer, thickness)


def screw_feature(name: str, length: float) -> Turned:
    """A screw of a length that is sold [mm]; its thread is a plain shank of the nominal diameter.

    A cap screw's head rests on z = 0: head z from -head_height to 0, shank z from 0 to `length`. A countersunk
    screw's face is flush at z = 0, and it ends at z = `length`, head included.
    """
    row = supplies.screw(name)
    row.check_length(length)
    r, r_head = row.diameter / 2.0, row.head_diameter / 2.0
    tip = min(TIP_CHAMFER, row.pitch / 2.0)
    shank = ((r, length - tip), (r - tip, length), (0.0, length))
    head: tuple[tuple[float, float], ...]
    if row.kind is supplies.ScrewKind.CAP:
        top, edge = -row.head_height, 0.1 * row.head_height
        head = ((0.0, top), (r_head - edge, top), (r_head, top + edge), (r_head, 0.0), (r, 0.0))
    else:
        # The sharp edge of the cone is turned off, which leaves a rim of the true head diameter below the surface.
        top, rim = 0.0, (row.countersink_diameter - row.head_diameter) / 2.0
        head = ((0.0, top), (r_head, top), (r_head, rim), (r, row.head_height))
    # A socket reaches down from its z; this one opens downwards, so its z is that of its bottom.
    return _turned(*head, *shank, hex_socket=(row.socket, top + row.socket_depth, row.socket_depth))


#: The same under the short name that the other factories have.
screw = screw_feature


def motor_body(name: str) -> Turned:
    """A motor without its shaft: mounting face at z = 0, pilot above it, body and encoder below.

    The holes in its face are tapped; the first lies at `Motor.first_hole` from x.
    """
    row = supplies.motor(name)
    r_air, r_pilot, r_body = row.shaft_diameter / 2.0 + SHAFT_GAP, row.pilot_diameter / 2.0, row.body_diameter / 2.0
    back = -row.body_length
    corners = [(0.0, back)]
    if row.rear_length > 0.0:
        r_rear = row.rear_diameter / 2.0
        corners = [(0.0, back - row.rear_length), (r_rear, back - row.rear_length), (r_rear, back)]
    corners += [
        (r_body, back),
        (r_body, 0.0),
        (r_pilot, 0.0),
        (r_pilot, row.pilot_length),
        (r_air, row.pilot_length),
        (r_air, -SHAFT_GAP_DEPTH),
        (0.0, -SHAFT_GAP_DEPTH),
    ]
    return _turned(*corners, holes=_mount_holes(row))


def motor_shaft(name: str) -> Turned:
    """A motor's shaft from its mounting face, z from 0 to its length: what turns."""
    row = supplies.motor(name)
    return pin(row.shaft_diameter, row.shaft_length, chamfer=0.2)


def motor(name: str) -> Turned:
    """A whole motor, shaft included, as one solid: mounting face at z = 0, shaft and pilot above it, body below."""
    row = supplies.motor(name)
    body = [(v.r, v.z) for v in motor_body(name).profile]
    r, end, edge = row.shaft_diameter / 2.0, row.shaft_length, 0.2
    return _turned(
        *body[:-3], (r, row.pilot_length), (r, end - edge), (r - edge, end), (0.0, end), holes=_mount_holes(row)
    )


def _mount_holes(row: supplies.Motor) -> tuple[Hole, ...]:
    return (
        Hole(
            top=0.0,
            diameter=float(row.mount_screw.removeprefix("M")),
            depth=row.mount_depth,
            thread=row.mount_screw,
            n=row.n_mount,
            pitch_radius=row.mount_circle / 2.0,
            first=row.first_hole,
        ),
    )


_MATERIALS: dict[type, str] = {
    supplies.Bearing: "steel_100cr6",
    supplies.Screw: "stainless_1_4301",
    supplies.Clip: "stainless_1_4301",
    supplies.Shim: "steel_c45",
    supplies.Motor: "copper_motor",
}
#: They sit on a joint's axis and run there.
_RUNNING = (supplies.Bearing, supplies.Clip, supplies.Shim)
_AT_ORIGIN = Placement()


def purchased_part(
    name: str,
    feature: Feature,
    row: supplies.Bearing | supplies.Screw | supplies.Clip | supplies.Shim | supplies.Motor,
    at: Placement = _AT_ORIGIN,
    *,
    length: float | None = None,
    material: str = "",
    runs_in_joint: bool | None = None,
    fit: str = "",
) -> Part:
    """A part from a catalogue, with its designation, mass and material.

    Args:
        name: of the part in its body.
        feature: its shape, made above.
        row: its line of the catalogue.
        at: its place in the body.
        length: of a screw, or thickness of a shim [mm]; a screw must have one.
        material: other than the usual one of its kind.
        runs_in_joint: None: bearings, clips and shims do.
        fit: how it is held.

    Raises:
        ParameterError: a screw without length, or with one that is not sold.
    """
    purchased, mass = row.name, None
    if isinstance(row, supplies.Screw):
        if length is None:
            raise ParameterError(f"length of {row.name}", length, "a screw is bought by its length")
        purchased, mass = row.designation(length), row.mass_of(length)
    elif isinstance(row, supplies.Shim):
        purchased = row.name if length is None else row.designation(length)
    else:
        mass = row.mass
    runs = isinstance(row, _RUNNING) if runs_in_joint is None else runs_in_joint
    return Part(
        name=name,
        feature=feature,
        at=at,
        material=material or _MATERIALS[type(row)],
        purchased=purchased,
        mass=mass,
        runs_in_joint=runs,
        fit=fit,
    )
