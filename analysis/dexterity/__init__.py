"""How well a mechanism moves and holds at a pose and over a workspace, and how near its singularities are."""
