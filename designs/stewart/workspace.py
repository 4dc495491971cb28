"""The box of poses that the default paired Stewart platform promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: What a stroke of 95 mm serves completely, centred 25 cm from the base, three turns at once: 0.4 of the paper's box.
STEWART_WORKSPACE = Workspace(
    lower=(-30.0, -20.0, 230.0, -10.0 * DEG, -12.0 * DEG, -10.0 * DEG),
    upper=(30.0, 20.0, 270.0, 10.0 * DEG, 12.0 * DEG, 10.0 * DEG),
)
