"""Ranks, ties and the front, from timings that are known."""

from __future__ import annotations

import pytest

from omegadot.commands.choose.ranking import Point, Spread, front, ranked, total

WEATHER = (1.0, 1.4, 0.9, 3.0, 1.1, 1.2, 2.2)  # how slow the machine was, round by round


def cost(factor: float, *own: float) -> Spread:
    """A cost under the common weather, with noise of its own."""
    noise = own or (1.0,) * len(WEATHER)
    return Spread(tuple(factor * w * n for w, n in zip(WEATHER, noise, strict=True)))


def ranks(costs: dict[str, Spread]) -> dict[str, tuple[int, bool]]:
    return {place.candidate: (place.rank, place.tied) for place in ranked(costs)}


def test_the_weather_of_a_round_decides_nothing() -> None:
    """Quartiles of the two overlap widely; round by round one is always dearer."""
    assert ranks({"a": cost(1.0), "b": cost(1.2)}) == {"a": (1, False), "b": (2, False)}


def test_what_noise_may_turn_round_is_a_tie() -> None:
    noisy = cost(1.1, 0.8, 1.2, 1.0, 0.9, 1.3, 0.85, 1.1)
    assert ranks({"a": cost(1.0), "b": noisy}) == {"a": (1, True), "b": (1, True)}


def test_what_a_step_that_is_known_to_five_percent_may_turn_round_is_a_tie() -> None:
    assert ranks({"a": cost(1.0), "b": cost(1.04)}) == {"a": (1, True), "b": (1, True)}
    assert ranks({"a": cost(1.0), "b": cost(1.06)})["b"] == (2, False)


def test_ties_do_not_drag_others_along() -> None:
    found = ranks({"a": cost(1.0), "b": cost(1.04), "c": cost(1.08), "d": cost(9.0)})
    assert found == {"a": (1, True), "b": (1, True), "c": (3, False), "d": (4, False)}


def test_the_front_is_what_nothing_beats() -> None:
    points = [
        Point("cheap", (1.0, 0.9, 50.0)),
        Point("exact", (2.0, 0.1, 50.0)),
        Point("small", (3.0, 0.9, 10.0)),
        Point("beaten", (2.0, 0.2, 50.0)),
        Point("same", (1.0, 0.9, 50.0)),
    ]
    assert [p.key for p in front(points)] == ["cheap", "exact", "small", "same"]


def test_spreads_follow_their_rounds() -> None:
    spread = Spread((1.0, 2.0, 4.0))
    assert spread.median == 2.0
    assert spread.quartiles == (1.5, 3.0)
    assert spread.under(8.0).rounds == (8.0, 4.0, 2.0)
    assert total([spread, spread.scaled(2.0)]).rounds == pytest.approx((3.0, 6.0, 12.0))
