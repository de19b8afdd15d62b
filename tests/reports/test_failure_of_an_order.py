"""What a failure costs: against which errors of which order, and where none."""

from __future__ import annotations

from dataclasses import replace

from changed_records import FIGURE, edited
from failing_records import FAILING, failing, failing_in_a_probe
from synthetic_record import metric, with_metrics

from omegadot.reports.record.record import Record
from omegadot.reports.summary.summary import summarise


def test_what_it_costs_names_its_scenario(record: Record) -> None:
    """Caught: an equation that is worst on one scenario, and the dearer run of another left out."""
    equation = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    runs = [
        metric(name, *FAILING, 0.02, "trajectory", "attitude", "error_max", value)
        for name, value in (("spun-again", 9.0), ("sphere", 3.0))
    ]
    rows = [{**row, "verdict": "fail"} for row in (equation, *runs)]
    (found,) = summarise(with_metrics(record, *rows)).failures
    assert (found.scenario, found.run) == ("sphere", "")
    text = "attitude wrong by 9 rad (516 deg) on spun-again with semi-implicit"
    assert found.cost.startswith(text)


def test_what_fails_in_no_run_costs_nothing_there(record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "torque", "residual", 1.0)
    (found,) = summarise(with_metrics(record, {**row, "verdict": "fail"})).failures
    assert found.cost == "nothing in its trajectories, which pass"
    alone = record.metrics.filter(gate="equation")
    (found,) = summarise(
        with_metrics(replace(record, metrics=alone), {**row, "verdict": "fail"})
    ).failures
    assert found.cost == ""
    assert "Cost" not in found.sentence


def test_an_attitude_is_compared_with_those_of_its_order(record: Record) -> None:
    """Caught: a first-order engine whose error stands beside a range that begins at RK4's."""
    found = failing(record)
    assert summarise(found).failures[0].cost.endswith("of order 1: 0.024 rad (1.4 deg)")
    for engine in found.run["engines"]:
        for own in engine["integrators"] if engine["name"] == "mujoco" else ():
            own["orders"] = {"attitude": 4}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("of other orders: 1.9e-7 to 0.024 rad (1.1e-5 to 1.4 deg)")
    for engine in found.run["engines"]:
        for own in engine["integrators"]:
            own["orders"] = {}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("; sound integrators: 1.9e-7 to 0.024 rad (1.1e-5 to 1.4 deg)")


def test_an_error_that_sound_integrators_have_as_well_costs_nothing(record: Record) -> None:
    """Caught: "off by 2 rad" of a run that is a sound engine's to rounding."""
    (same,) = record.metrics.filter(
        engine="mujoco", scenario="sphere", integrator="Euler", timestep=0.005, metric="error_max"
    )["value"]
    text = (
        "nothing in the attitude on sphere: semi-implicit, step 0.005 s, has an error of 0.006 rad "
        "(0.34 deg) there, as sound integrators of order 1 have: 0.006 rad (0.34 deg)"
    )
    equal = {"value": same + 1.5e-9, "bound": 1e-9, "verdict": "info"}
    near = edited(record, ("sphere", "mujoco", "Euler", 0.005), FIGURE, bound=1e-9)
    for case in (failing_in_a_probe(record), failing_in_a_probe(near, **equal)):
        (found,) = summarise(case).failures
        assert found.cost == text
    beyond = {**equal, "value": same + 3e-9}  # more than both bounds
    (found,) = summarise(failing_in_a_probe(near, **beyond)).failures
    assert found.cost.startswith("attitude wrong by 0.006 rad (0.34 deg) on sphere")


def test_an_error_of_its_order_costs_nothing_where_no_other_has_that_order(record: Record) -> None:
    found = failing_in_a_probe(record)
    for engine in found.run["engines"]:
        for own in engine["integrators"] if engine["name"] == "mujoco" else ():
            own["orders"] = {"attitude": 4}
    (failure,) = summarise(found).failures
    assert failure.cost.startswith("nothing in the attitude on sphere")
    assert failure.cost.endswith("which passes as the truncation error of its order")
