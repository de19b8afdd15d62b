"""Six numbers that stand for the inertia: what they have to do with the requested one."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from omegadot.diagnosis.equations.families.family import driven
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System

ALIKE = 1e-6  # of the inertia: as well as its fitted numbers are known

_I, _J = np.triu_indices(3)
BASIS = np.zeros((6, 3, 3))
BASIS[range(6), _I, _J] = BASIS[range(6), _J, _I] = 1.0


def torque_free(system: System) -> bool:
    """Whether nothing acts on a free body."""
    load = system.load
    return not (driven(system) or float(load.damping) or load.pivot is not None)


def six(tensor: Array) -> Array:
    """Those of a symmetric tensor, (6,)."""
    return np.asarray(tensor, dtype=float)[_I, _J]


def tensor_of(p: Array) -> Array:
    """The tensor with these six, (3, 3)."""
    return np.tensordot(p, BASIS, 1)


def _alike(pairs: Sequence[tuple[System, Array]]) -> str:
    """What is right of the tensors of all scenarios, or by what they all differ."""
    tensors = [_next_to_requested(system, tensor_of(p)) for system, p in pairs]

    def all_are(same: Callable[[Array, Array], Array]) -> bool:
        return all(
            bool(np.all(np.abs(same(*pair)) <= ALIKE * np.linalg.norm(pair[0]))) for pair in tensors
        )

    if all_are(lambda due, own: np.linalg.eigvalsh(own) - np.linalg.eigvalsh(due)):
        return "its moments about the centre of mass are the requested ones, about other axes"
    if all_are(lambda due, own: own - due - np.trace(own - due) / 3.0 * np.eye(3)):
        return "every moment is off by the same amount"
    return _of_numbers(tensors)


def _alike_in_spin(pairs: Sequence[tuple[System, Array]]) -> str:
    """The same of a tensor that is known up to a part like the unit matrix."""
    return _of_numbers([_spin_next_to_requested(system, tensor_of(p)) for system, p in pairs])


def _of_numbers(tensors: Sequence[tuple[Array, Array]]) -> str:
    """Which numbers of a tensor are right, or none: of pairs, the requested and the engine's."""

    def small(due: Array, left: Array) -> bool:
        return bool(np.all(np.abs(left) <= ALIKE * np.linalg.norm(due)))

    off, texts = ~np.eye(3, dtype=bool), list[str]()
    if all(small(due, (own - due)[off]) for due, own in tensors):
        texts.append("its products are the requested ones")
    elif all(small(due, own[off]) for due, own in tensors):
        texts.append("its products are zero")
    wrong = [[not small(due, (own - due)[k, k]) for k in range(3)] for due, own in tensors]
    several = [k for k in range(3) if any(one[k] for one in wrong)]
    if not several:
        texts.append("its diagonal is the requested one")
    elif len(several) == 1:
        texts.append(f"of its diagonal {2 * 'xyz'[several[0]]} alone is another")
    for i, j in ((0, 1), (0, 2), (1, 2)):
        equal = all(small(due, own[i, i] - own[j, j]) for due, own in tensors)
        if equal and not all(small(due, due[i, i] - due[j, j]) for due, _ in tensors):
            texts.append(f"its moments {2 * 'xyz'[i]} and {2 * 'xyz'[j]} are equal")
    return ", and ".join(texts)


def _spin_next_to_requested(system: System, tensor: Array) -> tuple[Array, Array]:
    """The requested inertia that moves and the engine's, with the part that no torque shows.

    It is chosen so that most of the diagonal is the requested one; the trace, where it is no more.
    """
    due = np.asarray(moving_inertia(system), dtype=float)
    more = np.diag(due - tensor)
    ways = [tensor + k * np.eye(3) for k in (*more, float(np.mean(more)))]
    close = [np.abs(np.diag(one - due)) <= ALIKE * np.linalg.norm(due) for one in ways]
    counts = [np.count_nonzero(one) for one in close]
    return due, ways[int(np.argmax(counts)) if max(counts) > 1 else 3]


def _next_to_requested(system: System, tensor: Array) -> tuple[Array, Array]:
    """The requested tensor about the centre of mass and the engine's.

    Without a torque it is known up to a factor, and the one that suits them is taken.
    """
    due = np.asarray(system.body.inertia, dtype=float)
    if not torque_free(system):
        return due, tensor - (np.asarray(moving_inertia(system), dtype=float) - due)
    ways = np.stack([tensor.ravel(), np.eye(3).ravel()], axis=-1)
    factor, amount = np.linalg.lstsq(ways, due.ravel(), rcond=None)[0]
    left = factor * tensor + amount * np.eye(3) - due
    if np.all(np.abs(left) <= ALIKE * np.linalg.norm(due)):
        return due, factor * tensor
    return due, tensor * float(np.trace(due) / np.trace(tensor))


def _alike_in_solve(pairs: Sequence[tuple[System, Array]]) -> str:
    """The same of the tensor that omega-dot is solved for with."""
    return _of_numbers(
        [(np.asarray(moving_inertia(s), dtype=float), tensor_of(p)) for s, p in pairs]
    )


ALIKE_BY_PARTS: dict[tuple[str, ...], Callable[[Sequence[tuple[System, Array]]], str]] = {
    ("solve", "spin"): _alike,
    ("solve",): _alike_in_solve,
    ("spin",): _alike_in_spin,
}
