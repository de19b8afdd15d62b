"""How runs and samples begin and end."""
