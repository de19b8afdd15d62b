"""The gates, in order: model, equation, invariants, trajectory, cost. Each is a small file."""
