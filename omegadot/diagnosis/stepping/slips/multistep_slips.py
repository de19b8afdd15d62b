"""Which formula of the rates of several steps makes all runs, where it is not as declared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.simple_numbers import summed
from omegadot.diagnosis.stepping.slips.multistep import (
    ALIGNED,
    BY_END,
    IN_EXPONENTIAL,
    MOST_BACK,
    ON_QUATERNION,
    PLACE_BY_END,
    Coefficients,
    Steps,
    formula_of,
    steps_of,
)
from omegadot.reference_impl.coordinates import canonical

# Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), III.1.
KNOWN: Mapping[str, Coefficients] = {
    "Adams-Bashforth 2": (3 / 2, -1 / 2, 0.0, 0.0, 0.0),
    "Adams-Bashforth 3": (23 / 12, -16 / 12, 5 / 12, 0.0, 0.0),
    "Adams-Bashforth 4": (55 / 24, -59 / 24, 37 / 24, -9 / 24, 0.0),
}
FEW, SCENARIOS = 3, 2  # steps of a run that are looked at, and scenarios, at least
NAMES = tuple(f"f_(n-{k})" if k else "f_n" for k in range(MOST_BACK + 1))
OF_ONE: Coefficients = (1.0, 0.0, 0.0, 0.0, 0.0)
EQUAL = 1e-12


def multistep_slips(integrator: Integrator, runs: Sequence[KeptRun]) -> list[str]:
    """The formula by which every step is taken; none where none is found, or it is the due one."""
    chosen = [
        run.short
        for run in runs
        if run.sweep.every == 1
        and len(run.times) > MOST_BACK + FEW
        and canonical(run.system, integrator.coordinates) == "com-world"
    ]
    if len({run.name for run in chosen if run.fails}) < SCENARIOS:
        return []
    with np.errstate(all="ignore"):
        every = [steps_of(run) for run in chosen]
        b = formula_of([one["omega"] for one in every])
        turned = _attitude(every, b) if b is not None else None
        if b is None or turned is None or not (any(b[1:]) or any(turned[1:])):
            return []  # with no rate of before it is a scheme of one step
        if not all(_places(one, b, turned) for one in every):
            return []
    text = _text(b, turned, integrator.orders.get("omega"))
    declared = f", though {integrator.scheme} is declared" if integrator.scheme else ""
    return [text + declared] if text else []


def _attitude(every: Sequence[Mapping[str, Steps]], b: Coefficients) -> Coefficients | None:
    """The formula of the attitude, that of omega first; that of the new omega is empty."""
    ways = (ON_QUATERNION, ALIGNED, IN_EXPONENTIAL)
    if any(all(one[way].made(b) for one in every) for way in ways):
        return b
    if all(one[BY_END].made(OF_ONE) for one in every):
        return ()
    found = (formula_of([one[way] for one in every]) for way in ways)
    return next((one for one in found if one is not None), None)


def _places(one: Mapping[str, Steps], b: Coefficients, turned: Coefficients) -> bool:
    """Whether a free body's velocity moves as omega does, and its position as the attitude."""
    if "velocity" not in one:
        return True
    moved = one["position"].made(turned) if turned else one[PLACE_BY_END].made(OF_ONE)
    return moved and one["velocity"].made(b)


def _text(b: Coefficients, turned: Coefficients, due: int | None) -> str:
    """Of a formula that is known, or of two, only where their order is lower than is due."""
    name = next((name for name, one in KNOWN.items() if _equal(one, b)), "")
    if turned != b:
        how = f"h ({summed(turned, NAMES)})" if turned else "h times its new velocities"
        text = f"omega moves in each step by h ({summed(b, NAMES)}), the attitude by {how}"
        order = min(order_of(b), order_of(turned) if turned else 1)
    else:
        text, order = f"each step is h ({summed(b, NAMES)})", order_of(b)
        near = next((one for one, due_here in KNOWN.items() if _near(due_here, b)), "")
        if not name and near:
            return f"{text}, where {near} has h ({summed(KNOWN[near], NAMES)})"
        text += f", which is {name}" if name else ""
    if name or turned != b:
        return f"{text}: of order {order}, not {due}" if due is not None and order < due else ""
    return f"{text}: of order {order}"


def order_of(b: Coefficients) -> int:
    """The p up to which ``sum b_k (-k)^(j-1) = 1/j``, j = 1 .. p."""
    for j in range(1, MOST_BACK + 2):
        moment = sum(value * float((-k) ** (j - 1)) for k, value in enumerate(b))
        if abs(moment - 1 / j) > EQUAL * sum(map(abs, b)) * MOST_BACK**j:
            return j - 1
    return MOST_BACK + 1


def _equal(one: Coefficients, other: Coefficients) -> bool:
    return all(abs(p - q) <= EQUAL for p, q in zip(one, other, strict=True))


def _near(one: Coefficients, other: Coefficients) -> bool:
    """The same numbers in other places, or other numbers in the same, of which one is as it is."""
    if _equal(tuple(sorted(one)), tuple(sorted(other))):
        return True
    same = [bool(p) == bool(q) for p, q in zip(one, other, strict=True)]
    equal = [p and abs(p - q) <= EQUAL for p, q in zip(one, other, strict=True)]
    return all(same) and any(equal)
