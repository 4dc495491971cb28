"""UCI hand controller: three pantographs on base pins, balls at their tips."""
