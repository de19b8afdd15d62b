"""What is true: the Newton-Euler equations, schemes that step them, and exact solutions."""
