"""Where runs begin to be wrong: after a number of steps, after a time, or after a share of it."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.reported.onsets import Onset, onset_law

SOUND = np.inf


def onset(step: float, first: float, wrong: float, steps: float) -> Onset:
    """Of a run of so many steps that is sound up to the first of these steps, wrong by the second.

    SOUND: throughout.
    """
    known = first, wrong
    return Onset(known, tuple(step * n for n in known), tuple(n / steps for n in known))


SHORT = onset(0.02, 500.0, SOUND, 500.0)
LONG = onset(0.01, 480.0, 520.0, 1000.0)


def test_a_number_of_steps_is_named_where_a_run_of_fewer_is_sound() -> None:
    """Caught: half of a run, or 5 s, named where a run that is as long has nothing wrong."""
    law = "every run is sound for its first 500 steps, and wrong by step 520"
    assert onset_law([SHORT, LONG]) == f"{law}, whatever the step's length"


def test_a_time_is_named_where_runs_of_other_steps_share_it() -> None:
    law = onset_law([LONG, onset(0.02, 245.0, 258.0, 2000.0)])
    assert (
        law
        == "every run is sound until t = 4.9 s, and wrong by t = 5.16 s, whatever the step's length"
    )


def test_a_share_of_each_run_is_named_as_one() -> None:
    law = onset_law([LONG, onset(0.02, 1500.0, 1530.0, 3000.0)])
    assert law == "every run is sound for the first 50 % of its time, and wrong by 51 % of it"


def test_what_nothing_distinguishes_is_not_named() -> None:
    assert onset_law([LONG, LONG]) == ""
    assert onset_law([LONG]) == ""
    assert onset_law([SHORT, SHORT]) == ""
