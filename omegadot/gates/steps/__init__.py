"""Gate 3, over steps: the declared scheme, its order, vanishing steps, restarts, accuracies."""
