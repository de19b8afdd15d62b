"""A law of sleep as text: which quantity is below a limit, for how many steps or how long."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.vanishing.rests import UNITS, between
from omegadot.diagnosis.stepping.vanishing.spells import MOST_IN_A_ROW
from omegadot.diagnosis.wording.digits import limits, number
from omegadot.reference_impl.system import Array


def worded(
    name: str,
    fits: NDArray[np.bool_],
    low: Array,
    high: Array,
    times: Array | None,
    more: str = "",
) -> str:
    """Of one quantity: fits, low and high (WAYS, N), by steps in a row or by these times in s.

    more: what else is below a limit meanwhile.

    Whether the given state is counted is said where nothing else holds.
    """
    fit = np.flatnonzero(fits.any(0))
    limit = between(float(np.min(low[fits])), float(np.max(high[fits])), UNITS[name])
    below = f"{name} is below a limit between {limit}{more}"
    if times is None:
        return below + _in_a_row(fit + 1, with_given=not fits[0].any())
    ends = np.append(0.0, times)  # each second stands for what is between its neighbours
    first, last = int(fit[0]), int(fit[-1])
    least, most = ends[first + first % 2], ends[last + 1 + (last + 1) % 2]
    if least == most:
        return f"{below} for {number(float(least))} s"
    return f"{below} for a time between {limits(float(least), float(most), 's')}"


def _in_a_row(counts: NDArray[np.intp], with_given: bool) -> str:
    least, most = int(counts[0]), int(counts[-1])
    if most == 1:
        return ""
    what = "states in a row, the given one among them" if with_given else "steps in a row"
    if most == MOST_IN_A_ROW:
        return f" in {least} or more {what}"
    return f" in {least if least == most else f'{least} to {most}'} {what}"
