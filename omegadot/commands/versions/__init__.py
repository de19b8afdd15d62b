"""One engine in many versions, each in an environment of its own: what changed at which one."""
