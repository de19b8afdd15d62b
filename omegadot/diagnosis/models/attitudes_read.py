"""One convention through which attitudes go where a state is read back, and in the samples of runs.

The few states that are set and read back show little; where steps of no length lead shows the rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import State

MOST_PAIRS = 64  # attitudes that are taken through other conventions first
KNOWN_TO = 1e-9  # rad, about: what the limit of smooth steps is known to
IN_RUNS = "in the samples of a run, "
IN_BOTH = "in states that are read back and in the samples of a run, "


Pairs = Sequence[tuple[State, State]]


def attitudes_read(set_and_back: Pairs, limits: Pairs) -> str:
    """The convention of both; "" where no state is read back by another attitude, or none fits.

    set_and_back: one state a system, and what read back of it.  limits: from which states steps
    were taken, and where those of no length lead.
    """
    if not limits or not set_and_back:
        return ""
    one, other = (np.stack([pair[k].orientation for pair in set_and_back]) for k in (0, 1))
    if not np.any(attitude_angle(one, other) > KNOWN_TO):
        return ""
    given, came = (np.concatenate([pair[k].orientation for pair in limits]) for k in (0, 1))
    some = np.unique(np.linspace(0, len(given) - 1, MOST_PAIRS).astype(int))
    text = attitude_misread(given[some], came[some], KNOWN_TO)
    given, came = np.concatenate((given, one)), np.concatenate((came, other))
    return text if text and text == attitude_misread(given, came, KNOWN_TO) else ""


def in_both(text: str, convention: str) -> str:
    """What is said of the samples of runs, as what holds of states that are read back as well."""
    same = bool(convention) and text == f"{IN_RUNS}{convention}"
    return f"{IN_BOTH}{convention}" if same else text
