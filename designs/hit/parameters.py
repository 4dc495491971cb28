"""The numbers of the HIT device, each with its unit, its letter and its reason."""

from __future__ import annotations

from dataclasses import dataclass

from ..language.parameters import angle, choice, length
from ..language.supplies import material_names, names
from ..language.units import DEG


@dataclass(frozen=True, slots=True, kw_only=True)
class HitParameters:
    """The kinematic dimensions (Zhang et al., Fig. 4; the paper prints no values)."""

    base_radius: float = length(
        120.0,
        "centre of the base to the pins; below 105 neighbouring elbows collide, 120 leaves them 10 mm",
        symbol="R",
    )
    platform_radius: float = length(
        120.0, "centre of the platform to the balls; equal to base_radius gives the 60 degree symmetry", symbol="r"
    )
    pivot_height: float = length(
        25.0, "pin axis to motor pivots: lets the lower bars pass over the pins' bearing blocks", symbol="L_1 (part)"
    )
    ball_height: float = length(30.0, "pins of the top bar to the ball's centre", symbol="L_1 (part)")
    lower_link_length: float = length(150.0, "motor pivot to elbow", symbol="L_2")
    upper_link_length: float = length(150.0, "elbow to top bar; equal to L_2 for a rhombus", symbol="L_3")
    frame_width: float = length(
        50.0, "left to right motor pivot, and the same on the top bar; cancels in the kinematics", symbol="e"
    )
    lower_offset: float = length(25.0, "lower link to inner lower link", symbol="v_1")
    lower_offset_angle: float = angle(
        30.0 * DEG,
        "direction of that offset from +y; 30 keeps the parallelogram 30 degrees from folding",
        least=-180.0 * DEG,
        most=180.0 * DEG,
    )
    upper_offset: float = length(25.0, "upper link to inner upper link", symbol="v_2")
    upper_offset_angle: float = angle(
        150.0 * DEG, "direction of that offset from +y", least=-180.0 * DEG, most=180.0 * DEG
    )

    @property
    def chain_height(self) -> float:
        """L1 [mm]: the planar chain translates its tip, so both parts add up."""
        return self.pivot_height + self.ball_height


