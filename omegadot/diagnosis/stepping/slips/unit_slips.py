"""Steps on the quaternion's own equation that make it unit in another way, or not at all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import Step
from omegadot.reference_impl.system import Array


def _by_vector_part(q: Array) -> Array:
    """``(+-sqrt(1 - |v|^2), v)`` with its own sign; divided by its length where v is too long."""
    left = 1.0 - np.sum(q[..., 1:] ** 2, axis=-1, keepdims=True)
    scalar = np.copysign(np.sqrt(np.maximum(left, 0.0)), q[..., :1])
    return np.where(left > 0.0, np.concatenate((scalar, q[..., 1:]), axis=-1), normalize(q))


def _by_square(q: Array) -> Array:
    return np.asarray(q / (norm(q) ** 2)[..., None])


WAYS: dict[str, Callable[[Array], Array]] = {
    "the quaternion's scalar part is made of its vector part, sqrt(1 - |v|^2), not normalised": (
        _by_vector_part
    ),
    "the quaternion is divided by the square of its length": _by_square,
    "the quaternion is not normalised": lambda q: q,
}


def unit_slips(step: Step) -> dict[str, Step]:
    """A step on the quaternion with each of these ways at its end; its stages are as they were."""
    return {text: _ending(step, way) for text, way in WAYS.items()}


def _ending(step: Step, way: Callable[[Array], Array]) -> Step:
    def ended(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        def acceleration(at: Array, speed: Array) -> Array:
            return motion.acceleration(motion.normalize(at), speed)

        bare = replace(motion, normalize=lambda at: at, acceleration=acceleration)
        q, v = step(bare, q, v, h)
        return np.concatenate((q[..., :-4], way(q[..., -4:])), axis=-1), v

    return ended
