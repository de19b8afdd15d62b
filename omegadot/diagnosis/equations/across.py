"""One engine's wrong equation over all scenarios of a run: which of several causes is named."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from omegadot.diagnosis.equations.acting_torques import acting_torques
from omegadot.diagnosis.equations.at_states import AtSomeStates, where_wrong
from omegadot.diagnosis.equations.axis_mass import axis_mass
from omegadot.diagnosis.equations.by_formula import Formulas
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.carried import Carried
from omegadot.diagnosis.equations.evidence import FORWARD, INVERSE, Evidence
from omegadot.diagnosis.equations.families.one_number import AXIS
from omegadot.diagnosis.equations.held import Scene, Scenes
from omegadot.diagnosis.equations.inverse_series import inverse_series
from omegadot.diagnosis.equations.known import kinds_off, known_over
from omegadot.diagnosis.equations.left_over import LeftOver
from omegadot.diagnosis.equations.limited_inertia import limited_inertia
from omegadot.diagnosis.equations.mistyped import Mistyped
from omegadot.diagnosis.equations.near_inertia import near_inertia
from omegadot.diagnosis.equations.pivot_inertia import pivot_inertia
from omegadot.diagnosis.equations.searched import PLAIN, QUICK, Searched
from omegadot.diagnosis.equations.solve_matrix import solve_matrix
from omegadot.diagnosis.equations.worded import Named, named, on_some, on_these_alone
from omegadot.diagnosis.equations.wrong_inverse import WrongInverse
from omegadot.diagnosis.models.attitudes_read import attitudes_read
from omegadot.diagnosis.wording.kinds import EITHER

Rule = Callable[[Sequence[Evidence]], str]  # of all scenarios of one source
NOT_ON = ", not on "  # of a cause that other scenarios would show: a rule may say which
OF_INERTIA: tuple[Rule, ...] = (axis_mass, near_inertia, inverse_series, limited_inertia)


class Across:
    """The scenarios of one engine so far, and the causes found among them.

    left_over: what is kept of systems, of these scenarios and maybe others.
    """

    def __init__(self, left_over: LeftOver | None = None) -> None:
        self._all = Scenes()
        self._searched, self._formulas = Searched(self._all), Formulas(self._all)
        self._at_states, self._carried = AtSomeStates(self._all), Carried(self._all)
        self._left_over = LeftOver() if left_over is None else left_over
        self._mistyped = Mistyped(self._all)
        self._inverse = WrongInverse()
        self._named: dict[tuple[str, str], Named] = {}
        self._known: dict[tuple[str, tuple[str, ...]], str] = {}
        self._rules: dict[tuple[Rule, str], str] = {}
        self._read: str | None = None

    @property
    def scenes(self) -> dict[str, Scene]:
        """By name."""
        return self._all.by_name

    def add(self, scene: Scene) -> None:
        """One more scenario; what was found before may not hold any more."""
        self._searched.add(scene)
        self._formulas.add()
        self._at_states.add(scene)
        self._left_over.add(scene)
        if INVERSE in scene.evidence:
            self._inverse.add(scene.name, scene.evidence[INVERSE], scene.features)
        self._carried, self._mistyped = Carried(self._all), Mistyped(self._all)
        self._named, self._known, self._rules = {}, {}, {}
        self._read = None

    def attitudes_read(self) -> str:
        """The convention of attitudes that are read back, and reported in runs; "" without one."""
        if self._read is None:
            scenes = [*self.scenes.values()]
            pairs = [one.states for one in scenes if one.states is not None]
            limits = [pair for one in scenes for pair in one.limits]
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                self._read = attitudes_read(pairs, limits)
        return self._read

    def cause(self, name: str, source: str) -> str:
        """The cause on one scenario; "" where nothing fits, or nothing that holds elsewhere."""
        return self._cause(name, source).text

    def chosen(self, name: str, source: str) -> Candidate | None:
        """The first of the candidates that `cause` names; None where it names none."""
        return self._cause(name, source).candidate

    def acting(self, name: str, source: str) -> Candidate | None:
        """The same, or what acts at some states alone; None where nothing of the kind is named."""
        return self.chosen(name, source) or self._at_states.acting.get((name, source))

    def explained(self, name: str, source: str) -> set[str]:
        """The scenarios that `chosen` explains."""
        return {*self._cause(name, source).names, name}

    def left_over(self, name: str, source: str) -> str:
        """What is kept of a system that was loaded before, where it makes all that is wrong."""
        return self._left_over.cause(name, source)

    def plain(self, name: str, source: str) -> str:
        """A cause on one scenario that is quickly found; "" where none fits that holds on all."""
        scene = self.scenes[name]
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            clear = scene.evidence[source].clear
            return self._shared(scene, source, QUICK).text if clear else ""

    def known(self, name: str, source: str) -> str:
        """What is seen of the scenarios on which nothing fits; "" on one that is hardly off."""
        if not self.scenes[name].evidence[source].clear:
            return ""
        kinds = kinds_off(self.scenes[name], source)
        if (source, kinds) not in self._known:
            every = [s for s in self.scenes.values() if source in s.evidence]
            off = [s for s in every if s.evidence[source].clear and not self.cause(s.name, source)]
            right = [s.features for s in every if np.all(s.evidence[source].sound)]
            along = self._formulas.along(source)
            with np.errstate(all="ignore"):
                self._known[source, kinds] = known_over(off, right, source, along, kinds)
        return self._known[source, kinds]

    def of_torque(self, name: str) -> list[str]:
        """What the torque of inverse dynamics leaves out, counts twice or is made of in error."""
        own = ""
        for rule in (limited_inertia, near_inertia):
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                text = self._rule(rule, INVERSE)
                if text and text == self._rule(rule, FORWARD):
                    return [text]
            own = own or (text and f"in inverse dynamics, {text.removeprefix('in the dynamics, ')}")
        return self._inverse.causes(name) or [own] * bool(own)

    def formula_of_torque(self, name: str) -> str:
        """The formula of a wrong torque; "" where none holds on the whole run."""
        scene = self.scenes[name]
        if INVERSE not in scene.evidence or not scene.evidence[INVERSE].clear:
            return ""
        with np.errstate(all="ignore"):
            text = self._by_formula(scene, INVERSE).text
        return f"inverse dynamics are wrong: {text}" * bool(text)

    def _cause(self, name: str, source: str) -> Named:
        if (name, source) not in self._named:
            scene = self.scenes[name]
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                clear = scene.evidence[source].clear
                self._named[name, source] = self._of(scene, source) if clear else Named()
        return self._named[name, source]

    def _of(self, scene: Scene, source: str) -> Named:
        """What is quickly found first, then what other scenarios have, then all that is known."""
        kept = self.left_over(scene.name, source)
        if kept:
            return Named(kept)
        found = self._shared(scene, source, PLAIN)
        whole = self._wrong(source) <= found.names and NOT_ON not in found.text
        if found.text and whole and _is_of_axis(found):  # one factor a body, of which one is a law
            limited = self._rule(axis_mass, source)
            return Named(limited) if limited else found
        if found.text and whole:
            return found
        ruled = self._by_rule(source)
        if ruled.text or found.text:
            return ruled if ruled.text else found
        found = on_some(self._searched.quick(scene, source, PLAIN).partial)
        found = found if found.text else Named(self._at_states.cause(scene, source))
        if found.text:
            return found
        found = self._shared(scene, source, QUICK)
        found = found if found.text else self._mistyped.of(scene, source)
        found = found if found.text else self._by_formula(scene, source)
        for rule in (pivot_inertia, acting_torques):
            found = found if found.text else Named(self._rule(rule, source))
        if found.text:
            return found
        self._search_elsewhere(scene.name, source)
        found = self._carried.strong(scene, source)
        found = found if found.text else Named(self._carried.partly(scene, source))
        return found if found.text else self._searched_to_the_end(scene, source)

    def _shared(self, scene: Scene, source: str, depth: int) -> Named:
        """Of all that holds everywhere, on whichever scenario it was found: what explains the most.

        Between two that fit one scenario those decide that distinguish them.
        """
        return named(self._searched.best(scene, source, depth), source, self._all)

    def _wrong(self, source: str) -> set[str]:
        """The scenarios that have to be explained."""
        every = ((s.name, s.evidence.get(source)) for s in self.scenes.values())
        return {name for name, evidence in every if evidence is not None and evidence.clear}

    def _by_rule(self, source: str) -> Named:
        """One rule of the inertia's numbers that makes all that is wrong."""
        texts = (self._rule(rule, source) for rule in OF_INERTIA)
        return Named(next(filter(None, texts), ""))

    def _rule(self, rule: Rule, source: str) -> str:
        """A rule that makes all that is wrong; "" where this does not."""
        if (rule, source) not in self._rules:
            self._rules[rule, source] = rule(self._all.evidence(source))
        return self._rules[rule, source]

    def _by_formula(self, scene: Scene, source: str) -> Named:
        """A product of known vectors that explains the whole run."""
        found = self._formulas.of(source)
        here = [one for one in found.whole if scene.name in one.names]
        if here:
            return named(here, source, self._all)
        partly = [one for one in found.partly if scene.name in one.names]
        return on_some(partly)

    def _search_elsewhere(self, name: str, source: str) -> None:
        """For a scenario that is not searched to the end: the causes of those that are."""
        searched = self._searched.to_the_end
        if (name, source) not in searched:
            for other, same in searched:
                if same == source and other != name:
                    self._cause(other, source)

    def _searched_to_the_end(self, scene: Scene, source: str) -> Named:
        """What holds everywhere; else what does by other numbers on each scenario, or on some."""
        quick = self._searched.quick(scene, source, QUICK)
        weak, partial = quick.weak, list(quick.partial)
        for found in self._searched.deep(scene, source):
            strong = named(found.strong, source, self._all)
            if strong.text:
                self._carried.keep(found.strong)
                return Named(strong.text, strong.candidate)
            weak = weak or found.weak
            partial += found.partial
        many = weak and weak[0].candidate.numbers is not None and len(weak[0].candidate.numbers) > 1
        own = [one for one in self._formulas.of(source).own if scene.name in one.names]
        weak = own if own and (many or not weak) else weak
        named_weak = self._carried.weak(scene, source, weak)
        if named_weak.text:
            return named_weak
        solved = self._rule(solve_matrix, source)
        if solved:
            return Named(solved)
        where = where_wrong(scene.evidence[source], self._all.evidence(source))
        if where:
            return Named(f"the equation holds at some states, and is wrong only where {where}")
        on_some_kind = self._carried.conditional(source, partial)
        return on_some_kind if on_some_kind.text else on_these_alone(partial, self._wrong(source))


def _is_of_axis(found: Named) -> bool:
    """Whether it is what the parallel-axis theorem adds, scaled, and nothing else fits."""
    family = found.candidate.family if found.candidate is not None else None
    return family is not None and family.name == AXIS and not found.text.startswith(EITHER)
