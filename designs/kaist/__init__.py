"""KAIST master hand: three five-bars on base pins, balls at their tips."""
