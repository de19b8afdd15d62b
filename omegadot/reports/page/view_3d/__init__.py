"""The 3-D view: the bodies of a run, tumbling."""
