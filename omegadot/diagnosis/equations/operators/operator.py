"""What an operator is: one change of a vector, by mistake."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.system import Array, State


@dataclass(frozen=True)
class Seen:
    """What is known when a number is looked for, at states (n,).

    due: the right vectors.  came: the engine's, None where they are hidden.  sound: whether the
    engine is right.  bound: what rounding makes of its answer.
    """

    due: Array
    came: Array | None
    states: State
    sound: NDArray[np.bool_]
    bound: Array


@dataclass(frozen=True)
class Operator:
    """One change of a vector.

    change: of vectors (n, k) at states with numbers (p,).  text: with what it changes, its unit and
    the numbers.  guess: the numbers, nearly; None of an operator without any.  turns: it makes
    another vector of a constant one, too.  among: it depends on the other states of the request.
    rounds: it rounds.
    """

    change: Callable[[Array, State, Array], Array]
    text: Callable[[str, str, Array], str]
    guess: Callable[[Seen], Array | None] | None = None
    turns: bool = False
    among: bool = False
    rounds: bool = False
