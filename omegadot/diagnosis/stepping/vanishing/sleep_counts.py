"""The runs of one integrator that are put to sleep, and the law by which they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, scheme_of
from omegadot.diagnosis.stepping.vanishing.rests import LEAST
from omegadot.diagnosis.stepping.vanishing.sleep_laws import Sleeps, law_of_sleep
from omegadot.diagnosis.stepping.vanishing.spells import rests_from, slept


def sleeping_runs(integrator: Integrator, kept: Sequence[KeptRun]) -> Sleeps | None:
    """The law by which the runs of one integrator fall asleep; None without any."""
    with np.errstate(all="ignore"):
        resting = [run for run in kept if run.fails and rests_from(run)]
        by = scheme_of(integrator, kept) if len(resting) >= LEAST else None
        if by is None:
            return None
        found = [(run, slept(run, by)) for run in resting]
        spells = tuple(spell for _, spell in found if spell is not None)
        explained = {id(run) for run, spell in found if spell is not None}
        left = {run.name for run in kept if run.fails and id(run) not in explained}
        names = frozenset({spell.name for spell in spells} - left)
        others = tuple(run for run in kept if not rests_from(run))
        one = Sleeps("", names, spells, others, by)
        text = law_of_sleep([one]) if names else ""
    return Sleeps(text, names, spells, others, by) if text else None
