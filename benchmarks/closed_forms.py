"""The closed form of free rotation against SciPy's DOP853 and heyoka's Taylor integrator.

100 000 samples of angular velocity and attitude, spread over 1 000 flip periods, in one call each.
DOP853 runs at rtol 1e-13 with dense output, heyoka at tol 1e-15 with ``propagate_grid``; compiling
heyoka's integrator is left out, working out the closed form's constants is not. The error is the
one at the last sample against the textbook form in mpmath at sixty digits: by elliptic functions,
and by sines and cosines where two moments agree. The closed form and heyoka take turns, so that
both meet the machine in the same state, and the shortest run of each counts.

    pip install . heyoka mpmath && python benchmarks/closed_forms.py [--flips 1000] [--skip-dop853]
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from math import radians
from pathlib import Path

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

from omegadot.reference_impl.closed_forms import closed_form_of, floor, problem_of
from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.euler_poinsot import constants_of
from omegadot.reference_impl.closed_forms.free_rotation import inertia_and_omega
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, State, System

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "closed_forms"))

SAMPLES = 100_000
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
SLUG_FOOT_SQUARE = 14.593902937206364829 * 0.3048**2  # kg m^2
Vector = tuple[float, float, float]
BRICK: Vector = (
    0.001894220 * SLUG_FOOT_SQUARE,
    0.006211019 * SLUG_FOOT_SQUARE,
    0.007194665 * SLUG_FOOT_SQUARE,
)
CASES: dict[str, tuple[Vector, Vector]] = {
    "T-handle, middle axis off by 0.005": ((1.0, 2.0, 3.0), (0.01, 2.0, 0.01)),
    "T-handle, middle axis off by 5e-6": ((1.0, 2.0, 3.0), (1e-5, 2.0, 1e-5)),
    "tumbling brick": ((1.0, 2.0, 3.0), (0.3, 1.0, 0.1)),
    "brick of NESC check-case 2": (BRICK, (radians(10), radians(20), radians(30))),
    "1e-12 from the separatrix": ((1.5, 2.0, 3.0), (2.0, 0.5, 1.0 + 1.3e-12)),
    "prolate top": ((1.0, 2.0, 2.0), (0.4, -0.5, 0.6)),
    "oblate top": ((1.0, 1.0, 2.0), (0.4, -0.5, 0.6)),
}
ROUNDS = 10


def rates(moments: Vector, y: list[float]) -> list[float]:
    """The quaternion's and ω's rates in plain floats, the fastest form for one state at a time."""
    a, b, c = moments
    q0, q1, q2, q3, w1, w2, w3 = y
    return [
        0.5 * (-q1 * w1 - q2 * w2 - q3 * w3),
        0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
        0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
        0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
        (b - c) / a * w2 * w3,
        (c - a) / b * w3 * w1,
        (a - b) / c * w1 * w2,
    ]


def period_of(system: System, initial: State) -> tuple[float, float]:
    """``2K/λ``, s from flip to flip, and 1 - m, which is zero on the separatrix."""
    problem = problem_of(system, initial)
    assert problem is not None
    with many_digits():
        found = constants_of(*inertia_and_omega(problem.numbers))
        assert found is not None
        return float(2 * found.modulus.quarter / found.rate), float(found.modulus.m1)


def run_closed_form(system: System, initial: State, times: Array) -> Callable[[], Array]:
    """One call: constants and all samples, of which the last is returned, (7,)."""

    def run() -> Array:
        motion = closed_form_of(system, initial)
        assert motion is not None
        state = motion(times)
        return np.concatenate([state.orientation[-1], state.angular_velocity[-1]])

    return run


def run_dop853(moments: Vector, start: list[float], times: Array) -> Callable[[], Array]:
    """Integration and dense output at all samples, of which the last is returned, (7,)."""

    def run() -> Array:
        solution = solve_ivp(
            lambda _, y: rates(moments, y.tolist()),
            (0.0, times[-1]),
            start,
            method="DOP853",
            rtol=1e-13,
            atol=1e-16,
            dense_output=True,
        )
        return np.asarray(solution.sol(times)[:, -1])

    return run


def run_heyoka(moments: Vector, start: list[float], times: Array) -> Callable[[], Array]:
    """The compiled integrator's ``propagate_grid``, the last sample, (7,)."""
    import heyoka

    variables = heyoka.make_vars("q0", "q1", "q2", "q3", "w1", "w2", "w3")
    equations = list(zip(variables, rates(moments, list(variables)), strict=True))
    integrator = heyoka.taylor_adaptive(equations, start, tol=1e-15)

    def run() -> Array:
        integrator.time = 0.0
        integrator.state[:] = start
        return np.asarray(integrator.propagate_grid(times)[-1][-1])

    return run


