"""Checks: one generator and one way to judge, for ``omegadot check`` and for pytest."""
