"""Moments of inertia that are limited: by a constant, by the mass, by the other moments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import INVERSE, SLACK, Evidence
from omegadot.diagnosis.equations.inertia_places import PLACES, Place
from omegadot.diagnosis.equations.wrong_inverse import is_of_torque
from omegadot.diagnosis.wording.digits import number
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System

LEAST = 2  # scenarios on which it acts: one shows no law
DIAGONAL, MOMENTS = "the diagonal of the inertia", "every principal moment of inertia"


@dataclass(frozen=True)
class _Limit:
    """what: the numbers.  above: whether they are held above the limit, or below it."""

    what: str
    above: bool

    def numbers(self, tensor: Array) -> tuple[Array, Array]:
        """(3,), and the tensors (3, 3, 3) that each stands before."""
        if self.what == DIAGONAL:
            return np.diag(tensor), np.einsum("ki,kj->kij", np.eye(3), np.eye(3))
        moments, axes = np.linalg.eigh(tensor)
        return moments, np.einsum("ik,jk->kij", axes, axes)

    def held(self, numbers: Array, limit: float) -> Array:
        """The numbers with the limit."""
        return np.maximum(numbers, limit) if self.above else np.minimum(numbers, limit)

    def tensor(self, tensor: Array, limit: float) -> Array:
        """The tensor with them."""
        numbers, bases = self.numbers(tensor)
        return np.asarray(tensor + np.tensordot(self.held(numbers, limit) - numbers, bases, 1))


@dataclass(frozen=True)
class _Scale:
    """What a limit goes with: its size on a system whose tensor is given; text: of its factor."""

    text: str
    size: Callable[[System, Array], float]


def _extreme(above: bool) -> tuple[_Scale, ...]:
    """The largest of the numbers for a least one, and the other way about."""
    which, of = ("largest", np.max) if above else ("smallest", np.min)
    return (
        _Scale(
            f"{{}} times the {which} number on its diagonal", lambda s, t: float(of(np.diag(t)))
        ),
        _Scale(
            f"{{}} times the {which} principal moment",
            lambda s, t: float(of(np.linalg.eigvalsh(t))),
        ),
    )


def _scales(above: bool) -> tuple[_Scale, ...]:
    return (
        _Scale("{} kg m^2", lambda s, t: 1.0),
        _Scale("{} m^2 times the mass", lambda s, t: float(s.body.mass)),
        *_extreme(above),
        _Scale("{} times the trace", lambda s, t: float(np.trace(t))),
    )


LIMITS = tuple(_Limit(what, above) for above in (True, False) for what in (DIAGONAL, MOMENTS))


def limited_inertia(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong on all scenarios of one source; "" where nothing does."""
    used = [e for e in every if e.finite]
    wrong = [e for e in used if e.clear]
    if len(wrong) < LEAST:
        return ""
    texts, known = list[str](), set[tuple[_Limit, tuple[str, ...]]]()
    for place in PLACES:
        for limit in LIMITS:
            if (limit, place.parts) in known:  # of the body's own as well: no pivot decides
                continue
            laws = [*_laws(used, wrong, place, limit)]
            texts += laws
            if laws:
                known.add((limit, place.parts))
    found = either(texts)
    return found[0] if len(texts) <= MOST_NAMED and found else ""


def _laws(
    used: Sequence[Evidence], wrong: Sequence[Evidence], place: Place, limit: _Limit
) -> Iterator[str]:
    """The limits that make all scenarios, as text."""
    found = list[tuple[float, float]]()
    for evidence in wrong:
        here = [*_limits_of(evidence, place, limit)]
        if not here:
            return
        found.append(max(here, key=lambda one: one[1]))
    values, known_to = np.transpose(found)
    shown = np.isfinite(known_to)
    if np.count_nonzero(shown) < LEAST:
        return
    values, known_to = values[shown], known_to[shown]
    show = [e for e, k in zip(wrong, shown, strict=True) if k]
    for scale in _scales(limit.above):
        sizes = np.array([scale.size(e.system, place.requested(e.system)) for e in show])
        factors, weights = values / sizes, (sizes / known_to) ** 2
        factor = float(np.sum(weights * factors) / np.sum(weights))
        if not np.isfinite(factor):
            continue
        law = (
            (e, factor * scale.size(e.system, place.requested(e.system)))
            for e in (*wrong, *(e for e in used if not e.clear))
        )
        if all(_makes(e, place, limit, value) for e, value in law):
            way = "held above" if limit.above else "limited to"
            about = " about the pivot" * place.moving
            size = scale.text.format(number(factor))
            yield f"{place.text}, {limit.what}{about} is {way} {size}"


