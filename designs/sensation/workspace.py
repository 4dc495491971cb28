"""The box of poses that the default SenSation promises to serve."""

from ..design import Workspace

#: The square in the circle of radius 130 about (0, 180) in which all angles to singular postures exceed 20 degrees.
SENSATION_WORKSPACE = Workspace(lower=(-90.0, 90.0), upper=(90.0, 270.0))
