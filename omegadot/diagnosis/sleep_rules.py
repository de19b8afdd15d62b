"""One law by which bodies are put to sleep, or left as they are, over all integrators of an engine.

A law without a number of steps or a time is named of single steps alone, before which no body can
have waited, or of runs that no law of another number, or of a time, explains as well.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from omegadot.diagnosis.run_rules import KeptRuns
from omegadot.diagnosis.stepping.vanishing.freezes import FREEZES
from omegadot.diagnosis.stepping.vanishing.rests import SLEEPS, Rests, sleep_law
from omegadot.diagnosis.stepping.vanishing.sleep_laws import Sleeps, law_of_sleep

ByScenario = Mapping[str, Rests]


@dataclass
class Shown:
    """Of one integrator: what its runs show, and single steps on each scenario.

    rests: at what states the body is put to rest, and frozen: at what states steps leave it as it
    is.
    """

    runs: KeptRuns
    rests: dict[str, Rests] = field(default_factory=dict)
    frozen: dict[str, Rests] = field(default_factory=dict)


@dataclass
class SleepRules:
    """Of one engine; the law of its runs is looked for again where more of them sleep."""

    _slept: tuple[tuple[Sleeps, ...], str] = ((), "")

    def rule(self, own: Shown, every: Sequence[Shown], name: str) -> str:
        """Where the body is put to sleep, on a scenario of this name that shows it; else "".

        One rule of all integrators that put it to sleep; where there is none, of this one.
        """
        rests, frozen = [one.rests for one in every], [one.frozen for one in every]
        return (
            _in_steps(own.rests, rests, name, SLEEPS)
            or self._in_runs(own, every, name)
            or _in_steps(own.frozen, frozen, name, FREEZES)
            or _of_kind(own.frozen, frozen, name, FREEZES)
        )

    def _in_runs(self, own: Shown, every: Sequence[Shown], name: str) -> str:
        """After some steps or some time in all runs that fall asleep."""
        mine = own.runs.sleeps
        if mine is None or name not in mine.names:
            return ""
        known = tuple(found for one in every if (found := one.runs.sleeps) is not None)
        if self._slept[0] != known:
            self._slept = known, law_of_sleep(known)
        return self._slept[1] or mine.statement


def _in_steps(own: ByScenario, every: Sequence[ByScenario], name: str, what: str) -> str:
    """Below a limit, whatever was before."""
    if name not in own or not own[name].seen:
        return ""
    return sleep_law(_showing(every), what) or sleep_law([*own.values()], what)


def _of_kind(own: ByScenario, every: Sequence[ByScenario], name: str, what: str) -> str:
    """The same, of bodies that are free, or pivoted, as this one is."""
    if name not in own or not own[name].seen:
        return ""
    pivoted = own[name].pivoted
    alike = [
        [one for one in each if one.pivoted is pivoted]
        for each in (_showing(every), [*own.values()])
    ]
    found = sleep_law(alike[0], what) or sleep_law(alike[1], what)
    kind = f"{what} where the body is {'pivoted' if pivoted else 'free'} and"
    return found.replace(f"{what} where", kind)


def _showing(every: Sequence[ByScenario]) -> list[Rests]:
    """Of all scenarios of the integrators of which one at least shows it."""
    shown = [each for each in every if any(one.seen for one in each.values())]
    return [one for each in shown for one in each.values()]
