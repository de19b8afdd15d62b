"""What is kept of one engine over the scenarios of a run: its equations, and of its integrators."""

from __future__ import annotations

from collections import Counter, defaultdict
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
from omegadot.diagnosis.sleep_rules import Shown, SleepRules
from omegadot.diagnosis.stepping.order_lost import OrderLost
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.diagnosis.stepping.vanishing.follows import Beginning, Followed, follows
from omegadot.diagnosis.wording.kinds import is_named
from omegadot.written import written

FEW = 2  # as many runs follow another equation


@dataclass
class OverScenarios:
    """Of one integrator, by scenario.

    runs: what is kept of them.  causes: each alone explains the runs, and whether these are
    decisive.  fails: whether a run does.  again: what shows where two answers to one request
    differ.  lost: orders.  seen: what is off.  beginnings: of the failed runs.  turned: by what
    angle in rad first steps turn the body, and whether later ones are seen not to.  stays_below: s,
    up to which length steps change nothing, and from which on they do.  keeps_pace: whether runs go
    on as much too fast, or too slowly, as first steps do.  asleep: what shows that bodies are put
    to sleep, or left as they are.  places: causes in every step, with where they act.  substeps: in
    which of these a load acts, of causes that scale it.  onsets: where failed runs begin to be
    wrong that are sound until then.
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
    asleep: Shown = field(init=False)
    places: dict[tuple[str, int], str] = field(default_factory=dict)
    substeps: dict[tuple[str, int], str] = field(default_factory=dict)
    onsets: dict[str, list[Onset]] = field(default_factory=dict)
    _together: tuple[int, list[str]] = (0, [])
    _likely: tuple[int, bool, bool] = (0, False, False)
    _followed: dict[tuple[tuple[str, ...], str], Followed | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """The runs show sleep as well as single steps do."""
        self.asleep = Shown(self.runs)

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
                known = known or self.runs.sleeps is not None
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

        One mistake is made in every run, or in the first steps of every run: what less than half as
        many runs follow as another equation is an error of the scheme. evidence: of these steps by
        scenario, where the cause may have other numbers.
        """
        names = evidence.keys() & self.beginnings.keys()
        for name in names:
            if (one.key, name) not in self._followed:
                here = one.fitting(evidence[name])
                answer = follows(self.beginnings[name], here, eps) if here is not None else None
                self._followed[one.key, name] = answer
        own = ((name, v) for (key, name), v in self._followed.items() if key == one.key)
        counts = Counter(v for name, v in own if name in names and v is not None)
        most = max(counts.values(), default=0)
        return {v for v, count in counts.items() if FEW * count >= most}


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
    _sleep: SleepRules = field(default_factory=SleepRules)

    def __post_init__(self) -> None:
        """Both are looked at together: what is kept is often decided by a small change."""
        self.across, self.siblings = Across(self.left_over), Siblings(self.left_over)

    def sleep(self, integrator: str, name: str) -> str:
        """Where the body is put to sleep, on a scenario of this name that shows it; else ""."""
        own = self.integrators[integrator].asleep
        return self._sleep.rule(own, [over.asleep for over in self.integrators.values()], name)
