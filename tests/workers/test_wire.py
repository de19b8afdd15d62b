"""What goes into the channel comes out of it."""

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from omegadot.adapters.protocol import Description, Integrator
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System
from omegadot.workers.frame_reader import read_frame
from omegadot.workers.wire import description_of, encode_frame, system_from


def through(message: dict) -> dict:
    return read_frame(io.BytesIO(encode_frame(message)))


@settings(derandomize=True, max_examples=50, deadline=None)
@given(arrays(np.float64, array_shapes(min_dims=0, max_dims=3, min_side=0)), st.text())
def test_arrays_keep_shape_and_every_bit(array: np.ndarray, text: str) -> None:
    back = through({"a": [array, {"b": text}], "n": None})
    assert back["a"][0].shape == array.shape
    assert back["a"][0].tobytes() == array.tobytes()
    assert back["a"][1] == {"b": text}
    assert back["n"] is None


@pytest.mark.parametrize("pivot", [None, np.array([0.1, 0.2, 0.3])])
def test_systems_keep_their_shapes(pivot: np.ndarray | None) -> None:
    body = Body(np.array(2.0), np.array([0.1, 0.0, 0.0]), np.diag([1.0, 2.0, 3.0]))
    load = Load(pivot=pivot, damping=np.array(0.5))
    back = system_from(through({"system": System((body,), load)})["system"])
    assert back.body.mass.shape == ()
    assert back.load.damping.shape == ()
    np.testing.assert_array_equal(back.body.inertia, body.inertia)
    assert (back.load.pivot is None) == (pivot is None)


def test_states_and_accelerations_come_back() -> None:
    state = State(np.ones((5, 4)), np.ones((5, 3)), np.zeros((5, 3)), np.full((5, 3), np.nan))
    back = State(**through({"state": state})["state"])
    for name, values in vars(state).items():
        np.testing.assert_array_equal(getattr(back, name), values)
    found = Acceleration(**through({"a": Acceleration(np.ones(3), np.zeros(3))})["a"])
    np.testing.assert_array_equal(found.angular, np.ones(3))


def test_a_cut_channel_is_an_end_of_file() -> None:
    frame = encode_frame({"a": np.ones(10)})
    for length in (0, 4, 20, len(frame) - 1):
        with pytest.raises(EOFError):
            read_frame(io.BytesIO(frame[:length]))


def test_a_description_has_nothing_that_a_terminal_obeys() -> None:
    euler = Integrator("euler", None, {"omega": 1}, note="slow\x1b[31m")
    given = Description("engine", "1\x1b]0;title\x07", (euler,), conventions=("x\r\ny",))
    back = description_of(through(vars(given) | {"integrators": [vars(euler)], "features": []}))
    assert back.version == "1 ]0;title"
    assert back.integrators[0].note == "slow [31m"
    assert back.conventions == ("x y",)
