"""How the factor of a vector goes with sizes: a product of powers, the same on every system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.formula.facts import MOMENTUM, SIZES, VECTORS, Facts, Unit
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array
from omegadot.scenarios.written import written

NORMS = ("omega", "v", "s", "omega-dot", "a", MOMENTUM)  # which change from state to state
DOTS = (
    "omega",
    "g",
    "r",
    "v",
    "c",
    "s",
    "tau_b",
    "tau_w",
    "e_x",
    "e_y",
    "e_z",
    "E_x",
    "E_y",
    "E_z",
)
MOST_SIZES, LARGEST = 3, 4.0  # sizes of a system in one law; powers
ROUNDED = 1e-9  # what sums of logarithms leave
EQUAL = 1e-12


@dataclass(frozen=True)
class Law:
    """Powers by the size that they are of; `signed`: a product of two vectors that keeps its sign.

    whole: whether the factor is one number on all systems; else it is another on each.
    """

    powers: tuple[tuple[str, float], ...] = ()
    signed: str = ""
    whole: bool = True

    @property
    def cost(self) -> float:
        """How far from plain it is."""
        per = sum(0.6 + 0.2 * abs(p) + 0.2 * (p % 1.0 != 0.0) for _, p in self.powers)
        return per + (1.0 if self.signed else 0.0) + (0.0 if self.whole else 4.0)

    def of(self, facts: Facts) -> Array:
        """The product at states, (n,)."""
        made = np.ones(len(facts.vectors["omega"]))
        for name, power in self.powers:
            values = np.abs(number_of(facts, name))
            if power < 0.0:  # of nothing there is nothing
                made = np.where(values > 0.0, made * np.where(values > 0, values, 1.0) ** power, 0)
            else:
                made = made * values**power
        return made * number_of(facts, self.signed) if self.signed else made

    @property
    def unit(self) -> Unit:
        """Of the product."""
        total = np.zeros(3)
        for name, power in (*self.powers, *(((self.signed, 1.0),) if self.signed else ())):
            total += power * np.array(_unit_of(name))
        return (float(total[0]), float(total[1]), float(total[2]))

    @property
    def text(self) -> str:
        """``d |omega|^2``, and what it is divided by: ``/ m``."""
        above = [_power(n, p) for n, p in self.powers if p > 0.0]
        above += [f"({self.signed})"] if self.signed else []
        below = [_power(n, -p) for n, p in self.powers if p < 0.0]
        under = " ".join(below)
        under = f"({under})" if len(below) > 1 else under
        return " ".join(above) + (f" / {under}" if below else "")


NO_LAW = Law()


def _power(name: str, power: float) -> str:
    shown = name if (name in SIZES and " " not in name) or name.startswith("|") else f"({name})"
    return shown if power == 1.0 else f"{shown}^{written(power)}"


def number_of(facts: Facts, name: str) -> Array:
    """A size at every state: of a system, of a vector ``|v|``, or of two ``omega . g``."""
    if name in SIZES:
        return facts.sizes[name]
    one, _, other = name.strip("|").partition(" . ")
    if other:
        return np.asarray(np.sum(facts.vectors[one] * facts.vectors[other], axis=-1))
    return norm(facts.vectors[one])


def _unit_of(name: str) -> Unit:
    if name in SIZES:
        return SIZES[name][0]
    one, _, other = name.strip("|").partition(" . ")
    known = {**{k: unit for k, (unit, _) in VECTORS.items()}, MOMENTUM: (1.0, 2.0, -1.0)}
    units = [np.array(known[k]) for k in (one, other) if k]
    total = np.sum(units, axis=0)
    return (float(total[0]), float(total[1]), float(total[2]))


@dataclass(frozen=True)
class Seen:
    """Factors (n,) at states of several systems, each known to a part `known` of itself.

    system: (n,), the number of the system.  facts: at these states.
    """

    factors: Array
    known: Array
    system: NDArray[np.intp]
    facts: Facts


def laws(seen: Seen) -> Iterator[Law]:
    """Those that hold at every state, the plainest first."""
    used = np.isfinite(seen.factors) & (seen.factors != 0.0) & (seen.known < 0.1)
    if np.count_nonzero(used) < 3:
        return
    places = np.flatnonzero(used)
    logs = np.log(np.abs(seen.factors[places]))
    known, system = seen.known[places] + ROUNDED, seen.system[places]
    signs = np.sign(seen.factors[places])
    columns = _of_states(seen.facts, places, signs, system)
    for law, rest in _along_states(columns, logs, known, system, signs):
        values, sure = _by_system(rest, known, system)
        own = signs * np.sign(number_of(seen.facts, law.signed)[places]) if law.signed else signs
        found = list[tuple[tuple[str, float], ...]]()
        if np.all(own == own[0]):
            found = list(_over_systems(seen.facts, places, values, sure, system))
        for powers in found:
            yield Law((*law.powers, *powers), law.signed)
        if not found and len(values) > 1:
            yield Law(law.powers, law.signed, whole=False)
        break


Columns = dict[str, tuple[Array, bool]]  # logarithms, and whether the sign is the factor's


def _one_each(signs: Array, system: NDArray[np.intp]) -> bool:
    """Whether the sign is the same at every state of a system."""
    sums = np.bincount(system, signs)
    return bool(np.all(np.abs(sums) == np.bincount(system)))


def _of_states(
    facts: Facts, places: NDArray[np.intp], signs: Array, system: NDArray[np.intp]
) -> Columns:
    """Sizes that change from state to state, as logarithms."""
    found: Columns = {}
    names = [f"|{one}|" for one in NORMS]
    names += [f"omega . {MOMENTUM}"]
    names += [f"{a} . {b}" for a, b in combinations(DOTS, 2) if not a.startswith(("e_", "E_"))]
    for name in names:
        values = number_of(facts, name)[places]
        if not np.all(np.isfinite(values)) or np.any(values == 0.0):
            continue
        along = np.sign(values) * signs
        if "." in name and not _one_each(along, system):
            continue  # where its sign is another than the factor's
        logs = np.log(np.abs(values))
        if not any(np.max(np.abs(logs - other)) < EQUAL for other, _ in found.values()):
            found[name] = (logs, "." in name)
    return found


def _along_states(
    columns: Columns, logs: Array, known: Array, system: NDArray[np.intp], signs: Array
) -> Iterator[tuple[Law, Array]]:
    """Laws over the states of each system, with what they leave of the logarithms."""
    one_sign = _one_each(signs, system)
    if one_sign and _constant(logs, known, system):
        yield Law(), logs
    names = list(columns)
    centred = {name: _centred(columns[name][0], known, system) for name in names}
    wanted, weight = _centred(logs, known, system), 1.0 / known
    for count in (1, 2):
        for chosen in combinations(names, count):
            signed = [name for name in chosen if columns[name][1]]
            if len(signed) > 1 or (not one_sign and not signed):
                continue
            lines = np.stack([centred[name] * weight for name in chosen], axis=-1)
            gram = lines.T @ lines
            if not np.linalg.det(gram) > EQUAL * np.prod(np.diag(gram)):
                continue
            powers = np.round(2.0 * np.linalg.solve(gram, lines.T @ (wanted * weight))) / 2.0
            if not np.all(powers) or np.max(np.abs(powers)) > LARGEST:
                continue
            rest = logs - sum(p * columns[n][0] for p, n in zip(powers, chosen, strict=True))
            if not _constant(rest, known, system):
                continue
            pairs = tuple(zip(chosen, powers.tolist(), strict=True))
            if not signed:
                yield Law(pairs), rest
            elif dict(pairs)[signed[0]] == 1.0:
                yield Law(tuple(x for x in pairs if x[0] != signed[0]), signed[0]), rest


def _centred(values: Array, known: Array, system: NDArray[np.intp]) -> Array:
    """Each system's own mean taken off."""
    weight = 1.0 / known**2
    total = np.bincount(system, weight)[system]
    return np.asarray(values - np.bincount(system, weight * values)[system] / total)


