"""iDynTree behind the protocol."""
