"""Where an equation has the inertia: in the solve, in the gyroscopic term or in both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System


@dataclass(frozen=True)
class Place:
    """text: where the tensor is used.  parts: of the equation.  moving: the whole inertia is
    changed, of a pivoted body that about the pivot.
    """

    text: str
    parts: tuple[str, ...]
    moving: bool

    def requested(self, system: System) -> Array:
        """The tensor that is used there, (3, 3)."""
        used = moving_inertia(system) if self.moving else system.body.inertia
        return np.asarray(used, dtype=float)

    def form(self, right: Form, system: System, tensor: Array) -> Form | None:
        """The equation with another tensor there; None of one that no body has."""
        whole = np.asarray(moving_inertia(system), dtype=float)
        made = tensor if self.moving else whole + tensor - np.asarray(system.body.inertia)
        if not np.linalg.eigvalsh(made)[0] > 0.0:
            return None
        parts: dict[str, Callable[[], Array]] = {
            "solve": lambda: np.linalg.inv(made),
            "spin": lambda: made,
        }
        return replace(right, **{name: parts[name]() for name in self.parts})


PLACES = tuple(
    Place(text, parts, moving)
    for moving in (False, True)
    for text, parts in (
        ("in the dynamics", ("solve", "spin")),
        ("where omega-dot is solved for", ("solve",)),
        ("in the gyroscopic term", ("spin",)),
    )
)
