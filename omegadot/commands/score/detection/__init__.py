"""Finding out which convention a trace comes in."""
