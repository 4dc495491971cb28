"""PATHOS-II: six RRR legs with globular joints between two base plates, two gripping plates amid them, 7 DOF."""
