"""biorbd, which is RBDL with an interface to Python, behind the protocol."""
