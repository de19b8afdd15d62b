"""DART behind the protocol."""
