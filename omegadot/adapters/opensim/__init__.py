"""OpenSim behind the protocol."""
