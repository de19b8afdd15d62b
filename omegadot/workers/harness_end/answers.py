"""A frame in the channel of answers, held to what was requested.

An engine has the channel in its own process and may write to it. What a worker answers has been
checked there (`engine_end.checked`); whatever else comes is no answer, and ends the worker.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.engine_end.checked import (
    AnswerError,
    checked,
    checked_bodies,
    checked_native,
    expect,
    numbers,
)
from omegadot.workers.engine_end.described import checked_description
from omegadot.workers.wire import body_from, description_of

Fields = Mapping[str, Any]
KEYS = {"outcome", "reason", "result", "seconds", "leaves"}
OUTCOMES = ("ok", "unsupported", "not-installed", "raised", "crashed")


class FrameError(ValueError):
    """A frame that is no answer to the request; the message states why."""


def answer_in(frame: Any, operation: str, fields: Fields) -> dict[str, Any]:
    """The answer that a frame holds, for a request of this operation with these fields.

    Raises FrameError.
    """
    try:
        expect("it", frame, dict)
        if unknown := sorted(map(str, frame.keys() - KEYS)):
            raise FrameError(f"it has the key {unknown[0]!r}")
        if frame.get("outcome") not in OUTCOMES:
            raise FrameError(f"its outcome is {frame.get('outcome')!r}")
        expect("its reason", frame.get("reason", ""), str)
        if frame["outcome"] == "ok":
            _RESULTS[operation](frame.get("result"), fields)
    except AnswerError as error:
        raise FrameError(str(error)) from error
    except FrameError:
        raise
    except (TypeError, ValueError, KeyError, AttributeError, IndexError) as error:
        raise FrameError(f"{type(error).__name__}: {error}") from error
    return dict(frame)


def _lead(states: State) -> tuple[int, ...]:
    return states.angular_velocity.shape[:-1]


def _description(found: Any, _: Fields) -> None:
    checked_description(description_of(found))


def _model(found: Any, fields: Fields) -> None:
    checked_bodies(tuple(map(body_from, found["bodies"])), 1)
    checked("the state", State(**found["state"]), State, _lead(fields["state"]))


def _forward(found: Any, fields: Fields) -> None:
    checked("the acceleration", Acceleration(**found), Acceleration, _lead(fields["states"]))


def _inverse(found: Any, fields: Fields) -> None:
    numbers("the torque", found["torque"], (*_lead(fields["states"]), 3))


def _replay(found: Any, _: Fields) -> None:
    count = len(found["time"])
    numbers("time", found["time"], (count,))
    checked("the state", State(**found["state"]), State, (count,))


def _run(found: Any, fields: Fields) -> None:
    _replay(found, fields)
    numbers("omega_dot", found["omega_dot"], (len(found["time"]), 3))
    pace = float(numbers("seconds_per_step", found["seconds_per_step"], ()))
    if not 0.0 < pace < np.inf:
        raise FrameError(f"its seconds_per_step is {pace}")


def _first_steps(found: Any, fields: Fields) -> None:
    checked("the states", State(**found), State, np.shape(fields["timesteps"]))


def _native(found: Any, _: Fields) -> None:
    checked_native(found)


def _memory(found: Any, _: Fields) -> None:
    expect("the memory", found, int | None)  # type: ignore[arg-type]


def _own(_: Any, __: Fields) -> None:
    """Of workers without an engine."""


_RESULTS: dict[str, Callable[[Any, Fields], None]] = {
    "start": _description,
    "load": _description,
    "native": _native,
    "memory": _memory,
    "model": _model,
    "forward": _forward,
    "inverse": _inverse,
    "run": _run,
    "replay": _replay,
    "first_steps": _first_steps,
    "solve": _own,
    "companion": _own,
}
