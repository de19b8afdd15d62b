"""A cause that acts in some batches of states alone, or at some of their places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import (
    ALONG,
    BEYOND_ROUNDING,
    FORWARD,
    INVERSE,
    Evidence,
)
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.wrong_equation import equation_causes
from omegadot.diagnosis.experiments.batch_patterns import ALONE
from omegadot.diagnosis.experiments.batches import Batches, together
from omegadot.diagnosis.experiments.conditioned import conditioned
from omegadot.diagnosis.experiments.observed import Flags
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.reported.requests import ONE_ALONE, is_of_place
from omegadot.diagnosis.wording.kinds import is_named, kind_of
from omegadot.gates.case import Case
from omegadot.reference_impl.system import Acceleration, State

OF_BATCHES = "requested together"  # in a cause that is of these already
LEAST = 12  # states of each scenario on which a cause in some batches is looked for
MOST = 6  # causes of which batches are tried


@dataclass(frozen=True)
class _Found:
    """condition: in which batches; "" for none.

    size: of the least that shows it, at these places; 0 for none.
    """

    condition: str = ""
    size: int = 0
    places: tuple[int, ...] = ()


@dataclass
class InBatches:
    """Of one engine. cases and scenes: by name."""

    cases: Mapping[str, Case]
    scenes: Mapping[str, Scene]
    _found: dict[str, _Found] = field(default_factory=dict, init=False)
    _small: dict[tuple[int, bool], Across] = field(default_factory=dict, init=False)

    def wants(self, text: str, torque: bool) -> bool:
        """Whether requests have to be made about a cause. torque: of inverse dynamics alone."""
        if OF_BATCHES in kind_of(text) and not _of_some(text):
            return False
        if kind_of(text) not in self._found:
            return len(self._found) < MOST
        size = self._found[kind_of(text)].size
        return bool(size and (size, torque) not in self._small and not _names(text))

    def ask(self, requests: Requests, name: str, text: str, torque: bool) -> None:
        """Have states of one scenario answered in other batches, and of all where it takes that."""
        kind = kind_of(text)
        if kind not in self._found:
            self._found[kind] = self._of_one(requests, name, text, torque)
        found = self._found[kind]
        if found.size and not _names(text):
            source = INVERSE if torque else FORWARD
            self._small[found.size, torque] = self._of_all(requests, found, source)

    def of(self, name: str, text: str, torque: bool) -> tuple[str, bool]:
        """The cause with the batches in which it acts, and whether these decide."""
        found = self._found.get(kind_of(text), _Found())
        if not found.condition or (_names(text) and not _of_some(text)):
            return conditioned(text, found.condition), bool(found.condition)
        across = self._small.get((found.size, torque))
        if across is not None and name in across.scenes:
            causes = equation_causes(across, name, FORWARD) if not torque else []
            cause = "; ".join(across.of_torque(name) if torque else causes)
            if is_named(cause):
                return conditioned(cause, found.condition), True
        if not _of_some(text):
            return conditioned(text, found.condition), True
        if found.condition == ALONE or is_of_place(text):
            return text, True
        what = "inverse dynamics are" if torque else "the equation is"
        return f"{what} wrong only where {found.condition}", True

    def _of_one(self, requests: Requests, name: str, text: str, torque: bool) -> _Found:
        """By requests of states that show a fault."""
        for source in (INVERSE,) if torque else (FORWARD, ALONG):
            evidence = self.scenes[name].evidence.get(source)
            if evidence is None or not evidence.finite:
                continue
            shows = np.flatnonzero(evidence.shares(evidence.true) > BEYOND_ROUNDING)
            if text == ONE_ALONE:  # it is of the first of them
                shows = np.zeros(1, dtype=np.intp)
            if len(shows):
                batches = Batches(requests, self.cases[name], evidence, shows)
                condition = batches.condition()
                return _Found(condition, *_shown_by(batches.seen)) if condition else _Found()
        return _Found()

    def _of_all(self, requests: Requests, found: _Found, source: str) -> Across:
        """The equations of all scenarios as they are answered in batches that show the fault.

        Of each batch the places that show it alone: there stands every state in its turn.
        """
        across, size, shown = Across(), found.size, np.array(found.places, dtype=np.intp)
        count = -(-LEAST // len(shown))
        for name, scene in self.scenes.items():
            evidence = scene.evidence.get(source)
            if evidence is None or name not in self.cases or not evidence.finite:
                continue
            first = len(shown) * np.arange(count, dtype=np.intp)[:, None]
            every = (first + np.arange(size, dtype=np.intp)) % len(evidence.sound)
            parts = [together(requests, self.cases[name], evidence, own) for own in every]
            known = [one.at(shown) for one in parts if one is not None]
            if len(known) == count:
                own = {source: _joined(known)}
                across.add(Scene(scene.name, scene.system, scene.features, own))
        return across


def _shown_by(seen: Mapping[int, Flags]) -> tuple[int, tuple[int, ...]]:
    """The largest batch whose states are all wrong, else the least with a wrong one; its places."""
    whole = [n for n, flags in seen.items() if np.all(flags)]
    some = [n for n, flags in seen.items() if np.any(flags)]
    size = max(whole) if whole else min(some, default=0)
    return size, tuple(np.flatnonzero(seen[size]).tolist()) if size else ()


def _of_some(text: str) -> bool:
    """Whether it is said of some batches, or places in them, that they are wrong, and no more."""
    return text == ONE_ALONE or is_of_place(text)


def _names(text: str) -> bool:
    return is_named(text) and not _of_some(text)


def _joined(parts: list[Evidence]) -> Evidence:
    first = parts[0]
    states = State(
        *map(np.concatenate, zip(*(vars(e.states).values() for e in parts), strict=True))
    )
    found, true = (_accelerations([getattr(e, k) for e in parts]) for k in ("found", "true"))
    angular = np.concatenate([e.angular_bound for e in parts])
    linear = np.concatenate([e.linear_bound for e in parts])
    made = Evidence(first.source, first.system, states, found, angular, linear, first.eps)
    vars(made)["true"] = true
    return made


def _accelerations(parts: list[Acceleration]) -> Acceleration:
    return Acceleration(
        np.concatenate([one.angular for one in parts]),
        np.concatenate([one.linear for one in parts]),
    )
