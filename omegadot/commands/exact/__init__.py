"""``omegadot.exact``: the exact solution at given times; for scripts, without a command."""
