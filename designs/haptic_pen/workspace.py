"""The box of poses that the default haptic pen promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: The paper's W (eq. 25): 16 x 10 x 10 cm, centred 25 cm from the base. The paper bounds the pen's tilt by a cone of 45
#: degrees; 32 degrees on both turns at once are a tilt of 44, so the box lies in that cone. The whole cone is reachable
#: (shown by tests/papers/test_stocco_haptic_pen.py).
HAPTIC_PEN_WORKSPACE = Workspace(
    lower=(-80.0, -50.0, 200.0, -32.0 * DEG, -32.0 * DEG),
    upper=(80.0, 50.0, 300.0, 32.0 * DEG, 32.0 * DEG),
)
