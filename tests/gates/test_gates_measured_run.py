"""What a run shows in each channel, and what is made of several runs of a sweep."""

from dataclasses import replace

import numpy as np
import pytest

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.case import Sweep
from omegadot.gates.errors.findings import (
    Declared,
    MeasuredSweep,
    evidence_of,
    findings_of,
    orders_for,
)
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun, measure
from omegadot.gates.truth import Companion, SchemeKey, Truth, scheme_key
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, Body, Load, State, System

BOUND = 1e-12
BODY = Body(np.array(2.0), np.zeros(3), np.diag([1.0, 2.0, 2.5]))
FREE = System((BODY,))
OFFSET = System(
    (replace(BODY, center_of_mass=np.array([0.1, 0.0, 0.0])),),
    Load(gravity=np.array([0.0, 0.0, -9.0]), damping=np.array(0.1)),
)


def measured(
    step: float, error: float, left: float | None = None, floor: float = 0.0
) -> MeasuredRun:
    """A run whose error is the same in all channels: nothing, a half, all of it."""

    def shaped(size: float) -> dict[str, Array]:
        return {channel: size * np.array([0.0, 0.5, 1.0]) for channel in CHANNELS}

    bound = {channel: np.full(3, BOUND) for channel in CHANNELS}
    against = {} if left is None else shaped(left)
    floors = {"omega": np.full(3, floor)} if floor else {}
    return MeasuredRun(Sweep(step, 2, 1), shaped(error), bound, against, floors)


def sweep(order: int, left: int | None = None) -> list[MeasuredRun]:
    return [measured(h, h**order, None if left is None else h**left) for h in (0.04, 0.02, 0.01)]


def together(runs: list[MeasuredRun]) -> MeasuredSweep:
    return MeasuredSweep(tuple(runs))


def test_the_channels() -> None:
    assert CHANNELS == (
        "omega",
        "attitude",
        "position",
        "energy",
        "angular_momentum",
        "linear_momentum",
    )


@pytest.mark.parametrize(("of_attitude", "verdict"), [(2, "info"), (0, "fail")])
def test_energy_overflows_with_the_state(of_attitude: int, verdict: str) -> None:
    """Its errors cancel until then, and show no order; those of the state do, or do not."""
    times, runs = np.linspace(0.0, 1.0, 65), []
    for step, change in ((0.04, 1.0), (0.02, 0.6), (0.01, 1.0), (0.005, 1.7)):
        grown = times * 10.0 ** (5.0 * times)
        error = dict.fromkeys(CHANNELS, step**2 * grown)
        error["attitude"] = 1e-4 * (step / 0.04) ** of_attitude * grown
        error["energy"] = change * step**2 * grown
        for channel in ("omega", "attitude", "energy") if step == 0.04 else ():
            error[channel] = np.where(times > 0.9, np.inf, error[channel])
        bound = dict.fromkeys(CHANNELS, np.full(65, BOUND))
        runs.append(MeasuredRun(Sweep(step, 64, 1), error, bound))
    found = findings_of(runs[0], Declared(None, dict.fromkeys(CHANNELS, 2)), together(runs))
    assert found["omega"].verdict == "info"
    assert found["attitude"].verdict == found["energy"].verdict == verdict


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_orders_of_an_error_and_of_what_is_left_of_it(order: int) -> None:
    runs = sweep(1, order)
    own, left = evidence_of(runs[-1], together(runs), "energy", 1).orders
    assert own is not None
    assert left is not None
    assert (own.value, left.value) == (pytest.approx(1), pytest.approx(order))
    alone = sweep(order)
    assert len(evidence_of(alone[0], together(alone), "energy", 1).orders) == 1


def test_each_run_has_an_excess_of_its_own() -> None:
    runs = [measured(h, h**2 + (0.4 if h == 0.04 else 0.0)) for h in (0.04, 0.02, 0.01, 0.005)]
    excess = [evidence_of(run, together(runs), "omega", 2).excess for run in runs]
    assert excess[0] > 10.0
    assert all(one < 1.0 for one in excess[1:])
    assert [evidence_of(run, together(runs), "omega", 2).settled for run in runs] == [True] + 3 * [
        False
    ]
    found = findings_of(runs[0], Declared(None, dict.fromkeys(CHANNELS, 2)), together(runs))[
        "omega"
    ]
    assert found.note.startswith("at this step the error is 31 times")


def test_evidence_holds_what_was_measured() -> None:
    runs = [measured(0.04, 4e-3, 1e-5, floor=1e-7), measured(0.02, 2e-3)]
    found = evidence_of(runs[0], together(runs), "omega")
    assert found.error is runs[0].error["omega"]
    assert found.left is runs[0].against_scheme["omega"]
    assert found.round_off is runs[0].round_off["omega"]
    assert found.floor is runs[0].floor["omega"]
    assert len(found.orders) == 2
    assert found.orders[1] is None  # only one of the two has a scheme to compare with
    alone = evidence_of(runs[1], together(runs), "energy")
    assert (alone.left, alone.floor, len(alone.orders)) == (None, None, 1)


