"""The model gate, fed right and slightly wrong bodies and states."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from omegadot.gates.bounds.scales import EPS
from omegadot.gates.rows import Row
from omegadot.gates.states.model import body_rows, state_rows
from omegadot.reference_impl.system import Body, State, System

BODY = Body(np.array(2.0), np.array([0.0, 0.0, 4.0]), np.diag([1.0, 2.0, 2.5]))
CASE = SimpleNamespace(system=System((BODY,)))
STATE = State(
    np.array([1.0, 0.0, 0.0, 0.0]),
    np.array([0.0, 0.0, 2.0]),
    np.array([0.0, 3.0, 0.0]),
    np.array([0.0, 0.0, 5.0]),
)


def by_metric(rows: list[Row]) -> dict[str, Row]:
    assert all(row.gate == "model" for row in rows)
    return {row.metric if row.channel == "model" else row.channel: row for row in rows}


def test_what_was_requested_passes() -> None:
    rows = by_metric(body_rows(CASE, BODY))
    assert list(rows) == ["mass", "center_of_mass", "inertia"]
    assert [row.unit for row in rows.values()] == ["1", "m", "1"]
    assert all((row.value, row.verdict) == (0.0, "pass") for row in rows.values())
    bounds = [row.bound for row in rows.values()]
    assert bounds == [32 * EPS, 32 * EPS * 4.0, 64 * EPS]


@pytest.mark.parametrize("factor", [1.001, 0.999])
def test_a_mass_off_by_a_thousandth_fails_alone(factor: float) -> None:
    rows = by_metric(body_rows(CASE, replace(BODY, mass=factor * BODY.mass)))
    assert rows["mass"].value == pytest.approx(1e-3, rel=1e-9)
    assert [row.verdict for row in rows.values()] == ["fail", "pass", "pass"]


def test_a_centre_of_mass_off_by_a_micrometre_fails_alone() -> None:
    moved = replace(BODY, center_of_mass=np.array([0.0, -1e-6, 4.0]))
    rows = by_metric(body_rows(CASE, moved))
    assert rows["center_of_mass"].value == pytest.approx(1e-6, rel=1e-9)
    assert [row.verdict for row in rows.values()] == ["pass", "fail", "pass"]


@pytest.mark.parametrize(("times", "verdict"), [(60, "pass"), (70, "fail")])
def test_an_inertia_is_held_to_its_size(times: int, verdict: str) -> None:
    off = BODY.inertia.copy()
    off[2, 2] += times * EPS * 2.5
    row = by_metric(body_rows(CASE, replace(BODY, inertia=off)))["inertia"]
    assert row.value == pytest.approx(times * EPS, abs=2 * EPS)
    assert row.verdict == verdict


def test_a_product_of_inertia_counts_like_a_moment() -> None:
    off = BODY.inertia.copy()
    off[0, 1] = off[1, 0] = 1e-3
    assert by_metric(body_rows(CASE, replace(BODY, inertia=off)))["inertia"].value == (
        pytest.approx(1e-3 / 2.5, rel=1e-9)
    )


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_no_number_fails(bad: float) -> None:
    none = Body(np.array(bad), np.full(3, bad), np.full((3, 3), bad))
    assert {row.verdict for row in body_rows(CASE, none)} == {"fail"}
    off = BODY.inertia.copy()
    off[0, 0] = bad
    assert by_metric(body_rows(CASE, replace(BODY, inertia=off)))["inertia"].verdict == "fail"


def test_a_state_that_comes_back_passes() -> None:
    rows = by_metric(state_rows(CASE, STATE, STATE))
    assert list(rows) == ["attitude", "omega", "position", "linear_momentum"]
    assert {row.metric for row in rows.values()} == {"state"}
    assert [row.unit for row in rows.values()] == ["rad", "rad/s", "m", "m/s"]
    assert all((row.value, row.verdict) == (0.0, "pass") for row in rows.values())
    # |omega| = 2, lever = 4: a velocity of the origin is 2 * 4 more than one of the centre.
    sizes = [1.0, 2.0, 3.0 + 4.0, 5.0 + 2.0 * 4.0]
    assert [row.bound for row in rows.values()] == [32 * EPS * size for size in sizes]


@pytest.mark.parametrize(
    ("channel", "field", "change"),
    [
        ("omega", "angular_velocity", [0.0, 1e-6, 0.0]),
        ("position", "position", [1e-6, 0.0, 0.0]),
        ("linear_momentum", "linear_velocity", [0.0, 0.0, -1e-6]),
    ],
)
def test_each_part_of_a_state_fails_alone(channel: str, field: str, change: list[float]) -> None:
    back = replace(STATE, **{field: getattr(STATE, field) + np.array(change)})
    rows = by_metric(state_rows(CASE, STATE, back))
    assert rows[channel].value == pytest.approx(1e-6, rel=1e-6)
    assert {name for name, row in rows.items() if row.verdict == "fail"} == {channel}


def test_an_attitude_is_off_by_its_angle() -> None:
    back = replace(STATE, orientation=np.array([1.0, 5e-7, 0.0, 0.0]))
    rows = by_metric(state_rows(CASE, STATE, back))
    assert rows["attitude"].value == pytest.approx(1e-6, rel=1e-9)
    assert [row.verdict for row in rows.values()] == ["fail", "pass", "pass", "pass"]
    assert by_metric(state_rows(CASE, STATE, replace(STATE, orientation=-STATE.orientation)))[
        "attitude"
    ].verdict == "pass"  # fmt: skip
