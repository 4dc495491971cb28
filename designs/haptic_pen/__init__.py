"""Haptic pen: a pen between two waist-hinged pantographs, six motors, passive roll (Stocco, Salcudean, Sassani)."""
