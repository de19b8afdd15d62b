"""The exact motion, and how far a small change of it grows."""
