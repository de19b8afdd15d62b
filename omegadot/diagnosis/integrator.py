"""The causes of one integrator's failures on one case: in its steps as they vanish, in its runs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.known import scenarios_in_common
from omegadot.diagnosis.in_steps import StepCauses
from omegadot.diagnosis.kept_case import kept_case
from omegadot.diagnosis.models.kept_place import kept_place
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.known_run import known_of_runs
from omegadot.diagnosis.reported.onsets import SOUND_UNTIL, onset_law
from omegadot.diagnosis.reported.requests import AGAIN
from omegadot.diagnosis.reported.singles import IN_SINGLE
from omegadot.diagnosis.run_rules import ENDS, LENGTHS, MOVED, READ, STARTS
from omegadot.diagnosis.runs import NOTHING, RunCauses, onsets_of, run_causes
from omegadot.diagnosis.stepping.kept_run import scheme_of
from omegadot.diagnosis.stepping.loads.load_spell_laws import OF_SHARE
from omegadot.diagnosis.stepping.order_lost import OrderLost
from omegadot.diagnosis.stepping.other_equations import is_refuted
from omegadot.diagnosis.stepping.turns.between_steps import passes_between
from omegadot.diagnosis.stepping.vanishing.jumps import jumps, slight_jump_cause
from omegadot.diagnosis.stepping.vanishing.kinematics import (
    kinematic_causes,
    least_step,
    still_cause,
)
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.stepping.where_stepped import makes_runs, where_stepped
from omegadot.diagnosis.wording.features import surely_only_where
from omegadot.diagnosis.wording.kinds import (
    agreed,
    either,
    is_fact,
    is_named,
    is_of_one_run,
    kind_of,
    over_run,
)
from omegadot.gates.case import Case
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun

# Scenarios on which the runs of an integrator are looked at in vain, before no more is looked for
# than what is seen of a run: stepping again by all that may be wrong takes long. The order that
# steps have lost explains them.
VAIN, VAIN_BESIDE_ORDER = 8, 3
LOGGED = "the run is logged"
AFTER_STEP = f"{IN_SINGLE} after each step"
OF_ONE_FIELD = "alone is wrong in the run"  # which the order that it has lost may explain


class IntegratorCauses:
    """The causes of one integrator's failures on one case, worked out when they are needed."""

    def __init__(
        self,
        engine: EngineOverScenarios,
        case: Case,
        truth: Truth,
        result: CaseResult,
        runs: Sequence[JudgedRun],
    ) -> None:
        self._engine = engine
        self._across, self._case, self._truth = engine.across, case, truth
        self._result: CaseResult | None = result
        self._runs = list(runs)
        self._integrator = runs[0].integrator
        over = self._over = engine.integrators[self._integrator.name]
        self._kept = kept_case(over, case, truth, result, runs)
        self.steps = self._kept.steps
        self._in_steps = StepCauses(self._across, over, self._kept, self._of_trajectories)
        self._of_runs: RunCauses | None = None

    @property
    def integrator(self) -> Integrator:
        """The integrator, as the engine declares it."""
        return self._integrator

    def release(self, wanted: bool) -> None:
        """Work out what needs the trajectories, where it is wanted."""
        if wanted and any(run.fails for run in self._runs) and self._result is not None:
            failed = [run for run in self._runs if run.fails]
            steps = [r.sweep.timestep for r in self._runs if r.sweep.accuracy is None]
            shortest = min(steps, default=0.0)
            seen = known_of_runs(self._truth, self._result, failed, shortest)
            if seen is not None:
                self._over.seen[self._case.name] = seen
            if not self._over.likely(self._integrator, bool(self._kept.again)):
                found = self._of_case()
                if any(SOUND_UNTIL in text for text in found):
                    how = (self._case, self._truth, self._result, self._runs)
                    self._over.onsets[self._case.name] = onsets_of(*how)

    def let_go(self) -> None:
        """Keep the trajectories no longer."""
        self._result, self._runs = None, []

    def sentences(self) -> list[str]:
        """What makes the runs of all scenarios together, or else what this one shows.

        Where all together show no more than in which places they are wrong, a cause of this one
        is more.
        """
        asleep = self._engine.sleep(self._integrator.name, self._case.name)
        if asleep and not self._kept.again:
            return [asleep]
        fails, together = self._over.fails[self._case.name], list[str]()
        rules = self._of_rules() if fails else []
        if rules:
            return rules
        if fails:
            together = self._together()
            if any(map(is_named, together)):
                return together
        own = [self._where(text) for text in self._of_case()]
        if any(SOUND_UNTIL in text for text in own):
            law = onset_law([one for runs in self._over.onsets.values() for one in runs])
            own = [law] if law else own
        return own if any(map(is_named, own)) else together or own

    def _of_rules(self) -> list[str]:
        """Where all runs begin or end, how samples are read, of which step these or a term are."""
        name, again, how = self._case.name, self._kept.again, self._integrator
        runs, begins = self._over.runs, ""
        if again == AGAIN["negated"]:
            begins = runs.explains_negated(how, name)
        kinds = (ENDS, MOVED) if again else (STARTS, READ, ENDS, MOVED, LENGTHS)
        found = begins or next(filter(None, (runs.explains(k, how, name) for k in kinds)), "")
        return [found] if found else []

    def _together(self) -> list[str]:
        """What makes the runs of all scenarios, and two answers to one request where these differ.

        A run of other steps is another share of a run.
        """
        again = self._kept.again
        if again and again not in (AGAIN["repeated"], AGAIN["negated"]):
            return []
        together = self._over.together(self._integrator)
        if again == AGAIN["repeated"]:
            return [text for text in together if OF_SHARE in text]
        return [text for text in together if self._makes_negated(text)] if again else together

    def _makes_negated(self, text: str) -> bool:
        """Whether what the attitude goes through between steps makes the run from -q as well."""
        by, own = scheme_of(self._integrator, self._over.runs.kept), self._over.runs.negated
        runs = [run for run in own if run.name == self._case.name]
        return by is not None and bool(runs) and all(passes_between(text, by, r) for r in runs)

    def follows(self, text: str) -> bool:
        """Whether a cause that is named on another scenario makes the runs of this one."""
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            return makes_runs(text, self._integrator, self._over.runs.kept, self._case.name)

    def outgrown(self, name: str) -> bool:
        """Whether what makes the steps of another scenario makes the runs here, too fast to see."""
        steps = self.steps
        if steps is None or self._kept.again:
            return False
        with np.errstate(all="ignore"):
            return self._in_steps.outgrown(steps, name)

    def _where(self, text: str) -> str:
        """A cause in every step, with the scenarios on which alone it acts."""
        places, key = self._over.places, (text, len(self._over.runs.kept))
        if key not in places:
            features = {name: one.features for name, one in self._across.scenes.items()}
            with np.errstate(all="ignore"):
                kept = self._over.runs.kept
                places[key] = where_stepped(text, self._integrator, kept, features)
        return places[key]

    def _of_case(self) -> list[str]:
        """Of the steps as they vanish and of the run itself.

        What a declared scheme makes of a wrong state is known better by stepping again than by
        the steps as they vanish; a wrong equation is known better by these.
        """
        steps = self.steps
        if self._kept.again:
            seen = self._of_trajectories()
            return [one for one in seen if is_of_one_run(one)] or [self._again]
        if steps is None or steps.sound:
            found = self._of_trajectories()
            own = self._over.lost.get(self._case.name)
            lost = own.with_others(self._over.lost.values()) if own and own.orders else None
            if not found or any(OF_ONE_FIELD in text for text in found) or self._beyond(lost):
                found = [lost.text] if lost is not None else found
            return found or self._known_of_runs()
        if self._over.again:  # what is left over from a run spoils the short ones that follow
            return [self._over.again]
        if steps.stays_below[0] > 0.0:
            limit = self._short_steps(steps)
            if limit:
                return limit
        slight = either([slight_jump_cause(steps)]) if not jumps(steps) else []
        if slight:  # by which the rates at no step are no rates
            found = [one for one in self._of_trajectories() if not is_fact(one)]
            return found or self._single(steps) or slight
        found = self._in_steps.sentences(steps) or self._of_trajectories()
        if self._case.name in self._over.turned and all(map(is_fact, found)):
            begins = self._over.begins
            found = [begins] if begins else found
        jumped = self._in_steps.jumped(steps)
        if any(OF_ONE_FIELD in text for text in found):
            found = jumped or found
        last = found or jumped or either(kinematic_causes(steps))
        last = last or either([still_cause(steps)])
        if not any(map(is_named, last)):
            last = self._single(steps) or last
        if last:
            return last
        return self._in_steps.known(steps) or self._known_of_runs()

    @property
    def _again(self) -> str:
        """What shows in runs that are requested again; of another system what is kept, if known."""
        again, scenes = self._kept.again, list(self._across.scenes.values())
        of_system = again == AGAIN["reloaded"]
        kept = kept_place(scenes, self._case, self._truth.yardstick.eps) if of_system else ""
        return f"{again}: {kept}" if kept else again

    def _single(self, steps: VanishingSteps) -> list[str]:
        """That numbers after a step are of single precision, as the runs of most scenarios are.

        One step does not show whether they are kept so, or only so reported.
        """
        if not steps.single:
            return []
        every = (text for texts, _ in self._over.causes.values() for text in texts)
        known = Counter(t for t in every if t.startswith(steps.single) and IN_SINGLE in t)
        return [known.most_common(1)[0][0] if known else f"{steps.single} {AFTER_STEP}"]

    def _short_steps(self, steps: VanishingSteps) -> list[str]:
        """Steps that are too short to move a body; none where that is not what is wrong.

        Where no step moves any, whatever its length, the run may as well be logged late.
        """
        every = self._over.stays_below.values()
        longest = max(still for still, _ in every)
        brief = [run for run in self._over.runs.kept if run.timestep <= longest]
        by = scheme_of(self._integrator, self._over.runs.kept) if brief else None
        if any(run.moves or (by is not None and run.goes_on(by)) for run in brief):
            return []  # it is the first step alone
        limit = least_step(every)
        if any(np.isfinite(moving) for _, moving in every):
            return [limit] if limit else []
        late = [text for text in self._of_trajectories() if LOGGED in text]
        return late or [limit or least_step([steps.stays_below])] * steps.still

    def _beyond(self, lost: OrderLost | None) -> bool:
        """Whether what makes single steps lose their order explains more scenarios than a run does.

        Those besides that its cause makes are as many, at least.
        """
        if lost is None or not lost.by:
            return False
        here = set(map(kind_of, self._of_runs.texts)) if self._of_runs is not None else set()
        shown = dict[str, bool]()  # by scenario: whether its runs are made by what makes these
        for name, (texts, _) in self._over.causes.items():
            shown[name] = bool(here & set(map(kind_of, texts)))
        losing = {name for name, one in self._over.lost.items() if one.orders}
        same = [name for name, made in shown.items() if made]
        others = [name for name in losing if name in shown and not shown[name]]
        return all(name in losing for name in same) and len(others) >= max(1, len(same))

    def _known_of_runs(self) -> list[str]:
        """What is seen of the runs where nothing fits, and in which scenarios alone."""
        fails_in = self._over.fails
        scenes = self._across.scenes
        failing, passing = (
            [s.features for name, s in scenes.items() if fails_in.get(name) is wrong]
            for wrong in (True, False)
        )
        own = self._over.seen.get(self._case.name)
        seen = own.with_others(self._over.seen.values()).text if own else ""
        texts = [text for text in (seen, scenarios_in_common(failing, passing)) if text]
        return [f"none is known; {'; '.join(texts)}"] if texts else []

    def _of_trajectories(self) -> list[str]:
        """What makes the runs, and most of those of the other cases."""
        over = self._over.causes
        if self._of_runs is None:
            self._of_runs = NOTHING
            vain = sum(not any(map(is_named, texts)) for texts, _ in over.values())
            lost = self._over.lost.get(self._case.name)
            most = VAIN_BESIDE_ORDER if lost is not None and lost.orders else VAIN
            named = vain < len(over)
            looked = named or any(texts for texts, _ in over.values()) or vain < most
            if self._result is not None and looked:
                # a wrong equation shows in steps that vanish, and from more states
                wrong = self.steps is None or not np.all(self.steps.evidence.sound)
                how = (self._case, self._truth, self._result, self._runs)
                deep = named or vain < most
                self._of_runs = run_causes(*how, equations=wrong, deep=deep)
                if self._of_runs.tried:
                    over[self._case.name] = (self._of_runs.texts, self._of_runs.decisive)
        known = {name: texts for name, (texts, _) in over.items()}
        texts = self._not_refuted(agreed(self._of_runs.texts, over), known)
        return either([over_run(text, known) for text in texts])

    def _not_refuted(self, texts: Sequence[str], known: Mapping[str, Sequence[str]]) -> list[str]:
        """Of equations that the steps of sound scenarios refute, on which bodies alone they are so.

        They are left out where that is not known.
        """
        scenes, found = self._across.scenes, list[str]()
        for text in texts:
            every = ((scene, scene.evidence.get(self._kept.source)) for scene in scenes.values())
            against = [s.features for s, e in every if e is not None and is_refuted(text, e)]
            shown = [scenes[name].features for name, own in known.items() if text in own]
            left = surely_only_where(text, shown, against) if against else text
            found += [left] if left else []
        return found