def _limits_of(evidence: Evidence, place: Place, limit: _Limit) -> Iterator[tuple[float, float]]:
    """What the numbers of one scenario are limited to, and how well that is known, kg m^2; where
    nothing shows it, no number that is known to infinity.

    ``J = T + l P``, T without the numbers that are limited and P what these stand before, is put in
    the balance of torques, which is linear in l.
    """
    numbers, bases = limit.numbers(place.requested(evidence.system))
    order = np.argsort(numbers if limit.above else -numbers)
    for count in range(1, 4):
        chosen = order[:count]
        before, gone = (
            np.sum(bases[chosen], axis=0),
            np.tensordot(numbers[chosen], bases[chosen], 1),
        )
        line, due = balance(evidence, place.parts, before, gone)
        size = float(line @ line)
        if not (np.isfinite(size) and np.all(np.isfinite(due))):
            continue
        if np.sqrt(size) * numbers[chosen[-1]] <= SLACK * np.sqrt(len(line)):
            sphere = 2.0 * np.max(numbers) if limit.above else 0.5 * np.min(numbers)
            if count == len(numbers) and _makes(evidence, place, limit, float(sphere)):
                yield np.nan, np.inf  # without a torque a sphere's moment shows nothing
            continue
        value = float(line @ due) / size
        changed = limit.held(numbers, value) != numbers
        if np.array_equal(np.flatnonzero(changed), np.sort(chosen)) and _makes(
            evidence, place, limit, value
        ):
            yield value, 1.0 / float(np.sqrt(size))


def balance(
    evidence: Evidence, parts: tuple[str, ...], before: Array, gone: Array
) -> tuple[Array, Array]:
    """(3 n,) each, in bounds: ``l line = due`` of ``J = M - gone + l before``.

    Of forward dynamics ``J a + omega x J omega = torque``; of inverse dynamics that is the torque
    which is answered, as far as it is off.
    """
    system, w = evidence.system, evidence.states.angular_velocity
    inverse = evidence.source == INVERSE
    rate = (evidence.true if inverse else evidence.found).angular
    whole = np.asarray(moving_inertia(system), dtype=float)

    def made(tensor: Array) -> Array:
        solve = apply(tensor, rate) if "solve" in parts else np.zeros_like(rate)
        return solve + cross(w, apply(tensor, w)) if "spin" in parts else solve

    if inverse:
        due = apply(whole, evidence.found.angular - evidence.true.angular)
    else:
        due = torque(system, evidence.states) - apply(whole, rate) - cross(w, apply(whole, w))
    bound = evidence.angular_bound
    weight = np.where(np.isfinite(bound) & (bound > 0.0), 1.0 / bound, 0.0)[:, None]
    smallest = float(np.linalg.eigvalsh(whole)[0])
    return np.ravel(weight * made(before)) / smallest, np.ravel(
        weight * (due + made(gone))
    ) / smallest


def _makes(evidence: Evidence, place: Place, limit: _Limit, value: float) -> bool:
    """Whether the inertia with this limit makes what the engine answers."""
    system = evidence.system
    tensor = limit.tensor(place.requested(system), value)
    form = place.form(form_of(system), system, tensor)
    if form is None:
        return False
    if evidence.source == INVERSE:
        return bool(np.all(is_of_torque(evidence, form)))
    return evidence.is_of(form)
