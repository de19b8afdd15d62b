"""Schemes with something mistyped or taken from elsewhere in them."""
