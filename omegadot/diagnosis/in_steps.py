"""Causes in the steps of one integrator as they vanish: their length, motion and equation."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD
from omegadot.diagnosis.equations.wrong_equation import known_difference
from omegadot.diagnosis.kept_case import KeptCase, source_of
from omegadot.diagnosis.over_scenarios import OverScenarios
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.loads.substeps import part_named, part_of, substep_cause
from omegadot.diagnosis.stepping.vanishing.follows import Followed
from omegadot.diagnosis.stepping.vanishing.jumps import (
    BEGINS_UNSIGNED,
    STOPPED,
    UNSIGNED,
    jump_cause,
    jumps,
)
from omegadot.diagnosis.stepping.vanishing.kinematics import (
    kinematic_causes,
    moves_by_cause,
    omega_share_cause,
    omega_still_cause,
    velocity_share_cause,
)
from omegadot.diagnosis.stepping.vanishing.outrun import outruns
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.wording.kinds import either

OF_LOAD = re.compile(
    r"((?:the applied torque|the torque|the damping|gravity).*) is scaled by ([\d.e-]+)(?: \(.*\))?"
)
WHOLE = "; forward dynamics has it whole"
IN_THE_FIRST = "at the start of a run alone"
FIRST_ALONE = "only the first steps are wrong"  # which states less than what is wrong in them


def _signed(run: KeptRun) -> bool:
    """Whether a sample after the start has a quaternion with a negative scalar part."""
    return bool(np.any(run.state.orientation[1:, 0] < 0.0))


class StepCauses:
    """Of one integrator on one case.

    of_trajectories: what makes its runs, which may show more than the steps do.
    """

    def __init__(
        self,
        across: Across,
        over: OverScenarios,
        kept: KeptCase,
        of_trajectories: Callable[[], list[str]],
    ) -> None:
        self._across, self._over, self._kept = across, over, kept
        self._of_trajectories = of_trajectories

    def sentences(self, steps: VanishingSteps) -> list[str]:
        """Where every state is off by the steps alone, the more basic first."""
        if steps.rounded:
            return [steps.rounded]
        if steps.late_velocity:
            late = f"the {steps.late_velocity} of the step before"
            return [f"the linear velocity of a pivoted body is reported by {late}"]
        common = steps.common_cause()
        if common:
            # on some motions what a wrong first step leaves behind turns the body faster later
            pace = [*self._over.keeps_pace.values()]
            first = 2 * sum(pace) < len(pace)
            if not first:
                return [common]
            seen = [one for one in self._of_trajectories() if not one.startswith(FIRST_ALONE)]
            return seen or [f"{IN_THE_FIRST}: {common}"]
        if jumps(steps):
            return [] if self._kept.declares else self.jumped(steps)
        if steps.still:
            return []
        moved = moves_by_cause(steps)
        if moved:  # where it is either of two, a whole run may show which
            return (self._of_trajectories() if moved.startswith("either") else []) or [moved]
        return either(kinematic_causes(steps)) or self._of_omega(steps)

    def jumped(self, steps: VanishingSteps) -> list[str]:
        """What a step does to a state however short it is.

        Where a damping that is wrong on other scenarios stops the body within such steps, it is
        that damping; where what is wrong with it is not known, nothing is named.
        """
        found, load = jump_cause(steps, self._kept.beginning), steps.system.load
        if found == UNSIGNED and any(_signed(run) for run in self._over.runs.kept):
            found = BEGINS_UNSIGNED
        if found not in ("", STOPPED) or not np.any(load.damping) or not np.any(steps.jumps):
            return either([found])
        source = self._kept.source
        every = ((n, s) for n, s in self._across.scenes.items() if source in s.evidence)
        damped = [n for n, s in every if np.any(s.system.load.damping) and s.evidence[source].clear]
        for name in damped:
            text, one = self._across.cause(name, source), self._across.chosen(name, source)
            if one is not None and outruns(one, steps):
                return [f"in the steps, {text}"]
        return [] if damped else either([found])

    def _of_omega(self, steps: VanishingSteps) -> list[str]:
        """Omega is of another time than the rest, or the equation that it follows is another."""
        if not steps.evidence.clear:
            return []
        share = omega_share_cause(steps)
        if share and not self._kept.turned_wrong and not self._kept.brief:
            return [share]
        found = self._of_equation(steps)
        if any(one.startswith(IN_THE_FIRST) or f"or {IN_THE_FIRST}" in one for one in found):
            seen = [one for one in self._of_trajectories() if not one.startswith(FIRST_ALONE)]
            found = seen or found
        if share and not self._kept.turned_wrong:
            return either([share, *found])
        return found

    def _of_equation(self, steps: VanishingSteps) -> list[str]:
        """By which equation the limit of vanishing steps is another; nothing where it is right."""
        if np.all(steps.evidence.sound) or not steps.turns:
            return []
        where = (self._kept.name, self._kept.source)
        still = omega_still_cause(steps)
        if still:
            return self._of_trajectories() or [still]
        text, one = self._across.cause(*where), self._across.chosen(*where)
        if not text:
            return []
        alike = self._across.explained(*where)
        scenes = self._across.scenes
        evidence = {
            n: scenes[n].evidence[where[1]] for n in alike if where[1] in scenes[n].evidence
        }
        followed = set[Followed | None]()
        if one is not None and not one.is_limit:
            followed = self._over.followed(one, evidence, steps.eps)
        # a run that follows the wrong equation to its end is nowhere nearer to the right one
        between = "between" in followed and "wrong" not in followed
        if between or {"right", "wrong"} <= followed:
            later = "later steps come nearer to the right equation"
            return [f"at the start of a run, {text}; {later}"]
        if "right" in followed:
            first = f"{IN_THE_FIRST}, {text}"
            return either([velocity_share_cause(steps), first])
        return [f"in the steps, {self._in_part(text)}"]

    def _in_part(self, text: str) -> str:
        """A cause, or what it is of a load that acts in a part of each step alone.

        The limit of vanishing steps does not distinguish the two; whole runs may, by the substeps.
        """
        scaled, kept = OF_LOAD.fullmatch(text), self._over.runs.kept
        part = part_of(float(scaled[2])) if scaled is not None else None
        if scaled is None or part is None:
            return text
        key = (text, len(kept))
        if key not in self._over.substeps:
            declared = self._kept.declares  # a scheme that is declared has no substeps
            self._over.substeps[key] = "" if declared else substep_cause(scaled[1], part, kept)
        seen = self._over.substeps[key]
        either = f"{text}, or acts in {part_named(part)} of each step alone"
        forward = self._across.scenes[self._kept.name].evidence.get(FORWARD)
        whole = forward is not None and bool(np.all(forward.sound))
        return f"{seen or either}{WHOLE if whole else ''}"

    def outgrown(self, steps: VanishingSteps, name: str) -> bool:
        """Whether what makes the steps of another scenario outgrows those of this one.

        They show nothing then, and the steps of another integrator have it here, by its own number.
        """
        scenes, own, here = self._across.scenes, self._kept.source, self._kept.name
        evidence, elsewhere = scenes[here].evidence, scenes[name].evidence
        if own not in evidence or evidence[own].clear or own not in elsewhere:
            return False
        named = bool(self._across.cause(name, own)) and elsewhere[own].clear
        for source in evidence if named else ():
            if source == own or not source.startswith(source_of("")):
                continue
            one = self._across.chosen(here, source)
            if one is not None and one.fitting(elsewhere[own]) is not None:
                return outruns(one, steps)
        return False

    def known(self, steps: VanishingSteps) -> list[str]:
        """What is known of the steps' equation where nothing fits."""
        if np.all(steps.evidence.sound):
            return []
        known = known_difference(self._across, self._kept.name, self._kept.source)
        return [one.replace("none is known; ", "none is known; in the steps, ", 1) for one in known]
