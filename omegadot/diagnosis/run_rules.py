"""Rules that all runs of an integrator follow: where they begin, and of what steps samples are."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.lagging_fields import lagging_fields
from omegadot.diagnosis.stepping.ends.last_samples import RunEnd
from omegadot.diagnosis.stepping.ends.moved_samples import Moved, moved_samples
from omegadot.diagnosis.stepping.ends.read_out import ReadOut, samples_read
from omegadot.diagnosis.stepping.ends.run_ends import Ends, other_ends
from omegadot.diagnosis.stepping.ends.starts import Starts, other_start
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.turns.factor_lengths import OtherLengths, other_lengths
from omegadot.diagnosis.stepping.vanishing.sleep_counts import sleeping_runs
from omegadot.diagnosis.stepping.vanishing.sleep_laws import Sleeps
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.reference_impl.system import State

# Each has a statement of all runs, and names of the scenarios whose failed runs this explains.
RunRule = Starts | ReadOut | Ends | Moved | OtherLengths


@dataclass
class KeptRuns:
    """What is kept of the runs of one integrator, over the scenarios so far.

    kept: the first samples of every run.  negated: of those that are requested again from -q.
    ends: the last two samples of every run.  By scenario, steps and given: first steps from many
    states, as they vanish, and the state that runs are given.  requested: s, the lengths of steps
    of all runs, as they were requested.  integrator: whose runs these are.
    """

    integrator: Integrator | None = None

    kept: list[KeptRun] = field(default_factory=list)
    negated: list[KeptRun] = field(default_factory=list)
    ends: list[RunEnd] = field(default_factory=list)
    steps: dict[str, VanishingSteps] = field(default_factory=dict)
    given: dict[str, State] = field(default_factory=dict)
    requested: dict[str, list[float]] = field(default_factory=dict)
    _found: dict[str, tuple[tuple[int, ...], RunRule | None]] = field(default_factory=dict)
    _slept: tuple[int, Sleeps | None] = (0, None)

    def rule(self, kind: str, integrator: Integrator) -> RunRule | None:
        """The rule of this kind, of KINDS; looked for again where more is kept."""
        size = (len(self.kept), len(self.ends), len(self.steps))
        if self._found.get(kind, (None, None))[0] != size:
            self._found[kind] = size, KINDS[kind](integrator, self)
        return self._found[kind][1]

    def rules(self, integrator: Integrator) -> Iterator[RunRule]:
        """Those that are found, of all kinds."""
        return (one for kind in KINDS if (one := self.rule(kind, integrator)) is not None)

    def explains(self, kind: str, integrator: Integrator, name: str) -> str:
        """What the rule of this kind states, where it explains the runs of a scenario; else ""."""
        found = self.rule(kind, integrator)
        return found.statement if found is not None and name in found.names else ""

    @property
    def sleeps(self) -> Sleeps | None:
        """After what a body is put to sleep in these runs; None where none is seen to be."""
        if self.integrator is not None and self._slept[0] != len(self.kept):
            self._slept = len(self.kept), sleeping_runs(self.integrator, self.kept)
        return self._slept[1]

    def explains_negated(self, integrator: Integrator, name: str) -> str:
        """At which other state all runs begin, where that makes those from -q; else ""."""
        found = self.rule(STARTS, integrator)
        runs = [run for run in self.negated if run.name == name]
        if not isinstance(found, Starts) or not runs or name not in self.given:
            return ""
        given = self.given[name]
        other = replace(given, orientation=-given.orientation)
        return found.statement * all(found.makes(run, other) for run in runs)


STARTS, READ, ENDS, MOVED = "starts", "read", "ends", "moved"
LENGTHS = "lengths"
KINDS: Mapping[str, Callable[[Integrator, KeptRuns], RunRule | None]] = {
    STARTS: lambda how, runs: other_start(how, runs.steps, runs.given, runs.kept),
    READ: lambda how, runs: samples_read(how, runs.steps, runs.given, runs.kept),
    ENDS: lambda how, runs: other_ends(how, runs.ends, runs.kept),
    MOVED: lambda how, runs: (
        moved_samples(how, runs.kept) or lagging_fields(how, runs.kept, runs.given)
    ),
    LENGTHS: lambda how, runs: other_lengths(how, runs.steps, runs.kept, runs.requested),
}
