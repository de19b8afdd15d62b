"""``omegadot report``: a stored run drawn again."""
