"""The box of poses that the default Inoue platform promises to serve."""

from ..design import Workspace
from ..language.units import DEG

#: The paper's W (eq. 21): 16 x 10 x 10 cm, centred 25 cm from the base, roll 30 degrees; 18 degrees on the other two
#: turns at once are a tilt of at most 31, about the paper's cone of 30.
INOUE_WORKSPACE = Workspace(
    lower=(-80.0, -50.0, 200.0, -18.0 * DEG, -30.0 * DEG, -18.0 * DEG),
    upper=(80.0, 50.0, 300.0, 18.0 * DEG, 30.0 * DEG, 18.0 * DEG),
)
