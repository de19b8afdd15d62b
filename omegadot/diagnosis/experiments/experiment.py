"""The experiments on one fault: where it fails and where it does not, one thing is changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.experiments.judges import Judge
from omegadot.diagnosis.experiments.lines import states_between, system_between
from omegadot.diagnosis.experiments.observed import Observations, Trial
from omegadot.diagnosis.experiments.sorting import (
    Limit,
    kind_that_sorts,
    limits_that_sort,
    pair_that_sorts,
)
from omegadot.harness.requests.variations import other_bodies, other_loads, other_states
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.system import State

ON_A_LINE, ROUNDS, HALVINGS, LINES = 9, 4, 9, 3
MOST_HALVINGS = 20  # to a limit that is far below the larger of two sizes


class Experiment:
    """Of one fault. drawn: what is known of it without any further request."""

    def __init__(self, judge: Judge, drawn: Sequence[Trial]) -> None:
        self._judge = judge
        self.trials = [one for one in drawn if np.any(one.known)]

    def condition(self) -> str:
        """The condition on which the fault shows; "" where none, or more than one, sorts all."""
        bases = [*self._bases()]
        if not bases:
            return ""
        for one in bases:
            self._with_other_states(one)
            for _, system in other_loads(one.system):
                self._add(self._judge.trial(system, one.states, one))
        found = kind_that_sorts(self.seen)
        # of an inertia one other tensor tells little: its moments may be what decides
        return found if found and "inertia" not in found else self._by_bodies(bases)

    def _by_bodies(self, bases: Sequence[Trial]) -> str:
        for one in bases[:1] if self._parted else bases:
            base = self._about_its_centre(one)
            for _, system in other_bodies(base.system):
                self._add(self._judge.trial(system, base.states, base))
        found = kind_that_sorts(self.seen)
        return found or self._by_limits() or pair_that_sorts(self.seen)

    def _about_its_centre(self, one: Trial) -> Trial:
        """The same held at the centre of mass, about which its inertia is then the one requested.

        As it is where it is free, or where the fault goes with the lever.
        """
        load, body = one.system.load, one.system.body
        if load.pivot is None or not np.any(lever(one.system)):
            return one
        system = replace(one.system, load=replace(load, pivot=np.asarray(body.center_of_mass)))
        held = self._judge.trial(system, one.states, one)
        same = held is not None and np.array_equal(held.wrong, one.wrong) and self._add(held)
        return held if same and held is not None else one

    @property
    def seen(self) -> Observations:
        """Drawn and requested."""
        return Observations(self.trials)

    @property
    def _parted(self) -> bool:
        wrong = self.seen.wrong
        return bool(np.any(wrong) and not np.all(wrong))

    def _add(self, one: Trial | None) -> bool:
        if one is None or not np.any(one.known):
            return False
        self.trials.append(one)
        return True

    def _bases(self) -> Iterator[Trial]:
        """A trial that fails and one that passes, the one with most states that show it; or mixed.

        Of each a few states.
        """
        for wanted in (True, False):
            ranked = [(self._share(one, wanted), k) for k, one in enumerate(self.trials)]
            share, k = max(ranked, default=(0.0, 0), key=lambda pair: (pair[0], -pair[1]))
            if share > 0.0:
                one = self.trials[k]
                where = np.flatnonzero(one.known & (one.wrong == wanted))
                few = where[
                    np.linspace(0, len(where) - 1, min(len(where), self._judge.at_once)).astype(int)
                ]
                yield Trial(one.system, one.states[few], one.wrong[few], one.known[few])

    @staticmethod
    def _share(one: Trial, wrong: bool) -> float:
        return float(np.count_nonzero(one.known & (one.wrong == wrong)) / len(one.wrong))

    def _with_other_states(self, base: Trial) -> None:
        """All of them in one request."""
        count = len(base.wrong)
        others = [states for _, states in other_states(base.states)]
        whole = self._judge.trial(base.system, _joined(others))
        if whole is None:
            return
        for k in range(len(others)):
            own = slice(k * count, (k + 1) * count)
            self._add(
                Trial(base.system, whole.states[own], whole.wrong[own], whole.known[own], base)
            )

    def _by_limits(self) -> str:
        """A size with a limit: looked for between states, and between systems, that differ."""
        if not limits_that_sort(self.seen):
            return ""
        for one in self._mixed():
            self._along_states(one)
        for wrong, right in self._neighbours():
            if not limits_that_sort(self.seen):
                break
            # Also where one limit is left, and narrow: on a single line many sizes go together,
            # and another line contradicts all but the one that decides.
            self._along_systems(wrong, right)
        left = _distinct(limits_that_sort(self.seen))
        return str(left[0]) if len(left) == 1 and left[0].narrow else ""

    def _mixed(self) -> list[tuple[Trial, State, State]]:
        """Systems with a state that shows the fault and one that does not: few, and spread."""
        found = list[tuple[Trial, State, State]]()
        by_system: dict[int, list[Trial]] = {}
        for one in self.trials:
            by_system.setdefault(id(one.system), []).append(one)
        for several in by_system.values():
            wrong = [(o, k) for o in several for k in np.flatnonzero(o.known & o.wrong)]
            right = [(o, k) for o in several for k in np.flatnonzero(o.known & ~o.wrong)]
            if wrong and right:
                (a, i), (b, j) = wrong[len(wrong) // 2], right[len(right) // 2]
                found.append((a, a.states[i], b.states[j]))
        places = np.unique(np.linspace(0, len(found) - 1, min(len(found), LINES)).astype(int))
        return [found[k] for k in places] if found else []

    def _along_states(self, line: tuple[Trial, State, State]) -> None:
        """From a state that shows the fault to one that does not, by ever smaller parts."""
        one, wrong, right = line
        low, high = 0.0, 1.0
        for _ in range(ROUNDS):
            parts = low + (high - low) * np.arange(1, ON_A_LINE + 1) / (ON_A_LINE + 1)
            tried = self._judge.trial(one.system, states_between(one.system, wrong, right, parts))
            if not self._add(tried):
                return
            assert tried is not None
            shows = [k for k in range(ON_A_LINE) if tried.known[k] and tried.wrong[k]]
            last = parts[shows[0]] if shows else low
            for k in shows:  # up to the first that does not
                if np.any(tried.known[:k] & ~tried.wrong[:k]):
                    break
                last = parts[k]
            after = [
                p
                for p, k, w in zip(parts, tried.known, tried.wrong, strict=True)
                if p > last and k and not w
            ]
            low, high = float(last), float(after[0]) if after else high

    def _neighbours(self) -> list[tuple[Trial, Trial]]:
        """Systems that show the fault and that do not, of one support: first by one change."""
        pairs = [(one, one.base) for one in self.trials if one.base is not None]
        pairs = [
            (a, b) if a.fails else (b, a)
            for a, b in pairs
            if (a.fails and b.passes) or (a.passes and b.fails)
        ]
        pairs = [(a, b) for a, b in pairs if a.system is not b.system]
        wrong, right = (
            [o for o in self.trials if o.base is None and getattr(o, k)]
            for k in ("fails", "passes")
        )
        pairs += [(a, b) for a in wrong for b in right]
        same = [
            p for p in pairs if (p[0].system.load.pivot is None) is (p[1].system.load.pivot is None)
        ]
        places = np.unique(np.linspace(0, len(same) - 1, min(len(same), LINES)).astype(int))
        return [same[k] for k in places] if same else []

    def _along_systems(self, wrong: Trial, right: Trial) -> None:
        """The same by halves: each system is a request."""
        low, high = 0.0, 1.0
        states = wrong.states[:: max(1, len(wrong.wrong) // self._judge.at_once)][
            : self._judge.at_once
        ]
        for halved in range(MOST_HALVINGS):
            if halved >= HALVINGS and all(one.narrow for one in limits_that_sort(self.seen)):
                return
            part = 0.5 * (low + high)
            tried = self._judge.trial(system_between(wrong.system, right.system, part), states)
            if not self._add(tried):
                return
            assert tried is not None
            low, high = (part, high) if tried.fails else (low, part)


def _joined(several: Sequence[State]) -> State:
    fields = zip(*(vars(one).values() for one in several), strict=True)
    return State(*map(np.concatenate, fields))


def _distinct(found: Sequence[Limit]) -> list[Limit]:
    """Without those of the same numbers under another name."""
    return list({(one.low, one.high): one for one in found[::-1]}.values())[::-1]
