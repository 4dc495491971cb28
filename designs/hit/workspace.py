"""The box of poses that the default HIT device promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: Hand-sized: 100 mm square, 70 mm high, tilts of 10 and a turn of 15 degrees, all at once. Every corner keeps all
#: joint limits (shown by tests/designs/test_hit.py).
HIT_WORKSPACE = Workspace(
    lower=(-50.0, -50.0, 225.0, -10.0 * DEG, -10.0 * DEG, -15.0 * DEG),
    upper=(50.0, 50.0, 295.0, 10.0 * DEG, 10.0 * DEG, 15.0 * DEG),
)
