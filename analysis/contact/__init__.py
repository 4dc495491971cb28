"""How near two bodies come to each other, and whether one lies in the other: exact, on closed triangle meshes."""
