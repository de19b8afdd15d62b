"""What is drawn: deviations along a run, convergence, work and precision."""