#: The set for which the reference numbers were computed: it puts the motors on the pin, where no bearing fits.
HIT_REFERENCE = HitParameters(base_radius=110.0, platform_radius=110.0, pivot_height=10.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class HitLimits:
    """The declared joint limits; a release shows that the solids allow them."""

    theta_1_min: float = angle(60.0 * DEG, "left lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    theta_1_max: float = angle(180.0 * DEG, "left lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_min: float = angle(0.0, "right lower link: horizontal", least=-180.0 * DEG, most=270.0 * DEG)
    theta_2_max: float = angle(120.0 * DEG, "right lower link from +y", least=-180.0 * DEG, most=270.0 * DEG)
    elbow_min: float = angle(
        20.0 * DEG,
        "bend of an elbow (theta_1 - theta_2 if L_2 = L_3): away from stretched",
        least=0.0,
        most=180.0 * DEG,
    )
    elbow_max: float = angle(150.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    pin_max: float = angle(45.0 * DEG, "lean of a leg to either side", least=0.0, most=90.0 * DEG)
    cone_max: float = angle(55.0 * DEG, "half angle of the ball joint's cone", least=0.0, most=90.0 * DEG)


@dataclass(frozen=True, slots=True, kw_only=True)
class HitLinks:
    """Bars and pins of the sub-chains. All bars lie in layers along the motor axes, so that they may cross."""

    bar_width: float = length(12.0, "stiff enough at 150 mm for 10 N, light enough for a haptic device")
    eye_diameter: float = length(16.0, "bearing outer ring plus 3 mm wall")
    lip: float = length(1.0, "shoulder that holds the bearings' outer rings")
    lip_bore: float = length(
        9.0,
        "bore of that shoulder: carries the outer ring (at most 9.2 for MR104), passes the clip with 0.8 mm of air",
    )
    layer_gap: float = length(1.5, "air between neighbouring layers")
    end_length: float = length(1.0, "pin beyond its clip")
    inner_bar_width: float = length(9.0, "the inner bars only steer")
    inner_eye_diameter: float = length(14.0, "bearing outer ring plus 2 mm wall")
    edge_break: float = length(0.4, "chamfer on the bars' outlines", least=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class HitFrame:
    """The frame that swings on the pin: two side plates, two end blocks, a keel, two motors and a counterweight."""

    plate_gap: float = length(18.0, "between the side plates: the lower bars' hubs with sleeves on both sides")
    plate_rim: float = length(4.0, "metal around bearings and motor faces")
    hub_diameter: float = length(20.0, "eye of a lower bar on its drive shaft")
    bearing_lip: float = length(1.0, "shoulder that holds a drive shaft's bearing")
    end_block: float = length(12.0, "end block along the pin")
    end_block_height: float = length(24.0, "end block across the pin: clears the lower bars above")
    pin_span: float = length(96.0, "between the end blocks' middles: outside both motors")
    axle_length: float = length(20.0, "stub axle: pressed into the block, runs in the pedestal")
    counterweight_diameter: float = length(40.0, "steel disc that takes out the pin's gravity moment")
    counterweight_length: float = length(18.0, "of that disc")
    counterweight_drop: float = length(48.0, "pin axis to the disc's middle; the threaded rod lets it be adjusted")
    rod_length: float = length(66.0, "M6 rod, screwed into the keel")


@dataclass(frozen=True, slots=True, kw_only=True)
class HitBase:
    """Base plate and the pedestals of the pins."""

    plate_thickness: float = length(10.0, "stiff enough to be the datum of all six pedestals")
    plate_rim: float = length(22.0, "metal around the pedestals' feet")
    pin_height: float = length(80.0, "plate to pin axis: the counterweight swings 62 mm below the pin")
    pedestal_thickness: float = length(10.0, "bearing, shoulder and foot screws")
    pedestal_gap: float = length(3.0, "between end block and pedestal")
    pedestal_head: float = length(24.0, "diameter around the bearing")
    pedestal_foot: float = length(40.0, "width of the foot")
    window_diameter: float = length(120.0, "opening in the middle, for cables and weight", least=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class HitPlatform:
    """Top plate with three sockets, and the handle."""

    plate_thickness: float = length(6.0, "aluminium; the arms bend less than 0.1 mm under 10 N")
    hub_diameter: float = length(60.0, "middle of the star, seat of the handle")
    arm_width: float = length(24.0, "width of an arm, a little more than a bushing's ring")
    handle_diameter: float = length(26.0, "a pen-to-stick grip for a hand")
    handle_length: float = length(110.0, "handle above the plate")


@dataclass(frozen=True, slots=True, kw_only=True)
class HitSupplies:
    """Catalogue parts by name (`linkwright list --supplies` shows the tables)."""

    link_bearing: str = choice("MR104ZZ", "two at each end of a bar", names("bearings"))
    frame_bearing: str = choice("688ZZ", "drive shafts and pins", names("bearings"))
    motor: str = choice(
        "maxon-EC45flat-70W",
        "flat, so it swings in little room; its 128 N mm hold 3.6 N at home of the 8.7 N weight: add springs",
        names("motors"),
    )
    clip: str = choice("DIN6799-3.2", "holds the bars on their 4 mm pins", names("clips"))


@dataclass(frozen=True, slots=True, kw_only=True)
class HitMaterials:
    """What the made parts are made of."""

    links: str = choice("aluminium_6082", "bars, elbow plate, top bar", material_names())
    frame: str = choice("aluminium_6082", "side plates, blocks, pedestals, base plate", material_names())
    platform: str = choice("aluminium_6082", "top plate and socket housings", material_names())
    pins: str = choice("steel_c45", "pins, sleeves, drive shafts", material_names())
    balls: str = choice("steel_100cr6", "ball-bars, hardened", material_names())
    seats: str = choice("bronze_cusn8", "ball rings", material_names())
    counterweights: str = choice("steel_c45", "discs and rods", material_names())
    handle: str = choice("pom", "handle", material_names())
