"""Drake behind the protocol."""
