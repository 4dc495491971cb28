"""The design file: how it is read, what it may hold, how it is written."""
