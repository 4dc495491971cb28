"""A ball on a thin root in a socket with a wide mouth: the joint that leans by 55 degrees to every side."""

from .cone import FormulaWarning, cone_half_angle, formula_warnings
from .dimensions import SOCKET_16, SOCKET_20, SphericalJointDimensions, check_dimensions
from .parts import ball_bar, bushing, lower_ring, shell_cover, shim, upper_ring
from .socket import socket_parts

__all__ = [
    "SOCKET_16",
    "SOCKET_20",
    "FormulaWarning",
    "SphericalJointDimensions",
    "ball_bar",
    "bushing",
    "check_dimensions",
    "cone_half_angle",
    "formula_warnings",
    "lower_ring",
    "shell_cover",
    "shim",
    "socket_parts",
    "upper_ring",
]
