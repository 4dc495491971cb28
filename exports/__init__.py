"""The only storey that writes files."""
