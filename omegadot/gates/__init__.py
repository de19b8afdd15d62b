"""The gates, in order: model, equation, scheme, invariants, trajectory, cost. Small files all."""
