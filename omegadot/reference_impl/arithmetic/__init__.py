"""Numbers with more digits than a double, and vectors as their components."""
