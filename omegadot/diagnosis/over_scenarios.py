"""What is kept of one engine over the scenarios of a run: its equations, and of its integrators."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.left_over import LeftOver
from omegadot.diagnosis.equations.siblings import Siblings
from omegadot.diagnosis.reported.known_run import Known
from omegadot.diagnosis.reported.onsets import Onset
from omegadot.diagnosis.run_rules import ENDS, KeptRuns
from omegadot.diagnosis.stepping.order_lost import OrderLost
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.diagnosis.stepping.vanishing.follows import Beginning, Followed, follows
from omegadot.diagnosis.stepping.vanishing.freezes import FREEZES
from omegadot.diagnosis.stepping.vanishing.rests import SLEEPS, Rests, sleep_law
from omegadot.diagnosis.stepping.vanishing.sleep_counts import Sleeps, law_of_sleep
from omegadot.diagnosis.wording.kinds import is_named
from omegadot.written import written


@dataclass
class OverScenarios:
    """Of one integrator, by scenario.

    runs: what is kept of them.  causes: each alone explains the runs, and whether these are
    decisive.  fails: whether a run does.  again: what shows where two answers to one request
    differ.  lost: orders.  seen: what is off.  beginnings: of the failed runs.  turned: by what
    angle in rad first steps turn the body, and whether later ones are seen not to.  stays_below: s,
    up to which length steps change nothing, and from which on they do.  keeps_pace: whether runs go
    on as much too fast, or too slowly, as first steps do.  rests: at what states the body is put to
    rest, and frozen: at what states steps leave it as it is.  places: causes in every step, with
    where they act.  substeps: in which of these a load acts, of causes that scale it.  onsets:
    where failed runs begin to be wrong that are sound until then.
    """

    runs: KeptRuns = field(default_factory=KeptRuns)
    causes: dict[str, tuple[tuple[str, ...], bool]] = field(default_factory=dict)
    fails: dict[str, bool] = field(default_factory=dict)
    again: str = ""
    lost: dict[str, OrderLost] = field(default_factory=dict)
    seen: dict[str, Known] = field(default_factory=dict)
    beginnings: dict[str, Beginning] = field(default_factory=dict)
    turned: dict[str, tuple[float, bool]] = field(default_factory=dict)
    keeps_pace: dict[str, bool] = field(default_factory=dict)
    stays_below: dict[str, tuple[float, float]] = field(default_factory=dict)
    rests: dict[str, Rests] = field(default_factory=dict)
    frozen: dict[str, Rests] = field(default_factory=dict)
    places: dict[tuple[str, int], str] = field(default_factory=dict)
    substeps: dict[tuple[str, int], str] = field(default_factory=dict)
    onsets: dict[str, list[Onset]] = field(default_factory=dict)
    _together: tuple[int, list[str]] = (0, [])
    _likely: tuple[int, bool, bool] = (0, False, False)
    _followed: dict[tuple[tuple[str, ...], str], Followed | None] = field(default_factory=dict)

    def together(self, integrator: Integrator) -> list[str]:
        """What makes all runs of the integrator that have been kept; none where none does."""
        kept = self.runs.kept
        if self._together[0] != len(kept):
            self._together = len(kept), causes_over_runs(integrator, kept)
        return self._together[1]

    def likely(self, integrator: Integrator, again: bool) -> bool:
        """Whether the runs that have been kept so far have a cause together.

        It is looked for again each time that twice as many scenarios fail.
        again: whether two answers to one request differ, which but for their ends has another.
        """
        kept = self.runs.kept
        failing = len({run.name for run in kept if run.fails}).bit_length()
        if self._likely[0] != failing:
            self._likely = failing, False, False
            if failing > 1:
                ended = self.runs.rule(ENDS, integrator) is not None
                known = any(True for _ in self.runs.rules(integrator))
                known = known or any(map(is_named, causes_over_runs(integrator, kept)))
                self._likely = failing, known, ended
        _, found, ended = self._likely
        return ended if again else found

    @property
    def begins(self) -> str:
        """At which other attitude runs begin; "" where none is seen to."""
        if not any(alone for _, alone in self.turned.values()):
            return ""
        angle = float(np.median([angle for angle, _ in self.turned.values()]))
        return f"runs begin at an attitude that is some {written(angle, 1)} rad from the one given"

    def followed(
        self, one: Candidate, evidence: Mapping[str, Evidence], eps: float
    ) -> set[Followed | None]:
        """Which equation the failed runs follow where a cause fits the steps as they vanish.

        One mistake is made in every run, or in the first steps of every run. evidence: of these
        steps by scenario, where the cause may have other numbers.
        """
        names = evidence.keys() & self.beginnings.keys()
        for name in names:
            if (one.key, name) not in self._followed:
                here = one.fitting(evidence[name])
                answer = follows(self.beginnings[name], here, eps) if here is not None else None
                self._followed[one.key, name] = answer
        return {v for (key, name), v in self._followed.items() if key == one.key and name in names}


@dataclass
class EngineOverScenarios:
    """Of one engine. across: the equations that its scenarios show.  integrators: by name.

    siblings: what the same systems show with one thing changed.  left_over: what is kept of a
    system loaded before, in both.
    """

    left_over: LeftOver = field(default_factory=LeftOver)
    across: Across = field(init=False)
    siblings: Siblings = field(init=False)
    integrators: dict[str, OverScenarios] = field(
        default_factory=lambda: defaultdict(OverScenarios)
    )
    _slept: tuple[tuple[Sleeps, ...], str] = ((), "")

    def __post_init__(self) -> None:
        """Both are looked at together: what is kept is often decided by a small change."""
        self.across, self.siblings = Across(self.left_over), Siblings(self.left_over)

    def sleep(self, integrator: str, name: str) -> str:
        """Where the body is put to sleep, on a scenario of this name that shows it; else "".

        One rule of all integrators that put it to sleep; where there is none, of this one.
        """
        return (
            self._below_a_limit(integrator, name, "rests", SLEEPS)
            or self._after_steps(integrator, name)
            or self._below_a_limit(integrator, name, "frozen", FREEZES)
        )

    def _after_steps(self, integrator: str, name: str) -> str:
        """One rule of all integrators whose runs fall asleep after some steps, or of this one."""
        own = self.integrators[integrator].runs.sleeps
        if own is None or name not in own.names:
            return ""
        every = [over.runs.sleeps for over in self.integrators.values()]
        known = tuple(one for one in every if one is not None)
        if self._slept[0] != known:
            self._slept = known, law_of_sleep(known)
        return self._slept[1] or own.statement

    def _below_a_limit(self, integrator: str, name: str, which: str, what: str) -> str:
        """One rule of all bodies, or of those that are free, or pivoted, as this one is."""
        own: dict[str, Rests] = getattr(self.integrators[integrator], which)
        if name not in own or not own[name].seen:
            return ""
        every = [[*getattr(over, which).values()] for over in self.integrators.values()]
        asleep = [one for rests in every if any(one.seen for one in rests) for one in rests]
        pivoted, mine = own[name].pivoted, [*own.values()]
        found = sleep_law(asleep, what) or sleep_law(mine, what)
        if found or which == "rests":
            return found
        support = f"{what} where the body is {'pivoted' if pivoted else 'free'} and"
        alike = [[one for one in each if one.pivoted is pivoted] for each in (asleep, mine)]
        found = sleep_law(alike[0], what) or sleep_law(alike[1], what)
        return found.replace(f"{what} where", support)
