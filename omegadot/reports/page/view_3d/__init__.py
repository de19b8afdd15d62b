"""The tumbling bodies on the page."""
