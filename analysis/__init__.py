"""Questions about a design, answered with numbers and findings."""
