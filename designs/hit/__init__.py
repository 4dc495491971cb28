"""HIT 6-DOF haptic device: three nine-bar pantograph sub-chains with wide ball joints (Zhang, Kong, Sun, Du)."""
