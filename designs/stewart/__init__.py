"""Paired Stewart platform: six prismatic legs in three hinged pairs, 6 DOF (as compared by Stocco et al.)."""
