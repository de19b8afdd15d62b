"""``omegadot run``: scenarios on engines, judged, with a record and its report."""
