"""The gates, run by run: what was answered becomes rows and verdicts."""
