"""Wrong equations by another inertia: held up to a least value, or with six numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families.family import Family, driven, with_body
from omegadot.diagnosis.wording.digits import number, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System
from omegadot.scenarios.written import written

ALIKE = 1e-6  # of the inertia: as well as its fitted numbers are known


def _least(name: str, held: Callable[[Array, float], Array], what: str) -> Family:
    """A least value of the moments, or of the diagonal."""

    def form(right: Form, system: System, p: Array) -> Form:
        tensor = held(np.asarray(system.body.inertia, dtype=float), float(p[0]))
        return form_of(with_body(system, inertia=tensor))

    def starts(system: System) -> list[Array]:
        values = np.sort(np.linalg.eigvalsh(np.asarray(system.body.inertia, dtype=float)))
        middle = [values[0] + k * (values[-1] - values[0]) for k in (0.25, 0.75)]
        return [np.array([value]) for value in (*middle, 2.0 * values[-1])]

    def text(system: System, p: Array) -> str:
        return f"{what} is held above {number(float(p[0]))} kg m^2"

    return Family(name, "inertia", starts, form, text, lambda s: np.array([0.0]), "kg m^2")


def _least_moments(tensor: Array, least: float) -> Array:
    moments, axes = np.linalg.eigh(tensor)
    return np.asarray((axes * np.maximum(moments, least)) @ axes.T)


def _least_diagonal(tensor: Array, least: float) -> Array:
    kept = np.diag(tensor)
    return np.asarray(tensor + np.diag(np.maximum(kept, least) - kept))


LEAST = (
    _least("least moment", _least_moments, "every principal moment of inertia"),
    _least("least diagonal", _least_diagonal, "the diagonal of the inertia"),
)


_I, _J = np.triu_indices(3)
_BASIS = np.zeros((6, 3, 3))
_BASIS[range(6), _I, _J] = _BASIS[range(6), _J, _I] = 1.0


def _torque_free(system: System) -> bool:
    load = system.load
    return not (driven(system) or float(load.damping) or load.pivot is not None)


def _six(tensor: Array) -> Array:
    return np.asarray(tensor, dtype=float)[_I, _J]


def _tensor(p: Array) -> Array:
    return np.tensordot(p, _BASIS, 1)


def _of_momentum_balance(evidence: Evidence) -> Array | None:
    """The tensor J of ``J omega-dot + omega x J omega = torque``, which is linear in it.

    Without a torque it is known up to a factor alone, and is as large as the requested one.
    """
    system, states = evidence.system, evidence.states
    w, rate = states.angular_velocity, evidence.found.angular
    due = torque(system, states)
    lines = np.stack([apply(b, rate) + cross(w, apply(b, w)) for b in _BASIS], axis=-1)
    if not np.isfinite(lines).all():
        return None
    size = (norm(rate) + norm(w) ** 2)[:, None]
    size = np.where(size > 0.0, size, np.inf)  # at rest nothing shows
    matrix, right = (lines / size[..., None]).reshape(-1, 6), np.ravel(due / size)
    if np.any(right):
        found = np.linalg.lstsq(matrix, right, rcond=None)[0]
    else:
        found = np.linalg.svd(matrix, full_matrices=False)[2][-1]
        found = found * float(np.trace(moving_inertia(system)) / np.trace(_tensor(found)))
    good = np.all(np.isfinite(found)) and np.linalg.eigvalsh(_tensor(found))[0] > 0.0
    return found if good else None


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


def _alike(pairs: Sequence[tuple[System, Array]]) -> str:
    """What is right of the tensors of all scenarios, or by what they all differ."""
    tensors = [_next_to_requested(system, _tensor(p)) for system, p in pairs]

    def all_are(same: Callable[[Array, Array], Array]) -> bool:
        return all(
            bool(np.all(np.abs(same(*pair)) <= ALIKE * np.linalg.norm(pair[0]))) for pair in tensors
        )

    off = ~np.eye(3, dtype=bool)
    if all_are(lambda due, own: np.linalg.eigvalsh(own) - np.linalg.eigvalsh(due)):
        return "its moments about the centre of mass are the requested ones, about other axes"
    if all_are(lambda due, own: own - due - np.trace(own - due) / 3.0 * np.eye(3)):
        return "every moment is off by the same amount"
    if all_are(lambda due, own: (own - due)[off]):
        return "its products are the requested ones"
    if all_are(lambda due, own: np.diag(own - due)):
        return "its diagonal is the requested one"
    return ""


def _next_to_requested(system: System, tensor: Array) -> tuple[Array, Array]:
    """The requested tensor about the centre of mass and the engine's.

    Without a torque it is known up to a factor, and the one that suits them is taken.
    """
    due = np.asarray(system.body.inertia, dtype=float)
    if not _torque_free(system):
        return due, tensor - (np.asarray(moving_inertia(system), dtype=float) - due)
    ways = np.stack([tensor.ravel(), np.eye(3).ravel()], axis=-1)
    factor, amount = np.linalg.lstsq(ways, due.ravel(), rcond=None)[0]
    left = factor * tensor + amount * np.eye(3) - due
    if np.all(np.abs(left) <= ALIKE * np.linalg.norm(due)):
        return due, factor * tensor
    return due, tensor * float(np.trace(due) / np.trace(tensor))


def _inertia_family(name: str, where: str, parts: tuple[str, ...]) -> Family:
    def form(right: Form, system: System, p: Array) -> Form:
        tensor = _tensor(p)
        if not np.linalg.eigvalsh(tensor)[0] > 0.0:
            raise ValueError("no inertia of a body")
        made = {"solve": np.linalg.inv(tensor), "spin": tensor}
        return replace(right, **{one: made[one] for one in parts})

    def text(system: System, p: Array) -> str:
        requested, tensor = np.asarray(moving_inertia(system), dtype=float), _tensor(p)
        if parts == ("spin",):  # of which a part like the unit matrix makes no torque
            tensor = tensor + np.trace(requested - tensor) / 3.0 * np.eye(3)
        off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
        rows = "; ".join(vector(row, own) for row, own in zip(tensor, requested, strict=True))
        about = "" if system.load.pivot is None else " about the pivot"
        if _torque_free(system) and len(parts) > 1:
            ratio = np.diag(requested) / np.diag(tensor)
            tensor = float(np.median(ratio)) * tensor
            off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
            rows = "; ".join(vector(a, b) for a, b in zip(tensor, requested, strict=True))
            about = " up to a factor, which no torque shows,"
        return f"{where} another inertia, {written(100 * off, 2)} % off:{about} {rows} kg m^2"

    return Family(
        name,
        "inertia",
        lambda s: [_six(moving_inertia(s))],
        form,
        text,
        lambda s: _six(moving_inertia(s)),
        "kg m^2",
        guess=_of_momentum_balance if len(parts) > 1 else None,
        alike=_alike if len(parts) > 1 else lambda pairs: "",
    )


SIX_NUMBERS = (
    _inertia_family("inertia", "the dynamics are those of", ("solve", "spin")),
    _inertia_family("inverse", "omega-dot is solved for with", ("solve",)),
    _inertia_family("spin inertia", "the gyroscopic term is formed with", ("spin",)),
)
