"""Inoue platform: three hinged five-bars under one platform, 6 DOF (as compared by Stocco et al.)."""
