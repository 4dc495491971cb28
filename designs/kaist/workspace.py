"""The box of poses that the default KAIST master hand promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: Hand-sized, all tilts at once; the ball-bars lie radially, so a turn about z uses the cone too.
KAIST_WORKSPACE = Workspace(
    lower=(-40.0, -40.0, 220.0, -8.0 * DEG, -8.0 * DEG, -12.0 * DEG),
    upper=(40.0, 40.0, 280.0, 8.0 * DEG, 8.0 * DEG, 12.0 * DEG),
)
