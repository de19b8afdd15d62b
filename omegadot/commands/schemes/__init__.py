"""``omegadot schemes``: the scheme of every integrator, from its steps."""
