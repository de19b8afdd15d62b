"""Which scheme an integrator steps, and how its errors shrink, found from its steps alone."""
