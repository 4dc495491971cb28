"""What a mechanism is: numbers, kinematics, joints, and the features of its bodies. No solids are made here."""