def _constant(values: Array, known: Array, system: NDArray[np.intp]) -> bool:
    """Whether they are one on each system, as far as they are known."""
    return bool(np.all(np.abs(_centred(values, known, system)) <= 2.0 * known))


def _by_system(rest: Array, known: Array, system: NDArray[np.intp]) -> tuple[Array, Array]:
    """The one logarithm of each system, and how well it is known, from its best states."""
    numbers = np.unique(system)
    best = [np.flatnonzero(system == k)[np.argmin(known[system == k])] for k in numbers]
    return rest[best], known[best]


def _over_systems(
    facts: Facts, places: NDArray[np.intp], values: Array, sure: Array, system: NDArray[np.intp]
) -> Iterator[tuple[tuple[str, float], ...]]:
    """Powers of the systems' own sizes that make the factor one number; the fewest that do."""
    if np.ptp(values) <= 2.0 * float(np.max(sure)) and _even(values, sure):
        yield ()
        return
    first = places[np.unique(system, return_index=True)[1]]
    logs = dict[str, Array]()
    for name in SIZES:
        x = facts.sizes[name][first]
        same = (
            any(np.ptp(np.log(x) - other) < EQUAL for other in logs.values())
            if np.all(x > 0.0)
            else True
        )
        if not same and np.ptp(x) > EQUAL * np.max(x):
            logs[name] = np.log(x)
    weight = 1.0 / sure
    for count in range(1, MOST_SIZES + 1):
        if len(values) < count + 2:
            return
        found = list(combinations(logs, count))
        kept = list[tuple[tuple[str, float], ...]]()
        for chosen in found:
            lines = np.stack([*(logs[n] for n in chosen), np.ones(len(values))], axis=-1)
            fit = np.linalg.lstsq(lines * weight[:, None], values * weight, rcond=None)[0]
            powers = np.round(2.0 * fit[:-1]) / 2.0
            if not np.all(powers) or np.max(np.abs(powers)) > LARGEST:
                continue
            if _even(values - lines[:, :-1] @ powers, sure):
                kept.append(tuple(zip(chosen, powers.tolist(), strict=True)))
        if kept:
            yield from sorted(kept, key=lambda one: sum(abs(p) for _, p in one))
            return


def _even(values: Array, sure: Array) -> bool:
    weight = 1.0 / sure**2
    mean = float(np.sum(weight * values) / np.sum(weight))
    return bool(np.all(np.abs(values - mean) <= 2.0 * sure))


def symbols_of(texts: Sequence[str]) -> set[str]:
    """The names that stand in formulas."""
    joined = " ".join(texts)
    for mark in "()|,/":
        joined = joined.replace(mark, " ")
    return {name.partition("^")[0] if name != "I^-1" else name for name in joined.split()}
