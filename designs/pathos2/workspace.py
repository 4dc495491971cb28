"""The box of poses that the default PATHOS-II promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: A hand's span: 40 mm cube, tilts of 8 and turns of 15 degrees, grip of 10 mm (20 mm between the plates), all at once.
#: The turn is centred below the home pose's 30 degrees, away from the parallel singularity at 60. Every corner keeps
#: all joint limits (shown by tests/designs/test_pathos2.py).
PATHOS2_WORKSPACE = Workspace(
    lower=(-20.0, -20.0, 205.0, -8.0 * DEG, -8.0 * DEG, 5.0 * DEG, 60.0),
    upper=(20.0, 20.0, 245.0, 8.0 * DEG, 8.0 * DEG, 35.0 * DEG, 70.0),
)
