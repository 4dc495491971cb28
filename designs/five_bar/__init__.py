"""The plain planar five-bar, driven at its base links."""