def test_errors_and_what_is_left_of_them_are_formed_once_and_apart() -> None:
    both = together(sweep(1, 2))
    assert both.order("omega") is both.order("omega")
    assert both.errors("omega") is both.errors("omega")
    orders = [both.order("omega", left=left) for left in (False, True)]
    assert [one and round(one.value) for one in orders] == [1, 2]


def test_findings_name_every_channel() -> None:
    runs = sweep(1)
    orders = dict.fromkeys(CHANNELS, 1) | {"energy": None, "position": 2}
    found = findings_of(runs[0], Declared(None, orders), together(runs))
    assert list(found) == list(CHANNELS)
    kinds = {channel: finding.kind for channel, finding in found.items()}
    assert kinds == dict.fromkeys(CHANNELS, "consistent") | {
        "energy": "unexplained",
        "position": "unsettled",  # finer steps could show another order
    }
    failed = {channel for channel, finding in found.items() if finding.verdict == "fail"}
    assert failed == {"energy", "position"}
    explained = [measured(0.04, 1e-3, BOUND)]
    assert findings_of(explained[0], Declared("euler", orders), together(explained))[
        "energy"
    ].note == ("explained by euler, to 1e-12")


def states(size: float) -> State:
    q = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    spin = np.tile([0.0, size, 2.0], (3, 1))
    return State(q, spin, np.zeros((3, 3)), np.zeros((3, 3)))


def test_a_trajectory_is_measured_by_the_growth_of_its_own_scheme() -> None:
    plan, times = Sweep(0.5, 2, 1), np.array([0.0, 0.5, 1.0])
    yardstick = Yardstick(FREE, times, states(0.0))
    floor = {"omega": np.full(3, 1e-9)}
    exact, growth = states(0.0), np.array([1.0, 2.0, 3.0])
    truth = Truth("series", times, exact, np.zeros((3, 3)), growth, floor, yardstick)
    own = Companion(states(1e-3), np.array([1.0, 20.0, 30.0]), np.zeros((3, 3)))
    alone = measure(truth, plan, states(3e-3), None)
    compared = measure(truth, plan, states(3e-3), own)
    assert alone.error["omega"] == pytest.approx(np.full(3, 1.5e-3))
    assert alone.against_scheme == {}
    assert compared.against_scheme["omega"] == pytest.approx(np.full(3, 1e-3))
    assert set(alone.error) == set(compared.against_scheme) == set(CHANNELS)
    np.testing.assert_allclose(compared.round_off["omega"] / alone.round_off["omega"], [1, 10, 10])
    steps = np.array([0, 1, 2])
    expected = yardstick.round_off(0.5, steps, growth)["omega"]
    np.testing.assert_array_equal(alone.round_off["omega"], expected)
    np.testing.assert_equal(alone.floor, floor)
    np.testing.assert_equal(compared.floor, floor)


def test_which_run_of_the_reference_an_integrator_equals() -> None:
    plain = Integrator("euler", "semi-implicit-euler", {"omega": 1})
    at_origin = replace(plain, coordinates="origin-world")
    assert scheme_key(replace(plain, scheme=None), OFFSET) is None
    assert scheme_key(plain, OFFSET) == SchemeKey("semi-implicit-euler", "com-world")
    assert scheme_key(at_origin, OFFSET) == SchemeKey("semi-implicit-euler", "origin-world")
    assert scheme_key(at_origin, FREE) == SchemeKey("semi-implicit-euler", "com-world")


@pytest.mark.parametrize("scheme", [None, "of-my-own"])
def test_orders_of_an_unknown_scheme_are_as_declared(scheme: str | None) -> None:
    declared = Integrator("mine", scheme, {"omega": 3, "energy": 2})
    found = orders_for(declared, FREE)
    assert found == dict.fromkeys(CHANNELS) | {"omega": 3, "energy": 2}


def test_orders_of_a_known_scheme_are_the_schemes() -> None:
    name = "rk4-quaternion"
    scheme = SCHEMES[name]
    plain = Integrator("rk4", name, {"omega": 1})
    assert orders_for(plain, OFFSET) == {c: scheme.order(c, OFFSET) for c in CHANNELS}
    found = orders_for(replace(plain, coordinates="origin-world"), OFFSET)
    for channel in CHANNELS:
        coupled = channel in ("energy", "linear_momentum", "position")
        expected = scheme.orders[channel] if coupled else scheme.order(channel, OFFSET)
        assert found[channel] == expected
    assert orders_for(replace(plain, coordinates="origin-world"), FREE) == orders_for(plain, FREE)


def test_translation_that_is_stepped_at_an_offset_origin_has_the_general_orders() -> None:
    still = System((OFFSET.body,))
    scheme = SCHEMES["semi-implicit-euler"]
    plain = Integrator("euler", scheme.name, scheme.orders)
    simple, coupled = (
        orders_for(i, still) for i in (plain, replace(plain, coordinates="origin-world"))
    )
    assert simple != coupled
    assert {c: coupled[c] for c in ("linear_momentum", "position")} == {
        c: scheme.orders[c] for c in ("linear_momentum", "position")
    }
