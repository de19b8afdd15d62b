"""The errors of a run: measured, and whether rounding, the scheme or an order explains them."""
