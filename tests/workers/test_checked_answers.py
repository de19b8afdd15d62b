"""Answers that are not of the protocol's types and shapes do not leave the worker."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.reference_impl.system import Acceleration, Body, State
from omegadot.workers.engine_end.checked import (
    AnswerError,
    checked,
    checked_bodies,
    checked_seconds,
    checked_trajectory,
    numbers,
)
from omegadot.workers.engine_end.described import checked_description, description_of
from omegadot.workers.engine_end.operations import OPERATIONS
from omegadot.workers.engine_end.worker import failure
from omegadot.workers.wire import one_line

EULER = Integrator("euler", "semi-implicit-euler", {"omega": 1, "energy": None})
SPATIAL = replace(EULER, coordinates="body-spatial")
ENGINE = Description("engine", "1.0", (EULER,), features=frozenset({"free"}))
BODY = Body(np.array(1.0), np.zeros(3), np.eye(3))


def state(*lead: int) -> State:
    return State(np.ones((*lead, 4)), np.ones((*lead, 3)), np.ones((*lead, 3)), np.ones((*lead, 3)))


def test_what_is_right_passes_as_it_is() -> None:
    assert checked_description(ENGINE) is ENGINE
    assert checked("state", state(), State, ()).orientation.shape == (4,)
    assert checked_trajectory(Trajectory(np.arange(5.0), state(5))).time.shape == (5,)
    pair = Acceleration(np.ones((2, 3)), np.ones((2, 3)))
    assert checked("forward_dynamics()", pair, Acceleration, (2,)).linear.all()
    assert numbers("torque", np.ones((2, 3)), (2, 3)).shape == (2, 3)
    assert checked_bodies((Body(1.0, [0, 0, 0], np.eye(3)),), 1)[0].mass == 1.0  # type: ignore[arg-type]


class WithSteps:
    """An adapter without the parameter."""

    description = replace(ENGINE, integrators=(replace(EULER, scheme=None, knob="accuracy"),))

    def run(self, *_: Any) -> None: ...


class WithAccuracy(WithSteps):
    def run(self, *_: Any, accuracy: float | None = None) -> None: ...


class WithAnything(WithSteps):
    def run(self, *_: Any, **__: Any) -> None: ...


@pytest.mark.parametrize(
    ("adapter", "knob"),
    [(WithSteps, "fixed-accuracy"), (WithAccuracy, "accuracy"), (WithAnything, "accuracy")],
)
def test_an_accuracy_that_a_run_does_not_take_is_fixed(adapter: Any, knob: str) -> None:
    (found,) = description_of(adapter()).integrators
    assert found.knob == knob
    assert found.finest_accuracy == 0.0


def test_single_precision_bounds_the_accuracies() -> None:
    class Single(WithAccuracy):
        description = replace(WithAccuracy.description, precision="float32")

    (found,) = description_of(Single()).integrators  # type: ignore[arg-type]
    assert found.finest_accuracy == 450 * 2.0**-23


def test_a_run_costs_what_the_adapter_measured_or_else_the_whole_call() -> None:
    assert checked_seconds(None, 2.0) == 2.0
    assert checked_seconds(np.float64(0.5), 2.0) == 0.5
    assert checked_trajectory(Trajectory(np.arange(5.0), state(5), 0.5)).seconds == 0.5


@pytest.mark.parametrize("seconds", [0.0, 0, 5e-324, 1e-12])
def test_less_than_a_tick_is_nothing_measured(seconds: float) -> None:
    """Caught: a pace of nothing, which speeds and budgets are then divided by."""
    assert checked_seconds(seconds, 2.0) == 2.0
    assert 0.0 < checked_seconds(None, 0.0) < 1e-3


@pytest.mark.parametrize("seconds", [-1.0, 2.5, np.nan, np.inf, "0.5", np.ones(2)])
def test_the_steps_of_a_run_took_a_part_of_the_call(seconds: Any) -> None:
    with pytest.raises(AnswerError, match=r"run\(\)\.seconds"):
        checked_seconds(seconds, 2.0)


def test_single_precision_and_whole_numbers_are_numbers() -> None:
    found = numbers("torque", np.ones((2, 3), np.float32), (2, 3))
    assert found.dtype == float
    assert numbers("torque", np.ones((2, 3), int), (2, 3)).dtype == float


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "is NoneType; answer with an array of real numbers"),
        (np.ones(3), r"has the shape \(3,\); answer with \(2, 3\)"),
        (np.ones((2, 3), complex), "is an array of complex128"),
        (np.ones((2, 3), bool), "is an array of bool"),
        ([[1.0], [1.0, 2.0]], "is no array"),
    ],
)
def test_torques_of_two_states_are_two(value: Any, text: str) -> None:
    with pytest.raises(AnswerError, match=text):
        numbers("torque", value, (2, 3))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.ones((2, 3)), "is of type ndarray"),
        (Acceleration(np.ones((2, 3)), np.ones((1, 3))), "linear has the"),
        (Acceleration(np.ones((1, 3)), np.ones((2, 3))), "angular has the"),
    ],
)
def test_accelerations_of_two_states_are_two(value: Any, text: str) -> None:
    with pytest.raises(AnswerError, match=text):
        checked("forward_dynamics()", value, Acceleration, (2,))


@pytest.mark.parametrize("field", list(vars(state())))
def test_every_field_of_a_state_is_checked(field: str) -> None:
    with pytest.raises(AnswerError, match=f"state.{field} has the shape"):
        checked("state", replace(state(2), **{field: np.ones((2, 5))}), State, (2,))


@pytest.mark.parametrize(
    ("bodies", "text"),
    [
        ([BODY], "is of type list"),
        ((), "has 0 bodies; answer with 1"),
        ((BODY, BODY), "has 2 bodies; answer with 1"),
        ((None,), "is of type NoneType"),
        ((replace(BODY, mass=np.ones(1)),), "mass has the shape"),
        ((replace(BODY, center_of_mass=np.ones(2)),), "center_of_mass has the shape"),
        ((replace(BODY, inertia=np.ones(3)),), "inertia has the shape"),
    ],
)
def test_as_many_bodies_as_were_loaded(bodies: Any, text: str) -> None:
    with pytest.raises(AnswerError, match=text):
        checked_bodies(bodies, 1)


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"name": None}, "description.name is of type NoneType"),
        ({"version": (1, 0)}, "description.version is of type tuple"),
        ({"precision": "float16"}, "write float64 or float32"),
        ({"features": frozenset({1})}, "an item of description.features"),
        ({"integrators": ("euler",)}, "an item of description.integrators"),
        ({"integrators": (EULER, EULER)}, "has a name twice, of euler, euler"),
        ({"integrators": (replace(EULER, name=1),)}, "an integrator's name"),
        ({"integrators": (replace(EULER, name=""),)}, "is ''; give one short line"),
        ({"integrators": (replace(EULER, name="a\x1b[31m"),)}, "that can be printed"),
        ({"integrators": (replace(EULER, knob="step"),)}, "is 'step'; give one of timestep, acc"),
        ({"integrators": (replace(EULER, finest_accuracy=2),)}, "is 2; give a number from 0 to 1"),
        ({"integrators": (replace(EULER, finest_accuracy="x"),)}, "the finest accuracy of euler"),
        ({"integrators": (replace(EULER, scheme=1),)}, "the scheme of euler"),
        ({"integrators": (replace(EULER, scheme="mine"),)}, "which the reference lacks; give None"),
        (
            {"integrators": (replace(EULER, scheme="midpoint"),)},
            "which the reference lacks; it is known to omegadot score only; declare None",
        ),
        (
            {"integrators": (replace(EULER, knob="accuracy"),)},
            "of an error-controlled integrator are no scheme's",
        ),
        (
            {"integrators": (replace(SPATIAL, scheme="munthe-kaas-rk4"),)},
            "in which the reference does not step it; give one of com-world, origin-world, or",
        ),
        ({"integrators": (replace(EULER, orders={"omega": -3}),)}, "in omega is -3; give a whole"),
        ({"integrators": (replace(EULER, orders={"omega": 0}),)}, "in omega is 0; give a whole"),
        (
            {"integrators": (replace(EULER, coordinates="body"),)},
            "of euler are 'body'; give one of",
        ),
        ({"integrators": (replace(EULER, orders={"speed": 1}),)}, "'speed'; give one of omega, at"),
        ({"integrators": (replace(EULER, orders={"omega": 1.5}),)}, "the order of euler in omega"),
        ({"integrators": (replace(EULER, orders={"omega": True}),)}, "is True; give a whole"),
        ({"integrators": (replace(EULER, orders={"omega": 54}),)}, "is 54; give a whole .* to 53"),
        ({"integrators": (replace(EULER, orders={"omega": 10**5000}),)}, "is of many digits; give"),
        ({"integrators": (replace(EULER, orders=["omega"]),)}, "orders of euler is of type list"),
        ({"integrators": (replace(EULER, note=5),)}, "note of euler is of type int"),
        ({"integrators": (replace(EULER, one_step="no"),)}, "one_step of euler is of type str"),
        ({"integrators": None}, "description.integrators is of type NoneType"),
        ({"conventions": "body axes"}, "description.conventions is of type str"),
        ({"links": "https://"}, "description.links is of type str"),
        ({"features": "free"}, "description.features is of type str"),
        ({"features": frozenset({"teleport"})}, "names 'teleport'; give one of free, pivot, grav"),
        ({"settings": ("damping", "damping")}, "description.settings names 'damping'"),
        ({"settings": ("",)}, "description.settings names ''"),
        ({"importers": ("sdf",)}, "description.importers names 'sdf'; give one of urdf, mjcf"),
    ],
)
def test_a_description_is_checked(fields: dict[str, Any], text: str) -> None:
    with pytest.raises(AnswerError, match=text):
        checked_description(replace(ENGINE, **fields))


@pytest.mark.parametrize(
    ("operation", "method", "fields"),
    [
        ("forward", "forward_dynamics", {}),
        ("inverse", "inverse_dynamics", {"acceleration": {"angular": 0.0, "linear": 0.0}}),
    ],
)
def test_a_feature_without_its_method_is_named(
    operation: str, method: str, fields: dict[str, Any]
) -> None:
    """Caught: an AttributeError with a line of omegadot's own."""
    request = {"states": vars(state(2)), **fields}
    adapter: Any = WithSteps()
    with pytest.raises(AnswerError) as caught:
        OPERATIONS[operation](adapter, request)
    sentence = (
        f"description.features names '{method}', and the adapter has no method {method}(); write "
        "the method, or leave the feature out"
    )
    assert failure(caught.value)["reason"] == sentence


def test_texts_become_one_printable_line() -> None:
    assert one_line("two\nlines\tand  \x1b\x00 spaces\ud800") == "two lines and spaces"
    assert one_line("a" * 500) == "a" * 500
    assert one_line("a" * 501) == "a" * 496 + " ..."
    assert one_line("\n" * 10_000_000 + "late") == " ..."
    assert one_line("") == ""


def raised(error: BaseException) -> str:
    try:
        raise error
    except BaseException as caught:
        return str(failure(caught)["reason"])


def test_a_failure_names_its_type_and_line(monkeypatch: pytest.MonkeyPatch) -> None:
    assert raised(ValueError("no")).startswith("ValueError: no (test_checked_answers.py:")
    assert raised(UnsupportedError("no pivot")) == "no pivot"
    assert raised(UnsupportedError(" ")).startswith("the adapter states no reason")
    assert raised(KeyboardInterrupt()).startswith("KeyboardInterrupt (test_checked_answers.py:")
    monkeypatch.setenv("OMEGADOT_WORKER_MEMORY", str(2**31))
    assert raised(MemoryError()).endswith("the limit is 2 GiB, omegadot run --memory sets another")
