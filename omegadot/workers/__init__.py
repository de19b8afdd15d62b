"""Where it runs: both ends of the channel between the harness and an engine's process."""
