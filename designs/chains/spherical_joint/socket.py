"""A whole socket as the parts of the body that carries it, screws included."""

from __future__ import annotations

import math

from ...language.bodies import Part
from ...language.hardware import purchased_part, screw_feature
from ..pivot import Lay
from .dimensions import SphericalJointDimensions
from .parts import bushing, lower_ring, shell_cover, shim, upper_ring


def socket_parts(
    d: SphericalJointDimensions, name: str, lay: Lay, *, housing: str, seats: str, shims: str = "steel_c45"
) -> tuple[Part, ...]:
    """Bushing, shim, both rings, cover and its screws.

    Args:
        d: dimensions.
        name: prefix of the parts' names ("socket_1").
        lay: the socket's frame in the body: origin at the ball's centre, z out of the opening.
        housing, seats, shims: materials of bushing and cover, of the rings, of the shim.

    Returns:
        Parts that run in the joint, and the screws, which do not. The bushing's flat back lies at z = `d.back`; from
        behind it takes a screw M6 (`d.mount_diameter`) up to `d.mount_depth`.
    """
    at = lay.at(0.0, 0.0, 0.0)
    made = (
        ("bushing", bushing(d), housing, "flat back on its seat, one screw from behind"),
        ("shim", shim(d), shims, "slide in the bushing; its thickness sets the running clearance"),
        ("lower_ring", lower_ring(d), seats, "H7/h6 in the bushing, on the shim"),
        ("upper_ring", upper_ring(d), seats, "H7/h6 in bushing and cover, under the cover"),
        ("cover", shell_cover(d), housing, "centred on the upper ring, screwed to the bushing"),
    )
    parts = [
        Part(name=f"{name}_{part}", feature=feature, at=at, material=material, runs_in_joint=True, fit=fit)
        for part, feature, material, fit in made
    ]
    feature, radius = screw_feature(d.screw, d.screw_length), d.screw_circle / 2.0
    for k in range(d.n_screws):
        turn = k * math.tau / d.n_screws
        place = lay.at(radius * math.cos(turn), radius * math.sin(turn), d.cover_face, flip=True)
        parts.append(
            purchased_part(
                f"{name}_cover_screw_{k + 1}",
                feature,
                d.screw_row,
                place,
                length=d.screw_length,
                fit="flush in the cover, threaded into the bushing",
            )
        )
    return tuple(parts)
