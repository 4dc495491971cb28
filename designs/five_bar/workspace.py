"""The box of poses that the default five-bar promises to serve."""

from ..design import Workspace

#: The square in the circle of radius 72 about (0, 265) in which all angles to singular postures exceed 20 degrees.
FIVE_BAR_WORKSPACE = Workspace(lower=(-50.0, 215.0), upper=(50.0, 315.0))
