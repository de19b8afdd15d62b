"""What engines on JAX share: many steps in one loop that XLA compiles, and states in batches.

A program is compiled for shapes, so that lengths are fixed here and runs are cut to them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

ROWS = 512  # samples a call of the loop: its cost vanishes, and memory does not grow with a run
STATES = 256  # at once: more are taken in several calls, as each number of them is a program


def logged_steps(
    jax: Any, step: Callable[[Any], Any], row_of: Callable[[Any], Any], start: Any, counts: Any
) -> tuple[Any, Any]:
    """ROWS rows, logged at each `every`-th step and the last, and what the last step hands on.

    To be traced. step: from what a step hands on to the next of it.  row_of: what is logged of it.
    counts: (steps, every), of which steps are at most ``ROWS * every``.
    """
    jnp, lax = jax.numpy, jax.lax
    steps, every = counts

    def sample(carry: Any) -> Any:
        count, done, state, rows = carry
        taken = jnp.minimum(every, steps - done)
        state = lax.fori_loop(0, taken, lambda _, one: step(one), state)
        return count + 1, done + taken, state, rows.at[count].set(row_of(state))

    row = jax.eval_shape(row_of, start)
    nothing = jnp.zeros_like(steps)
    _, _, last, rows = lax.while_loop(
        lambda carry: (carry[0] < ROWS) & (carry[1] < steps),
        sample,
        (nothing, nothing, start, jnp.zeros((ROWS, *row.shape), row.dtype)),
    )
    return rows, last


def rows_of_run(
    call: Callable[[Any, Any], tuple[Any, Any]], start: Any, steps: int, every: int
) -> list[Array]:
    """The rows of a run of any length. call: a compiled `logged_steps`, of start and counts."""
    most, found, state = ROWS * every, list[Array](), start
    for done in range(0, steps, most):
        left = min(most, steps - done)
        rows, state = call(state, (np.int32(left), np.int32(min(every, left))))
        found.append(np.asarray(rows)[: -(-left // every)])
    return found


def in_batches(call: Callable[..., Any], *columns: Array) -> Array:
    """Answers for n rows of each column, STATES at once; the last batch is filled with its end."""
    rows, found = len(columns[0]), []
    for first in range(0, rows, STATES):
        taken = np.minimum(np.arange(first, first + STATES), rows - 1)
        found.append(np.array(call(*(column[taken] for column in columns)), float))
    return np.concatenate(found)[:rows]
