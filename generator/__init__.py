"""Numbers to solids. The generator knows features and bodies, never a mechanism by name."""
