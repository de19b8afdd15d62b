"""A trajectory from outside, of any simulator or log, held against the exact solution."""
