"""Whether a system fails by its own motion; and, where it does not, a state at which it does."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import evaluation_states_of, forward_rows
from omegadot.gates.steps import vanishing_step
from omegadot.gates.steps.probe import Probe
from omegadot.harness.outcome import EngineCase, JudgedCase
from omegadot.reference_impl.system import Acceleration, State
from omegadot.reports.text.numbers import times_its_bound
from omegadot.written import written

ON_PATH = "residual_on_path"
OF_MOTION = ("invariants", "trajectory")
DIGITS = 6
Shown = Mapping[str, Sequence[float]]


def is_of_motion(failed: Iterable[Row]) -> bool:
    """Whether what fails lies on the motion that starts from the system's own state.

    failed: the rows that fail, of the engine or of one run.
    """
    return any(row.metric == ON_PATH or row.gate in OF_MOTION for row in failed)


def failing_state(
    judged: JudgedCase, found: EngineCase, gate: str, integrator: str | None, seed: int
) -> Shown:
    """The state at which the equation, or a single step, is furthest off, as keys of `initial`.

    seed: of the evaluation states.  Empty where a gate looks at no states, or none fails.
    """
    system, result = judged.case.system, found.result
    eps = eps_of(result.precision)
    rows: list[list[Row]] = []
    if judged.truth is None:
        return {}
    states = evaluation_states_of(judged.case, judged.truth, seed).random
    if gate == "equation" and result.forward.ok:
        answer = Acceleration(**result.forward.result)
        places = (slice(k, k + 1) for k in range(len(states.orientation)))
        rows = [forward_rows(system, states[k], answer[k], "residual", eps) for k in places]
    elif gate == "scheme" and integrator in result.first_steps:
        probe, steps = result.first_steps[integrator]
        states = probe.states
        for k in range(len(states.orientation)) if steps.ok else ():
            one, stepped = slice(k, k + 1), State(**steps.result)
            own = Probe(states[one], probe.timesteps[one])
            rows.append(vanishing_step.rows(system, own, stepped[one], eps))
    shares = [max(map(_excess, own), default=0.0) for own in rows]
    if not shares or max(shares) <= 1.0:
        return {}
    worst = states[int(np.argmax(shares))]
    values = vars(worst)
    if system.load.pivot is not None:  # its place follows from its attitude
        values = {k: v for k, v in values.items() if k in ("orientation", "angular_velocity")}
    return {name: [float(x) for x in np.ravel(value)] for name, value in values.items()}


def _excess(row: Row) -> float:
    return times_its_bound(row.value, row.bound) if row.verdict == "fail" else 0.0


def state_text(state: Shown) -> str:
    """A state as one would type it: ``angular_velocity = [0.3, 0, 0]; ...``."""
    texts = (
        f"{name} = [{', '.join(written(x, DIGITS) for x in values)}]"
        for name, values in state.items()
    )
    return "; ".join(texts)
