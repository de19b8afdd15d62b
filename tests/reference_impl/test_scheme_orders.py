"""Every scheme shows its declared order, per channel, against the Taylor series.

The error is the largest over common instants; log error is regressed on log step over four steps
that halve. A scheme with a lower order than declared fails, and so does one with a higher.
"""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import (
    DAMPED,
    DRIVEN,
    EPS,
    FREE,
    TOP,
    in_long_double,
    rows,
    start,
    system,
    turned,
)

from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.schemes.scheme import CHANNELS, kinds_of
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

pytestmark = pytest.mark.no_cover  # its lines are covered by others

DURATION, INSTANTS = 1.0, 5
STEPS = {1: (400, 800, 1600), 2: (100, 200, 400), 4: (20, 40, 80)}
CASES: dict[str, tuple[System, State]] = {
    "free": (FREE, start([1.0, 2.0, -1.5], [1, 2, 3, 4], velocity=(1, 2, 3))),
    "top": (TOP, start([0.3, 0.4, 3.0], [1, 0.3, 0.1, 0], on=TOP)),
    "driven": (DRIVEN, start([1.0, -1.0, 1.5], velocity=(1, 2, 3))),
    "damped": (DAMPED, start([2.0, 1.5, 1.0], velocity=(1, 2, 3))),
}


def norm(v: Array) -> Array:
    return np.linalg.norm(v, axis=-1)


def errors(system: System, found: State, true: State) -> dict[str, float]:
    """The largest error over the instants, per channel."""
    differences = {
        "omega": norm(found.angular_velocity - true.angular_velocity),
        "attitude": attitude_angle(found.orientation, true.orientation),
        "energy": np.abs(total_energy(system, found) - total_energy(system, true)),
        "angular_momentum": norm(angular_momentum(system, found) - angular_momentum(system, true)),
        "linear_momentum": norm(linear_momentum(system, found) - linear_momentum(system, true)),
        "position": norm(found.position - true.position),
    }
    return {channel: float(np.max(differences[channel])) for channel in CHANNELS}


def sizes(system: System, true: State) -> dict[str, float]:
    """What rounding is relative to, per channel."""
    values = {
        "omega": norm(true.angular_velocity),
        "attitude": np.ones(1),
        "energy": np.abs(total_energy(system, true)),
        "angular_momentum": norm(angular_momentum(system, true)),
        "linear_momentum": norm(linear_momentum(system, true)),
        "position": norm(true.position),
    }
    return {channel: float(np.max(values[channel])) for channel in CHANNELS}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", COMMON)
