"""Engine choice: requirements in, evidence out. Nothing is extrapolated into a verdict."""
