"""Sound engines with one thing broken in each, and what catches it."""
