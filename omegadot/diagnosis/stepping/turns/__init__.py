"""How a step turns the body, and how its equation is solved."""