def best_of(runs: dict[str, Callable[[], Array]], rounds: int) -> dict[str, tuple[float, Array]]:
    """The shortest of some runs of each, s, and the result; the runs take turns."""
    best: dict[str, tuple[float, Array]] = {}
    for _ in range(rounds):
        for name, run in runs.items():
            began = time.perf_counter()
            result = run()
            span = time.perf_counter() - began
            best[name] = min(span, best.get(name, (span,))[0]), result
    return best


def symmetric_rotation(
    moments: Vector, omega: Vector, end: float
) -> tuple[mp.matrix, list[mp.mpf]]:
    """(world_R_body, ω) of a body of which two moments agree, upright at time zero.

    It turns about its axis of symmetry by ``(1 - I_c/I_a) ω_c t`` and then about the fixed angular
    momentum L by ``L t / I_a`` (Landau and Lifshitz, Mechanics, section 35, (35.4)-(35.5)).
    """
    axis = next(i for i in range(3) if moments[i - 2] == moments[i - 1])
    i_c, i_a = mp.mpf(moments[axis]), mp.mpf(moments[axis - 1])
    momentum = [mp.mpf(i) * mp.mpf(w) for i, w in zip(moments, omega, strict=True)]
    own = [mp.mpf(i == axis) for i in range(3)]
    spin = _turn(own, (1 - i_c / i_a) * mp.mpf(omega[axis]) * end)
    precession = _turn(momentum, mp.norm(mp.matrix(momentum)) * end / i_a)
    return precession * spin, list(spin.T * mp.matrix([mp.mpf(w) for w in omega]))


def _turn(axis: list[mp.mpf], angle: mp.mpf) -> mp.matrix:
    """The rotation about an axis, by Rodrigues's formula."""
    x, y, z = mp.matrix(axis) / mp.norm(mp.matrix(axis))
    k = mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return mp.eye(3) + mp.sin(angle) * k + (1 - mp.cos(angle)) * k * k


def errors_at_the_end(
    moments: Vector, omega: Vector, end: float, last: Array
) -> tuple[float, float]:
    """The relative error of ω and the angle of the attitude's, rad, of the last sample."""
    from closed_form_elliptic import free_rotation

    with mp.workdps(60):
        if len(set(moments)) == 3:
            ((world_R_body, w),) = free_rotation(np.diag(moments), UPRIGHT, omega, [end])
        else:
            world_R_body, w = symmetric_rotation(moments, omega, end)
        off = mp.norm(mp.matrix([mp.mpf(float(x)) - y for x, y in zip(last[4:], w, strict=True)]))
        found = mp.matrix(rotation_matrix(last[:4] / np.linalg.norm(last[:4])).tolist())
        # |R1 - R2|_F = 2√2 sin(angle / 2)
        gap = mp.mnorm(found - world_R_body, "f") / (2 * mp.sqrt(2))
        return float(off / mp.norm(mp.matrix(w))), float(2 * mp.asin(min(gap, 1)))


def main() -> None:
    """Time the three on every case and print their ratios and errors."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flips", type=int, default=1000, help="flip periods to cover")
    parser.add_argument("--skip-dop853", action="store_true", help="only heyoka, which is quick")
    options = parser.parse_args()
    for title, (moments, omega) in CASES.items():
        system = System((Body(np.array(1.0), np.zeros(3), np.diag(moments)),))
        initial = State(np.array(UPRIGHT), np.array(omega), np.zeros(3), np.zeros(3))
        flip_period, complement = period_of(system, initial)
        times = np.linspace(0.0, options.flips * flip_period, SAMPLES)
        start = [*UPRIGHT, *omega]
        print(f"\n{title}: 1 - m = {complement:.2g}, {SAMPLES} samples to {times[-1]:.0f} s")
        least = floor(system, initial, times[-1:])
        in_omega = least.angular_velocity[0] / np.linalg.norm(omega)
        print(f"  floor at the end: omega {in_omega:.1e}, attitude {least.attitude[0]:.1e} rad")
        spans = best_of(
            {
                "closed form": run_closed_form(system, initial, times),
                "heyoka": run_heyoka(moments, start, times),
            },
            ROUNDS,
        )
        if not options.skip_dop853:
            spans |= best_of({"DOP853": run_dop853(moments, start, times)}, 1)
        for name, (span, result) in spans.items():
            in_omega, in_attitude = errors_at_the_end(moments, omega, float(times[-1]), result)
            print(
                f"  {name:12s} {1e3 * span:10.2f} ms  {span / spans['closed form'][0]:8.1f} x   "
                f"error at the end: omega {in_omega:.1e}, attitude {in_attitude:.1e} rad"
            )


if __name__ == "__main__":
    main()
