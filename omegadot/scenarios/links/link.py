"""One link of a file, and the one that is meant by a name."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from omegadot.scenarios.errors import ScenarioError, printable
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.refusals import nearest

MOST_NAMED = 12


@dataclass(frozen=True)
class Link:
    """One link, or body, of a file.

    name: in full, such as ``model::link``.  has_mass: False where the file gives it none.
    body: the keys of a scenario's [body]; raises ScenarioError.
    """

    name: str
    has_mass: bool
    body: Callable[[Place], dict[str, Any]]


def link_of(links: Sequence[Link], name: str, file: str, kind: str, remark: str = "") -> Link:
    """The link of this name, in full or from any ``::`` on. Raises ScenarioError.

    kind: what the format calls a link.  remark: what to do first where a name is not there.
    """
    named = [link for link in links if link.name]
    choice = _short_names([link.name for link in named if link.has_mass], named)
    listed = _listed(kind, choice)
    if not named:
        raise ScenarioError(file, None, f"without a named {kind}", remark or "name one in it")
    if not name:
        advice = f"write {printable(f'{file}#{choice[0]}')}, {listed}" if choice else listed
        raise ScenarioError(file, None, f"given without a {kind}", advice)
    found = [link for link in named if link.name == name]
    found = found or [link for link in named if link.name.endswith(f"::{name}")]
    where = f"{kind} {printable(repr(name))}"
    if not found:
        near = nearest(name, choice)
        advice = f"write {printable(near)}" if near else "give another"
        first = f"{remark}, or " if remark else ""
        raise ScenarioError(file, where, "missing", f"{first}{advice}, {listed}")
    if len(found) > 1:
        full = list(dict.fromkeys(printable(link.name) for link in found))
        unique = f"write {' or '.join(full[:MOST_NAMED])}"
        advice = unique if len(full) == len(found) else "give every one a name of its own"
        raise ScenarioError(file, where, f"the name of {len(found)}", advice)
    return found[0]


def _short_names(names: Sequence[str], among: Sequence[Link]) -> list[str]:
    """Each name once, without its scope where that leaves no doubt."""
    counts = Counter(link.name.rpartition("::")[2] for link in among)
    short = {name: name.rpartition("::")[2] for name in names}
    return [short[name] if counts[short[name]] == 1 else name for name in short]


def _listed(kind: str, names: Sequence[str]) -> str:
    """Which links there are to choose from, not too many."""
    many = {"link": "links", "body": "bodies"}[kind]
    if not names:
        return f"none of its {many} has a mass"
    shown = ", ".join(printable(name) for name in names[:MOST_NAMED])
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return f"its {kind if len(names) == 1 else many} with a mass: {shown}{more}"
