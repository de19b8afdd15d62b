"""Gates 4 to 6, over whole runs: invariants, trajectory, repeated runs, cost."""
