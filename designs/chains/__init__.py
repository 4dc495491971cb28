"""Sub-chains that several mechanisms share: their kinematics, joints and bodies."""
