"""Who compares: plans, workers, gates, verdicts, and the command line."""
