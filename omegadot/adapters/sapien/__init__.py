"""SAPIEN, which steps by PhysX, behind the protocol."""
