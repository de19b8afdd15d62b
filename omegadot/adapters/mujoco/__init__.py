"""MuJoCo behind the protocol."""
