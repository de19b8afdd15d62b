"""Gates 1 and 2, at single states: the model read back, and the equation."""
