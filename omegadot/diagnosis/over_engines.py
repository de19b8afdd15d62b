"""The causes of what fails in a run, looked for when the first is requested."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

from omegadot.harness.outcome import Cause, CausesOf, EngineCase, JudgedCase

if TYPE_CHECKING:
    from omegadot.diagnosis.diagnose import Causes


def causes_over(cases: Sequence[JudgedCase], seed: int) -> CausesOf:
    """The causes of every engine on every case of a run, each held against all of its cases.

    An engine's cases are looked at when its first failure is.
    """

    @cache
    def causes_of(engine: str) -> Causes:
        # Its import takes a third of that of a whole command, and most runs have no failure.
        from omegadot.diagnosis.diagnose import Causes

        causes = Causes()
        for judged in cases:
            for found in judged.engines if judged.truth is not None else ():
                if found.engine.name == engine:
                    causes.add(judged, found, seed)
        return causes

    def causes_of_case(judged: JudgedCase, found: EngineCase) -> Cause:
        name = found.engine.name
        return lambda run: causes_of(name).text(name, judged.case.name, run)

    return causes_of_case
