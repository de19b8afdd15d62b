"""JaxSim, on JAX, behind the protocol."""
