"""What is mistyped, from all scenarios of one source of evidence at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import SCREENED, Evidence
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.mistyped import cross_products, momenta, rotations
from omegadot.diagnosis.equations.mistyped.few import Few, factors_of, few_of
from omegadot.diagnosis.equations.mistyped.kinds import ANGULAR, LINEAR, Kind
from omegadot.diagnosis.equations.readings import Reading
from omegadot.diagnosis.equations.search import STEPS
from omegadot.diagnosis.equations.worded import Named, named, on_some
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Array

KINDS = (*rotations.kinds(), *cross_products.kinds(), *momenta.kinds())


class Mistyped:
    """The formulas with a slip in them that are an engine's, over its scenarios so far."""

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes
        self._found: dict[str, list[Reading]] = {}

    def of(self, scene: Scene, source: str) -> Named:
        """What explains one scenario and holds on all, or on those of one kind."""
        if source not in self._found:
            every = [e for e in self._scenes.evidence(source) if e.finite and e.clear]
            self._found[source] = list(_first(every)) if every else []
        tried = (self._held(one, scene, source) for one in self._found[source])
        held = [one for one in tried if one is not None]
        whole = [one for one in held if one.holds and one.strong]
        found = named(whole, source, self._scenes)
        return found if found.text else on_some([one for one in held if not one.contradicted])

    def _held(self, one: Reading, scene: Scene, source: str) -> Held | None:
        candidate, evidence = Candidate(reading=one), scene.evidence[source]
        if not evidence.fits(one.accelerations(evidence)):
            return None
        return self._scenes.held(candidate, scene, source)


def _first(every: Sequence[Evidence]) -> Iterator[Reading]:
    """Those that explain all scenarios that are wrong, at a few states of each."""
    few = [e.few(SCREENED) for e in every]
    of = [ANGULAR] if any(_off(e, ANGULAR) for e in few) else [LINEAR]
    if of == [LINEAR] and few[0].source == STEPS:
        return  # where places are steps of a pivoted body, they follow its attitude
    rest = {what: [_rest(e, what) for e in few] for what in of}
    for kind in (kind for kind in KINDS if kind.of in of):
        lines = [kind.lines(e) * _weight(e, kind) for e in few]
        off = [one * _weight(e, kind) for one, e in zip(rest[kind.of], few, strict=True)]
        for terms in _terms(kind, _row(lines), _row(off)):
            known = (one for one in kind.readings(terms) if _fits(one, few))
            yield from list(known)[:1]


def _terms(kind: Kind, lines: Array, rest: Array) -> list[Few]:
    if not (np.isfinite(lines).all() and np.isfinite(rest).all()):
        return []
    return factors_of(lines, rest) if kind.any_factors else few_of(lines, rest)


def _fits(one: Reading, few: Sequence[Evidence]) -> bool:
    return all(e.fits(one.accelerations(e)) for e in few)


def _off(e: Evidence, what: str) -> bool:
    apart = norm(getattr(e.found, what) - getattr(e.true, what))
    return bool(np.any(apart > (e.angular_bound if what == ANGULAR else e.linear_bound)))


def _rest(e: Evidence, what: str) -> Array:
    """What is off of omega-dot, or of the linear acceleration, (n, 3) in body axes."""
    rest = getattr(e.found, what) - getattr(e.true, what)
    return rest if what == ANGULAR else rotate_inverse(e.states.orientation, rest)


def _weight(e: Evidence, kind: Kind) -> Array:
    """One over the bound, (n, 3); zero of a component that is not looked at."""
    bound = e.angular_bound if kind.of == ANGULAR else e.linear_bound
    usable = np.isfinite(bound) & (bound > 0.0)
    weight = np.where(usable, 1.0 / np.where(usable, bound, 1.0), 0.0)[:, None]
    return np.asarray(weight * (np.arange(3) != (-1 if kind.without is None else kind.without)))


def _row(parts: Sequence[Array]) -> Array:
    """All states of all scenarios in one axis, after that of the terms where there is one."""
    return np.concatenate([one.reshape(*one.shape[:-2], -1) for one in parts], axis=-1)