def test_observed_orders_are_the_declared_ones(name: str, case: str) -> None:
    scheme, (system, initial) = SCHEMES[name], CASES[case]
    true = solve_series(system, initial, np.linspace(0, DURATION, INSTANTS + 1))
    declared = {channel: scheme.order(channel, system) for channel in CHANNELS}
    counts = STEPS[min(order for order in declared.values() if order is not None)]
    found = []
    for steps in counts:
        _, states = step_body(scheme, system, initial, DURATION / steps, steps, steps // 5)
        found.append(errors(system, states, true))
    size = sizes(system, true)
    for channel, order in declared.items():
        trajectory = np.array([error[channel] for error in found])
        if order is None:
            # a few roundings in every step, of things that hardly grow in one second
            assert np.max(trajectory) <= 16 * EPS * counts[-1] * size[channel], (
                channel,
                trajectory,
            )
            continue
        slope = -np.polyfit(np.log(counts), np.log(trajectory), 1)[0]
        assert abs(slope - order) <= 0.15, (channel, order, slope, trajectory)


OFFSET = system(
    turned([1, 2, 2.5]),
    mass=1.5,
    center=(0.1, -0.2, 0.3),
    gravity=(0, 1, -3),
    damping=0.1,
    torque_world=(0, 0.3, 0.2),
)


@pytest.mark.parametrize(
    ("name", "coordinates"),
    [(n, c) for n, s in COMMON.items() for c in s.coordinates if c != "com-world"],
)
def test_orders_in_other_coordinates_are_the_general_ones(
    name: str, coordinates: Coordinates
) -> None:
    """With the centre of mass off the origin nothing is conserved, and no channel does better.

    In long double where there is one, and over two fine steps: an energy's next term is large.
    """
    scheme = SCHEMES[name]
    loads = (in_long_double(OFFSET.body),), in_long_double(OFFSET.load)
    long = System(*loads)
    initial = start([2.0, 1.5, 1.0], [1, 2, 3, 4], (1, 2, 3), (1, 2, 3))
    true = solve_series(OFFSET, initial, np.linspace(0, 1, 3))
    declared = {channel: scheme.order(channel, OFFSET, coordinates) for channel in CHANNELS}
    general = {channel: scheme.orders[channel] for channel in ("energy", "position")}
    assert {channel: declared[channel] for channel in general} == general
    found = []
    for steps in (128, 256):
        how = (np.longdouble(1) / steps, steps, steps // 2, coordinates)
        _, states = step_body(scheme, long, in_long_double(initial), *how)
        found.append(errors(long, states, true))
    for channel, order in declared.items():
        slope = np.log2(found[0][channel] / found[1][channel])
        assert order is not None
        assert abs(slope - order) <= 0.15, (channel, order, slope)


FINE = {1: (400, 800), 2: (256, 512), 3: (128, 256), 4: (256, 512), 5: (128, 256), 6: (48, 96)}
# Made to have small leading terms, beside which the next ones are seen at every step above
# rounding: a slope is nearer to the order than to the one below, and test_tableaus.py shows that
# the order is no higher.
SMALL = ("munthe-kaas-butcher6", "dormand-prince5", "fehlberg4")
TOP_AND_OFFSET = {
    "top": CASES["top"],
    "offset": (OFFSET, start([2.0, 1.5, 1.0], [1, 2, 3, 4], (1, 2, 3))),
}


@pytest.mark.parametrize("case", TOP_AND_OFFSET)
@pytest.mark.parametrize("name", [name for name in SCHEMES if name not in COMMON])
def test_methods_on_charts_have_their_orders(name: str, case: str) -> None:
    """In long double where there is one; `offset` is stepped in the origin's coordinates."""
    scheme, (system, initial) = SCHEMES[name], TOP_AND_OFFSET[case]
    way: Coordinates = "origin-world" if case == "offset" else "com-world"
    true = solve_series(system, initial, np.linspace(0, 1, 3))
    long = System((in_long_double(system.body),), in_long_double(system.load))
    declared = {channel: scheme.order(channel, system, way) for channel in CHANNELS}
    found, size, counts = [], sizes(system, true), FINE[scheme.orders["omega"]]
    for steps in counts:
        how = (np.longdouble(1) / steps, steps, steps // 2, way)
        _, states = step_body(scheme, long, in_long_double(initial), *how)
        found.append(errors(long, states, true))
    for channel, order in declared.items():
        if order is None:
            # of the truth, which is in doubles, and of long doubles where these are no longer
            assert found[1][channel] <= 16 * EPS * counts[-1] * size[channel]
            continue
        slope = np.log2(found[0][channel] / found[1][channel])
        low, high = (0.5, np.inf) if name.startswith(SMALL) else (0.15, 0.15)
        assert -low <= slope - order <= high, (channel, order, slope)


def test_the_naive_mean_is_hidden_from_energy_but_not_from_momentum() -> None:
    # the published trap: omega and energy at order 4, attitude and momentum at order 2
    system, initial = CASES["free"]
    true = solve_series(system, initial, np.array([0.0, 1.0]))
    found = {
        name: errors(
            system,
            step_body(SCHEMES[name], system, initial, 0.02, 50, 50)[1],
            true,
        )
        for name in ("lie-rk4", "lie-rk4-naive")
    }
    good, naive = found["lie-rk4"], found["lie-rk4-naive"]
    assert naive["energy"] == good["energy"]
    assert naive["omega"] == good["omega"]
    assert naive["angular_momentum"] > 1e3 * good["angular_momentum"]


def test_kinds_of_systems() -> None:
    assert kinds_of(FREE) == ("free", "decoupled", "torque-free")
    assert kinds_of(DAMPED) == ("free", "decoupled")
    assert kinds_of(DRIVEN) == ("free",)
    assert kinds_of(TOP) == ()


def test_every_scheme_has_a_name_a_title_and_a_source() -> None:
    for name, scheme in SCHEMES.items():
        assert scheme.name == name
        assert scheme.title
        assert scheme.source
        assert set(scheme.orders) == set(CHANNELS)


def test_rows_of_lanes_with_a_step_each_are_the_single_runs() -> None:
    timesteps = np.array([0.01, 0.02, 0.005])
    for scheme in SCHEMES.values():
        for on, initial in CASES.values():
            lanes = State(*(np.repeat(f[None], 3, axis=0) for f in vars(initial).values()))
            args = (scheme, on)
            times, together = step_body(*args, lanes, timesteps, 20, 7)
            for lane, dt in enumerate(timesteps):
                alone_times, alone = step_body(*args, initial, float(dt), 20, 7)
                assert np.array_equal(times[:, lane], alone_times)
                gap = errors(on, rows(together, (slice(None), lane)), alone)
                size = sizes(on, alone)
                for channel in CHANNELS:
                    # both round differently, a few times in each of twenty steps
                    assert gap[channel] <= 16 * 20 * EPS * size[channel], (scheme.name, channel)
