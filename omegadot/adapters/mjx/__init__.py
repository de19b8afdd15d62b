"""MuJoCo's MJX, on JAX, behind the protocol."""
