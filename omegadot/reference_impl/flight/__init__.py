"""What flight simulators step, for traces: Euler angles and multistep schemes."""
