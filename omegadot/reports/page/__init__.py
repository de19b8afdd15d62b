"""The HTML page, drawn from a record alone."""
