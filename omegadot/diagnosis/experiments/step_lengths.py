"""A length of step, or a turn in one, at which what a step does is another: looked for by parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.steps.accuracy import finest_of
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.system import Array, State

TURNS = (2.0**-14, 1.0)  # rad, of the shortest and the longest step
LENGTHS, ROUNDS, PARTS = 40, 4, 8
JUMP = 3.0  # times: no smooth error changes by as much within the last of the parts
APART = 3.0  # times: by which two rates distinguish a turn from a length


@dataclass(frozen=True)
class Jump:
    """Between two lengths of steps, s; above: longer ones are worse.

    turn: rad, between which the turn of such a step lies, by omega at its start or its end.
    """

    low: float
    high: float
    turn: tuple[float, float]
    above: bool


def limit_of_length(
    driver: Requests, case: Case, integrator: Integrator, states: State, eps: float
) -> str:
    """``a step turns the body by less than a limit between A and B rad``; "" where none is seen.

    From two of the states (n,), of unlike rates, a step is taken by lengths that follow each other
    closely. Its error goes smoothly with its length in any scheme; where it jumps, and jumps by as
    much however near the lengths are, another formula is taken there.
    """
    rates = norm(states.angular_velocity)
    order = np.argsort(rates)
    order = order[rates[order] > 0.0]
    if len(order) < 2 or rates[order[-1]] < APART * rates[order[0]]:
        return ""
    found = [_jump(driver, case, integrator, states[k], eps) for k in (order[0], order[-1])]
    one, two = found
    if one is None or two is None or one.above is not two.above:
        return ""
    length = max(one.low, two.low), min(one.high, two.high)
    turn = max(one.turn[0], two.turn[0]), min(one.turn[1], two.turn[1])
    if (length[0] < length[1]) is (turn[0] < turn[1]):
        return ""  # both, or neither
    if turn[0] < turn[1]:
        term = "more" if one.above else "less"
        return f"a step turns the body by {term} than a limit between {limits(*turn, 'rad')}"
    term = "longer" if one.above else "shorter"
    return f"a step is {term} than a limit between {limits(*length, 's')}"


def _jump(
    driver: Requests, case: Case, integrator: Integrator, start: State, eps: float
) -> Jump | None:
    """Where the error of one step from a state jumps; None where it does not, or in two places."""
    rate = float(norm(start.angular_velocity))
    low, high, above = TURNS[0] / rate, TURNS[1] / rate, False
    for number in range(ROUNDS):
        count = PARTS if number else LENGTHS
        lengths = np.geomspace(low, high, count + 1)
        errors = _errors(driver, case, integrator, start, lengths, eps)
        if errors is None:
            return None
        steps = np.abs(np.diff(np.log(errors)))
        k = int(np.argmax(steps))
        if np.count_nonzero(np.exp(steps) >= JUMP) != 1:
            return None
        low, high, above = float(lengths[k]), float(lengths[k + 1]), bool(errors[k + 1] > errors[k])
    end = exact_solution(case.system, start, np.array([0.0, high])).state[1]
    rates = sorted((rate, float(norm(end.angular_velocity))))
    return Jump(low, high, (low * rates[0], high * rates[1]), above)


def _errors(
    driver: Requests, case: Case, integrator: Integrator, start: State, lengths: Array, eps: float
) -> Array | None:
    """(k,): how far a step of each length is from the exact motion, relative to what it changes."""
    try:
        exact = exact_solution(case.system, start, np.concatenate([[0.0], lengths])).state[1:]
    except (ValueError, ArithmeticError, np.linalg.LinAlgError):
        return None
    finest = finest_of(integrator) if integrator.knob == "accuracy" else None
    one = State(*(f[None] for f in vars(start).values()))
    how = {"integrator": integrator.name, "accuracy": finest}
    answer = driver.request(case, "first_steps", **how, states=one, timesteps=lengths[None])
    if not answer.ok:
        return None
    after = State(**answer.result)[0]
    turned = norm(start.angular_velocity) * lengths
    changed = norm(forward_dynamics(case.system, start).angular) * lengths
    turn = attitude_angle(exact.orientation, after.orientation) / turned
    with np.errstate(all="ignore"):
        spun = norm(after.angular_velocity - exact.angular_velocity) / changed
    spun = np.where(changed > eps * norm(start.angular_velocity), spun, 0.0)
    total = np.asarray(turn + spun + 64.0 * eps / turned)
    return total if np.all(np.isfinite(total)) else None
