"""The closed form of free rotation against SciPy's DOP853 and heyoka's Taylor integrator.

100 000 samples of angular velocity and attitude, spread over 1 000 flip periods, in one call each.
DOP853 runs at rtol 1e-13 with dense output, heyoka at tol 1e-15 with ``propagate_grid``; compiling
heyoka's integrator is left out, working out the closed form's constants is not. The error is the
one at the last sample against the textbook form in mpmath's elliptic functions at sixty digits.

    pip install . heyoka mpmath && python benchmarks/closed_forms.py [--flips 1000]
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

from omegadot.reference_impl.closed_forms import closed_form_of, floor
from omegadot.reference_impl.closed_forms.free_rotation_rates import free_rotation_rates
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, State, System

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "closed_forms"))

SAMPLES = 100_000
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
CASES = {
    "T-handle, middle axis off by 0.005": ((1.0, 2.0, 3.0), (0.01, 2.0, 0.01)),
    "T-handle, middle axis off by 5e-6": ((1.0, 2.0, 3.0), (1e-5, 2.0, 1e-5)),
    "tumbling brick": ((1.0, 2.0, 3.0), (0.3, 1.0, 0.1)),
}


def rates(moments: tuple[float, float, float], y: list[float]) -> list[float]:
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


def run_closed_form(system: System, initial: State, times: Array) -> Callable[[], Array]:
    """One call: constants and all samples, of which the last is returned, (7,)."""

    def run() -> Array:
        motion = closed_form_of(system, initial)
        assert motion is not None
        state = motion(times)
        return np.concatenate([state.orientation[-1], state.angular_velocity[-1]])

    return run


def run_dop853(
    moments: tuple[float, float, float], start: list[float], times: Array
) -> Callable[[], Array]:
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


def run_heyoka(
    moments: tuple[float, float, float], start: list[float], times: Array
) -> Callable[[], Array]:
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


def best_of(run: Callable[[], Array], repeats: int) -> tuple[float, Array]:
    """The shortest of some runs, s, and the result."""
    spans = []
    for _ in range(repeats):
        began = time.perf_counter()
        result = run()
        spans.append(time.perf_counter() - began)
    return min(spans), result


def errors_at_the_end(
    moments: tuple[float, float, float], omega: tuple[float, float, float], end: float, last: Array
) -> tuple[float, float]:
    """The relative error of ω and the angle of the attitude's, rad, of the last sample."""
    from closed_form_elliptic import free_rotation

    with mp.workdps(60):
        ((world_R_body, w),) = free_rotation(np.diag(moments), UPRIGHT, omega, [end])
        off = mp.norm(mp.matrix([mp.mpf(float(x)) - y for x, y in zip(last[4:], w, strict=True)]))
        found = mp.matrix(rotation_matrix(last[:4] / np.linalg.norm(last[:4])).tolist())
        # |R1 - R2|_F = 2√2 sin(angle / 2)
        gap = mp.mnorm(found - world_R_body, "f") / (2 * mp.sqrt(2))
        return float(off / mp.norm(mp.matrix(w))), float(2 * mp.asin(min(gap, 1)))


def main() -> None:
    """Time the three on every case and print their ratios and errors."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flips", type=int, default=1000, help="flip periods to cover")
    flips = parser.parse_args().flips
    for title, (moments, omega) in CASES.items():
        system = System((Body(np.array(1.0), np.zeros(3), np.diag(moments)),))
        initial = State(np.array(UPRIGHT), np.array(omega), np.zeros(3), np.zeros(3))
        found = free_rotation_rates(system, initial)
        times = np.linspace(0.0, flips * found.flip_period, SAMPLES)
        start = [*UPRIGHT, *omega]
        print(f"\n{title}: 1 - m = {found.complement:.2g}, {SAMPLES} samples to {times[-1]:.0f} s")
        least = floor(system, initial, times[-1:])
        in_omega = least.angular_velocity[0] / np.linalg.norm(omega)
        print(f"  floor at the end: omega {in_omega:.1e}, attitude {least.attitude[0]:.1e} rad")
        runs = {
            "closed form": (run_closed_form(system, initial, times), 20),
            "heyoka": (run_heyoka(moments, start, times), 5),
            "DOP853": (run_dop853(moments, start, times), 1),
        }
        own = 0.0
        for name, (run, repeats) in runs.items():
            span, result = best_of(run, repeats)
            own = own or span
            in_omega, in_attitude = errors_at_the_end(moments, omega, float(times[-1]), result)
            print(
                f"  {name:12s} {1e3 * span:10.2f} ms  {span / own:8.1f} x   "
                f"error at the end: omega {in_omega:.1e}, attitude {in_attitude:.1e} rad"
            )


if __name__ == "__main__":
    main()
