"""When finer steps are requested, and what of a run that overflows is judged.

What these tests catch: runs at ever finer steps whose errors drown in rounding all the more; a
sweep that is judged although its next step would show a fault.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.findings import Declared, MeasuredSweep, findings_of
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.errors.verdicts import BLOWN_UP_UNSEEN
from omegadot.harness.judging.runs import _finer_steps_decide, _left_open, _undetermined
from omegadot.reference_impl.system import Array, Body, Load, System

BOUND = 1e-12
ORDERS: dict[str, int | None] = dict.fromkeys(CHANNELS, 4)


def measured(step: float, error: float, single: bool = False) -> MeasuredRun:
    size: dict[str, Array] = {channel: error * np.linspace(0.0, 1.0, 65) for channel in CHANNELS}
    bound: dict[str, Array] = {channel: np.full(65, BOUND) for channel in CHANNELS}
    return MeasuredRun(Sweep(step, 64, 1), size, bound, single=single)


@pytest.mark.parametrize(
    ("errors", "decides"),
    [
        ((3e-12, 2e-12, 1.5e-12), False),  # close to rounding, and closer at finer steps
        ((1e-6, 5e-9, 5e-12), False),  # clear at two steps, and hidden at the finest
        ((1e-6, 2e-8, 1e-10), True),  # a slope that has not settled
        ((1e-6, 0.9e-6, 0.8e-6), True),  # nothing hides that there is no order
        ((1.6e-7, 1e-8, 6.3e-10), False),  # the order is there
    ],
)
def test_finer_steps_are_taken_where_rounding_leaves_something(
    errors: tuple[float, ...], decides: bool
) -> None:
    runs = [measured(h, e) for h, e in zip((0.04, 0.02, 0.01), errors, strict=True)]
    findings = findings_of(runs[0], Declared(None, ORDERS), MeasuredSweep(tuple(runs)))
    assert _finer_steps_decide(findings, runs) is decides


def test_single_precision_and_known_schemes_are_refined_as_long_as_anything_is_open() -> None:
    runs = [measured(h, 2e-12) for h in (0.04, 0.02, 0.01)]
    findings = findings_of(runs[0], Declared(None, ORDERS), MeasuredSweep(tuple(runs)))
    assert not _finer_steps_decide(findings, runs)
    assert _finer_steps_decide(findings, [replace(run, single=True) for run in runs])
    assert _finer_steps_decide(findings, [replace(r, against_scheme=r.error) for r in runs])


@pytest.mark.parametrize(
    ("least", "eps", "kind"),
    [(1e-6, 2.0**-23, "beyond"), (1e-3, 2.0**-23, "unsettled"), (1e-6, EPS, "unsettled")],
)
def test_no_digit_of_the_inverse_leaves_an_overflow_unjudged(
    least: float, eps: float, kind: str
) -> None:
    body = Body(np.array(1.0), np.zeros(3), np.diag([least, 1.0, 1.0]))
    system = System((body,), Load())
    truth: Any = SimpleNamespace(yardstick=SimpleNamespace(system=system, eps=eps))
    assert _undetermined(truth, {"omega": BLOWN_UP_UNSEEN})["omega"].kind == kind


def test_what_refused_steps_would_decide_is_left_open() -> None:
    """Errors that do not shrink at three steps fail; not where the engine refuses the fourth."""
    runs = [measured(h, e) for h, e in zip((0.04, 0.02, 0.01), (1e-6, 0.9e-6, 0.8e-6), strict=True)]
    findings = findings_of(runs[0], Declared(None, ORDERS), MeasuredSweep(tuple(runs)))
    assert {one.kind for one in findings.values()} >= {"unsettled"}
    left = _left_open(findings)
    assert "unsettled" not in {one.kind for one in left.values()}
    assert all(one.note.endswith("finer steps are refused") for one in left.values() if one.open)
    sound = {channel: replace(one, kind="consistent") for channel, one in findings.items()}
    assert _left_open(sound) == sound
