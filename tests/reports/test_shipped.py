"""Flips of a body, and the table of engines as shipped."""

from __future__ import annotations

import numpy as np
import pytest

from omegadot.adapters.protocol import mends
from omegadot.reports.shipped.figures import Figures
from omegadot.reports.shipped.flips import flip_times, in_time
from omegadot.reports.shipped.rows import ShippedRow, middle, scenario_of
from omegadot.reports.shipped.table import cells, heads, line
from omegadot.reports.shipped.table import mends as mending

INERTIA = np.diag([3.0, 1.0, 2.0])  # the intermediate axis is z
TIME = np.linspace(0.0, 8.0, 401)
EXACT = (1.0, 3.0, 5.0)


def turning(times: np.ndarray, period: float = 4.0) -> np.ndarray:
    """Omega that turns from z to x and on: its z changes sign at period/4, and every period/2."""
    angle = 2.0 * np.pi * times / period
    return np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], -1)


def test_flips_are_found_between_samples_and_in_a_body_that_is_braked() -> None:
    # linear between samples, of a cosine near its zero: off by (w dt)^3 / 16, less than 2e-6 s
    for speed in (1.0, np.exp(-2.0 * TIME)[:, None]):
        found = flip_times(TIME, speed * turning(TIME), INERTIA)
        np.testing.assert_allclose(found, [1.0, 3.0, 5.0, 7.0], atol=1e-5)
    turned = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    other = flip_times(TIME, turning(TIME) @ turned.T, turned @ INERTIA @ turned.T)
    np.testing.assert_allclose(other, [1.0, 3.0, 5.0, 7.0], atol=1e-5)


def test_a_body_that_wobbles_across_or_spins_elsewhere_does_not_flip() -> None:
    noise = 0.4 * np.sin(40.0 * TIME)
    across = np.stack([np.ones_like(TIME), np.zeros_like(TIME), noise], -1)
    assert flip_times(TIME, across, INERTIA) == ()
    assert flip_times(TIME, np.tile([0.0, 0.1, 9.0], (401, 1)), INERTIA) == ()
    assert flip_times(TIME, np.zeros((401, 3)), INERTIA) == ()


def test_what_is_not_finite_is_left_out() -> None:
    omega = turning(TIME)
    omega[TIME > 4.0] = np.nan
    omega[10] = np.inf
    assert len(flip_times(TIME, omega, INERTIA)) == 2


@pytest.mark.parametrize(
    ("flips", "expected"),
    [
        ((1.1, 3.2, 5.9), "yes"),
        ((1.9, 2.1, 7.9), "yes"),
        ((), "no"),
        ((1.1, 3.2), "late"),
        ((2.5, 3.2, 5.0), "late"),
        ((1.1, 1.9, 3.0, 5.0), "early"),
        ((1.0, 3.0, 5.0, 7.0), "early"),
        ((1.0, 4.5, 5.0), "late"),
    ],
)
def test_flips_are_in_time_where_each_is_the_one_of_its_part(
    flips: tuple[float, ...], expected: str
) -> None:
    assert in_time(flips, EXACT) == expected


def row(**more: object) -> ShippedRow:
    """An engine of which one setting mends, and another does next to nothing."""
    known = {
        "physics": Figures("ok", EXACT, 1e-4, 0.1, 0.05),
        "as_shipped": Figures("ok", (), 0.55, 3.1, 2.0),
        "settings": {
            "sleep": Figures("ok", (), 0.55, 3.1, 1.999),
            "gyroscopic": Figures("ok", (1.0, 4.5), 0.55, 3.12, 1.5),
        },
        "exact_flips": EXACT,
    }
    base = ("t-handle", "jolt", "step", 0.01, None)
    return ShippedRow(*base, **{**known, **more})  # type: ignore[arg-type]


def test_what_mends_most_is_by_the_mean_and_not_by_the_end() -> None:
    assert row().mends_most == ("gyroscopic", 0.75)
    assert mending(row()) == "gyroscopic: error × 0.75, flips late"
    without = row(settings={"sleep": Figures("ok", (), 0.55, 3.0, 1.999)})
    assert without.mends_most is None
    assert mending(without) == "none of 1"
    assert mending(row(settings={})) == "–"
    assert mending(row(settings={"sleep": Figures("crashed")})) == "none of 1"
    assert mending(row(physics=row().as_shipped, settings={})) == "nothing: both are alike"


def test_the_table_has_a_row_that_never_flips() -> None:
    both = row()
    assert heads([both])[2:4] == ("flips, as shipped", "flips, physics")
    (found,) = cells([both])
    assert found[:4] == ("jolt", "step", "no", "yes: 1, 3, 5 s")
    assert found[4:6] == ("55 %", "0.01 %")
    assert "0 of 1 engines flip in time, 1 set up for physics" in line((both,))
    elsewhere = row(exact_flips=())
    assert not any("flips" in head for head in heads([elsewhere]))
    assert len(cells([elsewhere])[0]) == len(heads([elsewhere]))
    assert cells([row(as_shipped=Figures("timeout"))])[0][2] == "timeout"


def test_integrators_that_do_the_same_share_a_row() -> None:
    other = ShippedRow(**{**vars(row()), "integrator": "other"})
    assert [found[1] for found in cells([row(), other])] == ["step, other"]
    assert line(()) == ""


def test_rows_that_flip_otherwise_or_never_come_first() -> None:
    same = row(physics=row().as_shipped, settings={})
    less, more = (
        row(as_shipped=Figures("ok", EXACT, 0.5, 0.2, mean), settings={}) for mean in (0.1, 0.2)
    )
    flips = Figures("ok", EXACT, 0.5, 0.2, 0.1)
    alike = row(as_shipped=flips, physics=flips, settings={})
    named = {"alike": alike, "same": same, "less": less, "more": more, "otherwise": row()}
    rows = tuple(ShippedRow(**{**vars(one), "engine": name}) for name, one in named.items())
    assert [found[0] for found in cells(rows)] == ["otherwise", "same", "more", "less", "alike"]
    assert line(rows).endswith("What mends most: otherwise gyroscopic, error × 0.75.")


def test_the_middle_and_the_scenario_of_the_table() -> None:
    assert middle([0.02, 0.005, 0.01]) == 0.01
    assert middle([0.02, 0.01]) == 0.02
    assert scenario_of(["sphere", "t-handle"]) == "t-handle"
    assert scenario_of(["sphere", "brick"]) == "sphere"


def test_a_default_is_mended_for_physics_and_by_its_own_name() -> None:
    assert mends("physics", "damping")
    assert mends("as-shipped+damping", "damping")
    assert not mends("as-shipped", "damping")
    assert not mends("as-shipped+angular-damping", "damping")
