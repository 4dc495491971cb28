"""The box of poses that the default KJIST device promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: Small sideways: the bars' lean is the whole travel.
KJIST_WORKSPACE = Workspace(
    lower=(-30.0, -30.0, 300.0, -8.0 * DEG, -8.0 * DEG, -12.0 * DEG),
    upper=(30.0, 30.0, 360.0, 8.0 * DEG, 8.0 * DEG, 12.0 * DEG),
)
