"""The bodies of the HIT device: base, three times nine links, platform."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..language.bodies import Body
from .base import base_parts
from .frame import FrameShop
from .links import LinkShop
from .platform import platform_parts


def build_bodies(sections: Mapping[str, Any]) -> tuple[Body, ...]:
    """Bodies in the order in which the mechanism places them; the links of all legs are equal."""
    shop = LinkShop(sections)
    upper = shop.upper_bar()
    kinds = {
        "frame": FrameShop(sections).parts(),
        "lower_left": shop.lower_bar(left=True),
        "lower_right": shop.lower_bar(left=False),
        "upper_left": upper,
        "upper_right": upper,
        "top_bar": shop.top_bar(),
        "inner_lower": shop.inner_lower(),
        "elbow_plate": shop.elbow_plate(),
        "inner_upper": shop.inner_upper(),
    }
    legs = [
        Body(
            name=f"{leg}_{name}",
            kind="upper_bar" if name in ("upper_left", "upper_right") else name,
            group=leg,
            parts=parts,
        )
        for leg in ("leg_1", "leg_2", "leg_3")
        for name, parts in kinds.items()
    ]
    return (
        Body(name="base", kind="base", group="", parts=base_parts(sections)),
        *legs,
        Body(name="platform", kind="platform", group="", parts=platform_parts(sections)),
    )
