"""Wrong equations by another inertia: held up to a least value, or with six numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families.family import Family, with_body
from omegadot.diagnosis.equations.families.six_numbers import (
    ALIKE_BY_PARTS,
    BASIS,
    six,
    tensor_of,
    torque_free,
)
from omegadot.diagnosis.wording.digits import number, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System
from omegadot.written import written


def _least(
    name: str,
    held: Callable[[Array, float], Array],
    what: str,
    where: str,
    parts: tuple[str, ...],
) -> Family:
    """A least value of the moments, or of the diagonal."""

    def form(right: Form, system: System, p: Array) -> Form:
        tensor = held(np.asarray(system.body.inertia, dtype=float), float(p[0]))
        other = form_of(with_body(system, inertia=tensor))
        return replace(right, **{part: getattr(other, part) for part in parts})

    def starts(system: System) -> list[Array]:
        values = np.sort(np.linalg.eigvalsh(np.asarray(system.body.inertia, dtype=float)))
        middle = [values[0] + k * (values[-1] - values[0]) for k in (0.25, 0.75)]
        return [np.array([value]) for value in (*middle, 2.0 * values[-1])]

    def text(system: System, p: Array) -> str:
        return f"{where}{what} is held above {number(float(p[0]))} kg m^2"

    return Family(name, "inertia", starts, form, text, lambda s: np.array([0.0]), "kg m^2")


def _least_moments(tensor: Array, least: float) -> Array:
    moments, axes = np.linalg.eigh(tensor)
    return np.asarray((axes * np.maximum(moments, least)) @ axes.T)


def _least_diagonal(tensor: Array, least: float) -> Array:
    kept = np.diag(tensor)
    return np.asarray(tensor + np.diag(np.maximum(kept, least) - kept))


LEAST = tuple(
    _least(f"{name}{at}", held, what, where, parts)
    for at, where, parts in (
        ("", "in the dynamics, ", ("solve", "spin")),
        (" in the solve", "where omega-dot is solved for, ", ("solve",)),
        (" in the spin", "in the gyroscopic term, ", ("spin",)),
    )
    for name, held, what in (
        ("least moment", _least_moments, "every principal moment of inertia"),
        ("least diagonal", _least_diagonal, "the diagonal of the inertia"),
    )
)


def _of_momentum_balance(evidence: Evidence) -> Array | None:
    """The tensor J of ``J omega-dot + omega x J omega = torque``, which is linear in it.

    Without a torque it is known up to a factor alone, and is as large as the requested one.
    """
    system, states = evidence.system, evidence.states
    w, rate = states.angular_velocity, evidence.found.angular
    due = torque(system, states)
    lines = np.stack([apply(b, rate) + cross(w, apply(b, w)) for b in BASIS], axis=-1)
    if not np.isfinite(lines).all():
        return None
    size = (norm(rate) + norm(w) ** 2)[:, None]
    size = np.where(size > 0.0, size, np.inf)  # at rest nothing shows
    matrix, right = (lines / size[..., None]).reshape(-1, 6), np.ravel(due / size)
    if np.any(right):
        found = np.linalg.lstsq(matrix, right, rcond=None)[0]
    else:
        found = np.linalg.svd(matrix, full_matrices=False)[2][-1]
        found = found * float(np.trace(moving_inertia(system)) / np.trace(tensor_of(found)))
    good = np.all(np.isfinite(found)) and np.linalg.eigvalsh(tensor_of(found))[0] > 0.0
    return found if good else None


def tensor_of_balance(evidence: Evidence, parts: tuple[str, ...]) -> Array | None:
    """The tensor that moves a body under a torque, (3, 3); None where nothing shows it.

    parts: where it stands: in ``J omega-dot`` ("solve") alone, or in ``omega x J omega`` as well.
    """
    system, states = evidence.system, evidence.states
    w, rate = states.angular_velocity, evidence.found.angular
    due = torque(system, states)
    if not np.any(due):
        return None  # known up to a factor alone
    if "spin" in parts:
        lines = np.stack([apply(b, rate) + cross(w, apply(b, w)) for b in BASIS], axis=-1)
    else:
        lines = np.stack([apply(b, rate) for b in BASIS], axis=-1)
        due = due - cross(w, apply(moving_inertia(system), w))
    size = norm(rate) + norm(w) ** 2
    size = np.where(size > 0.0, size, np.inf)[:, None]
    found = np.linalg.lstsq((lines / size[..., None]).reshape(-1, 6), np.ravel(due / size), None)[0]
    return tensor_of(found) if np.all(np.isfinite(found)) else None


def scale_of_inertia(evidence: Evidence) -> Array | None:
    """The factor of the inertia about the centre of mass, (1,), from the momentum balance.

    ``k (I omega-dot + omega x I omega) = torque - (J omega-dot + omega x J omega)``, with J what
    the parallel-axis theorem adds.
    """
    system, states = evidence.system, evidence.states
    w, rate = states.angular_velocity, evidence.found.angular
    own = np.asarray(system.body.inertia, dtype=float)
    added = np.asarray(moving_inertia(system), dtype=float) - own
    size = (norm(rate) + norm(w) ** 2)[:, None]
    size = np.where(size > 0.0, size, np.inf)  # at rest nothing shows
    line, rest = (
        np.ravel((apply(one, rate) + cross(w, apply(one, w))) / size) for one in (own, added)
    )
    whole = float(line @ line)
    right = np.ravel(torque(system, states) / size) - rest
    if not (whole > 0.0 and np.isfinite(whole) and np.any(right)):
        return None
    return np.array([float(line @ right) / whole])


def _inertia_family(name: str, where: str, parts: tuple[str, ...]) -> Family:
    def form(right: Form, system: System, p: Array) -> Form:
        tensor = tensor_of(p)
        if not np.linalg.eigvalsh(tensor)[0] > 0.0:
            raise ValueError("no inertia of a body")
        made = {"solve": np.linalg.inv(tensor), "spin": tensor}
        return replace(right, **{one: made[one] for one in parts})

    def text(system: System, p: Array) -> str:
        requested, tensor = np.asarray(moving_inertia(system), dtype=float), tensor_of(p)
        if parts == ("spin",):  # of which a part like the unit matrix makes no torque
            tensor = tensor + np.trace(requested - tensor) / 3.0 * np.eye(3)
        off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
        rows = "; ".join(vector(row, own) for row, own in zip(tensor, requested, strict=True))
        about = "" if system.load.pivot is None else " about the pivot"
        if torque_free(system) and len(parts) > 1:
            ratio = np.diag(requested) / np.diag(tensor)
            tensor = float(np.median(ratio)) * tensor
            off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
            rows = "; ".join(vector(a, b) for a, b in zip(tensor, requested, strict=True))
            about = " up to a factor, which no torque shows,"
        return f"{where} another inertia, {written(100 * off, 2)} % off:{about} {rows} kg m^2"

    return Family(
        name,
        "inertia",
        lambda s: [six(moving_inertia(s))],
        form,
        text,
        lambda s: six(moving_inertia(s)),
        "kg m^2",
        guess=_of_momentum_balance if len(parts) > 1 else None,
        alike=ALIKE_BY_PARTS[parts],
    )


SIX_NUMBERS = (
    _inertia_family("inertia", "the dynamics are those of", ("solve", "spin")),
    _inertia_family("inverse", "omega-dot is solved for with", ("solve",)),
    _inertia_family("spin inertia", "the gyroscopic term is formed with", ("spin",)),
)
