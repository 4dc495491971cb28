"""The box of poses that the default UCI hand controller promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: Hand-sized, all tilts at once; the link under the ball turns with it, so the cone leaves less than at HIT.
UCI_WORKSPACE = Workspace(
    lower=(-40.0, -40.0, 220.0, -10.0 * DEG, -10.0 * DEG, -15.0 * DEG),
    upper=(40.0, 40.0, 285.0, 10.0 * DEG, 10.0 * DEG, 15.0 * DEG),
)
