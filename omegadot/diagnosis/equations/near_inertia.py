"""A rule by which nearly equal moments are taken as equal, or small products for none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.evidence import INVERSE, Evidence
from omegadot.diagnosis.equations.inertia_places import PLACES, Place
from omegadot.diagnosis.equations.wrong_inverse import is_of_torque
from omegadot.diagnosis.models.near_numbers import (
    LAST_RULES,
    NEAR_RULES,
    SMALL_RULES,
    NearRule,
)
from omegadot.diagnosis.wording.digits import limits
from omegadot.reference_impl.system import Array
from omegadot.written import written

EQUAL = 1e-9  # of moments, which rounding and a rule of single numbers leave apart
SEVERAL = 2  # readings between which nothing decides are said as what they share


@dataclass(frozen=True)
class _Fit:
    """A rule at a place with the limits, in between which it is the engine's on every scenario."""

    rule: NearRule
    place: Place
    low: float
    high: float


def near_inertia(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong on all scenarios of one source; "" where nothing does."""
    used = [e for e in every if e.finite]
    wrong = [e for e in used if e.clear]
    if not wrong:
        return ""
    found = list(_fits(used, wrong[0], (*NEAR_RULES, *SMALL_RULES)))
    found = found or list(_fits(used, wrong[0], LAST_RULES))
    if len({fit.place.text for fit in found}) != 1:
        return ""
    return _text(found) if len({fit.rule in SMALL_RULES for fit in found}) == 1 else ""


def _fits(every: Sequence[Evidence], first: Evidence, rules: Sequence[NearRule]) -> Iterator[_Fit]:
    for place in PLACES:
        for rule in rules:
            if not _fitting(first, place, rule, _between(_own(first, place, rule))).any():
                continue
            known = np.unique(np.concatenate([_own(e, place, rule) for e in every]))
            tried = _between(known)
            fits = np.ones(len(tried), dtype=bool)
            for evidence in every:
                fits &= _fitting(evidence, place, rule, tried)
                if not fits.any():
                    break
            if fits.any():
                first_, last = np.flatnonzero(fits)[[0, -1]]
                low, high = _around(known, tried[first_], tried[last])
                # Bodies that are all spheres have no gyroscopic term, and one more number each.
                seen = np.isfinite(high) or rule in SMALL_RULES
                if place.parts == ("spin",):  # this is that it is missing, where these are wrong
                    shown, seen = [e for e in every if e.clear], False
                else:
                    shown = list(every)
                if seen or not all(_is_sphere(e, place, rule, 2.0 * low) for e in shown):
                    yield _Fit(rule, place, low, high)


def _is_sphere(evidence: Evidence, place: Place, rule: NearRule, limit: float) -> bool:
    made = np.linalg.eigvalsh(rule.tensor(place.requested(evidence.system), limit))
    return bool(np.ptp(made) <= EQUAL * np.max(np.abs(made)))


def _own(evidence: Evidence, place: Place, rule: NearRule) -> Array:
    """The ratios of one system, of which none is no limit."""
    found = rule.ratios(place.requested(evidence.system))
    return found[found > 0.0]


def _between(known: Array) -> Array:
    """One limit in each gap between the ratios, and one above them all; none below, which does
    nothing.
    """
    known = np.unique(known)
    if not len(known):
        return known
    return np.append(np.sqrt(known[:-1] * known[1:]), 2.0 * known[-1])


def _around(known: Array, first: float, last: float) -> tuple[float, float]:
    above = known[known > last]
    return float(np.max(known[known < first])), float(np.min(above)) if len(above) else np.inf


def _fitting(evidence: Evidence, place: Place, rule: NearRule, tried: Array) -> Array:
    """(k,): at which of the limits tried the rule is the engine's."""
    system = evidence.system
    requested, right = place.requested(system), form_of(system)
    tensors = [rule.tensor(requested, float(limit)) for limit in tried]
    distinct = list({t.tobytes(): t for t in tensors}.values())
    forms = [place.form(right, system, t) for t in distinct]
    fits = {distinct[k].tobytes() for k in _of(evidence, forms)}
    return np.array([t.tobytes() in fits for t in tensors], dtype=bool)


def _of(evidence: Evidence, forms: Sequence[Form | None]) -> list[int]:
    """The numbers of the forms that are the engine's equation, or its inverse dynamics."""
    if evidence.source != INVERSE:
        return evidence.fitting(forms)
    made = ((k, form) for k, form in enumerate(forms) if form is not None)
    return [k for k, form in made if np.all(is_of_torque(evidence, form))]


def _text(found: Sequence[_Fit]) -> str:
    """The rule, or what several that nothing decides between share."""
    sizes = list(dict.fromkeys(fit.rule.size for fit in found))
    found = [fit for fit in found if fit.rule.size == sizes[0]]
    # whichever it is, its limit is between these
    low, high = min(fit.low for fit in found), max(fit.high for fit in found)
    whats = {fit.rule.what for fit in found}
    what = whats.pop() if len(whats) == 1 else "moments of inertia"
    moving = {fit.place.moving for fit in found} == {True}
    about = " about the pivot" * moving
    dones = {fit.rule.done for fit in found}
    done = dones.pop() if len(dones) == 1 else found[0].rule.done.partition(":")[0]
    small, here = found[0].rule in SMALL_RULES, ""
    if not np.isfinite(high):  # nothing is seen of a limit
        limit = f"{'are' if small else 'differ by'} {written(100.0 * low, 3)} % or less"
    else:
        way = "are below" if small else "differ by less than"
        # of which size it is a part may not be seen: then it is what it comes to in this run
        apart, here = (",", " here,") if len(sizes) > 1 else ("", "")
        limit = f"{way} a limit{apart} between {limits(*_rounded(low, high), '%')}"
    of = f" of {sizes[0]}{here}" * small
    return f"{found[0].place.text}, {what}{about} that {limit}{of} are {done}"


def _rounded(low: float, high: float) -> tuple[float, float]:
    """Outwards, in percent: two digits are enough of what lies far apart."""
    if high < 1.1 * low:
        return 100.0 * low, 100.0 * high
    down, up = (10.0 ** (np.floor(np.log10(x)) - 1) for x in (low, high))
    return 100.0 * float(np.floor(low / down) * down), 100.0 * float(np.ceil(high / up) * up)
