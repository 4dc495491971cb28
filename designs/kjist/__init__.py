"""KJIST haptic device: three fixed pantographs, 3R spherical joints at their tips, hinged bars below the plate."""
