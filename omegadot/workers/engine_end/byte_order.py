"""Whether a program writes its arrays big-endian: what it was given comes back reversed."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import Array, Body, State

# An engine in single precision keeps what it is given within a few roundings.
TOLERANCE = 64 * float(np.finfo(np.float32).eps)


def is_big_endian(found: Body | State, given: Body | State) -> bool:
    """Whether every array is the one given in the other byte order alone."""
    pairs = [(np.asarray(getattr(found, name)), np.asarray(g)) for name, g in vars(given).items()]
    if all(_equal(own, due) for own, due in pairs):
        return False
    return all(_equal(own.byteswap(), due) for own, due in pairs)


def _equal(found: Array, given: Array) -> bool:
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(np.all(np.abs(found - given) <= TOLERANCE * np.max(np.abs(given))))
