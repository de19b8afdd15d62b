"""Axes that are not the scenario's, in sentences with the options that undo them."""

from __future__ import annotations

import numpy as np

from omegadot.commands.score.attitude import wxyz
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.own_units import factor_of
from omegadot.commands.score.world import Shifted, Turned, origin_given
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array
from omegadot.written import written


def axes_sentences(found: Judged) -> list[str]:
    """A world that is turned, that turns or that is shifted; a body whose axes or origin differ."""
    lines = [_turned(found, found.turned)] if found.turned else []
    if origin_given(found):
        lines.append("The positions are those of the body's origin: give --point origin.")
    elif found.shifted:
        lines.append(_shifted(found, found.shifted))
    return lines


def _numbers(values: Array) -> str:
    """As an option takes them, to ten digits."""
    return ",".join(written(value, 10) for value in values)


def _about(vector: Array) -> str:
    """``x``, ``-x`` or the unit vector that a rotation is about."""
    axis = vector / norm(vector)
    place = int(np.argmax(np.abs(axis)))
    if abs(axis[place]) > 1.0 - 1e-6:
        return ("-" if axis[place] < 0.0 else "") + "xyz"[place]
    return f"({_short(axis)})"


def _short(values: Array) -> str:
    return ", ".join(written(value, 4) for value in values)


def _turned(found: Judged, turned: Turned) -> str:
    from scipy.spatial.transform import Rotation

    factor, unit = factor_of(found, "attitude")
    late = found.shift is not None and found.shift.of == "omega" and found.shift.explains
    left = (
        f"the attitude is off by {written(factor * turned.before, 4)} {unit} without that and by "
        f"{written(factor * turned.after, 3)} {unit} with "
        f"it{' and the shift in time' if late else ''}"
    )
    how = found.reading.how
    if turned.kind in ("rate", "drift"):
        rate = turned.vector / how.scale_of("rate")
        changes = ", a rate that changes a little" if turned.kind == "drift" else ""
        if turned.unchanged is not None:  # which is all that can be declared
            alone = written(factor * turned.unchanged, 3)
            left += f", or by {alone} {unit} with the rate at the start alone"
        declared = how.world_rate @ how.world_axes.T  # as the sum of both is what to give
        whole = how.world_axes.T @ (turned.vector + declared) / how.scale_of("rate")
        return (
            f"The trace's world turns at {written(norm(rate), 4)} {how.rate_unit} about "
            f"{_about(turned.vector)}{changes}: {left}; give --world-rate={_numbers(whole)}."
        )
    turn = Rotation.from_rotvec(turned.vector)
    of, option = ("world", "--world-axes") if turned.kind == "world" else ("body", "--body-axes")
    own = Rotation.from_matrix(how.world_axes if of == "world" else how.body_axes)
    whole_turn = turn * own if of == "world" else turn.inv() * own
    return (
        f"The trace's {of} axes are turned by {written(factor * norm(turned.vector), 4)} {unit} "
        "about "
        f"{_about(turned.vector)}: {left}; give {option}={_numbers(wxyz(whole_turn))}."
    )


def _shifted(found: Judged, shifted: Shifted) -> str:
    factor, unit = factor_of(found, "position")
    how = found.reading.how
    origin = how.world_origin + how.world_axes.T @ shifted.offset
    return (
        f"The positions are shifted by ({_short(factor * shifted.offset)}) {unit}: they are off by "
        f"{written(factor * shifted.before, 4)} {unit} without that and by "
        f"{written(factor * shifted.after, 3)} {unit} with it; give "
        f"--world-origin={_numbers(factor * origin)}."
    )
