"""What a fault is: a sound engine's adapter, wrapped so that one thing in it is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from inspect import signature
from typing import Any, Literal, TypeVar

from omegadot.adapters.protocol import Adapter, Description, Trajectory
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

Kind = Literal["model", "convention", "equation", "stepping", "logging", "state"]


class Spoiled:
    """An adapter around a sound one, passing everything on; each fault overrides one thing.

    The hooks `loaded`, `into`, `read_back` and `logged` change the system that the engine is
    given, the states that go in, the state that is read back, and the states of a run.
    """

    def __init__(self, inner: Adapter) -> None:
        self.inner = inner
        self._system: System | None = None

    @property
    def description(self) -> Description:
        """The sound engine's description, under a name with the fault in it."""
        sound = self.inner.description
        return replace(sound, name=f"{sound.name}+{type(self).__name__}")

    @property
    def system(self) -> System:
        """The system as requested. Raises RuntimeError before `load`."""
        if self._system is None:
            raise RuntimeError("no system is loaded; call load first")
        return self._system

    def loaded(self, system: System) -> System:
        """The system that the sound engine is given instead."""
        return system

    def into(self, state: State) -> State:
        """The state that the sound engine is given instead."""
        return state

    def read_back(self, state: State) -> State:
        """What is reported instead of the engine's present state."""
        return state

    def logged(self, trajectory: Trajectory) -> Trajectory:
        """What is reported instead of a run."""
        return trajectory

    def load(self, system: System) -> None:
        """As `Adapter.load`."""
        given = self.loaded(system)  # `_system` is still the one before
        self._system = system
        self.inner.load(given)

    def model(self) -> tuple[Body, ...]:
        """As `Adapter.model`."""
        return self.inner.model()

    def set_state(self, state: State) -> None:
        """As `Adapter.set_state`."""
        self.inner.set_state(self.into(state))

    def get_state(self) -> State:
        """As `Adapter.get_state`."""
        return self.read_back(self.inner.get_state())

    def forward_dynamics(self, states: State) -> Acceleration:
        """As `Adapter.forward_dynamics`."""
        return self.inner.forward_dynamics(self.into(states))

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """As `Adapter.inverse_dynamics`."""
        return self.inner.inverse_dynamics(self.into(states), acceleration)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """As `Adapter.run`."""
        found = self.inner.run(self.into(initial), integrator, timestep, steps, every)
        return self.logged(found)


class OtherSystem(Spoiled):
    """The engine is given another system than is requested, by `loaded`; all else is sound.

    What it is given depends on the system requested alone.
    """


@dataclass(frozen=True)
class Fault:
    """One fault.

    sentence: what is wrong.  needs: the features of a scenario in which it shows at all (see
    `features_of`).  gates: those expected to catch it.  named: phrases of a diagnosis that name its
    cause.  wrap: an adapter with the fault around a sound one.
    """

    name: str
    sentence: str
    kind: Kind
    needs: frozenset[str]
    gates: tuple[str, ...]
    named: tuple[str, ...]
    wrap: Callable[[Adapter], Spoiled]

    def is_named(self, sentences: Iterable[str]) -> bool:
        """Whether one of the sentences names this fault's cause."""
        return any(phrase in text for text in sentences for phrase in self.named)


FAULTS: dict[str, Fault] = {}
"""Every fault by name, in the order of their files; `catalogue` fills it."""

Class = TypeVar("Class", bound=type[Spoiled])
Function = TypeVar("Function", bound=Callable[..., Any])


def fault(
    kind: Kind, gates: str, needs: str = "", *, named: str | tuple[str, ...]
) -> Callable[[Class], Class]:
    """Enter a class among the faults; its docstring is the sentence. Names are separated by blanks.

    Raises ValueError where the docstring is missing or a name comes twice.
    """

    def enter(wrapper: Class) -> Class:
        sentence = " ".join((wrapper.__doc__ or "").split())
        name = wrapper.__name__
        if not sentence or name in FAULTS:
            raise ValueError(f"{name}: give a fault a docstring, and a name of its own.")
        phrases = (named,) if isinstance(named, str) else named
        needed, expected = frozenset(needs.split()), tuple(gates.split())
        FAULTS[name] = Fault(name, sentence, kind, needed, expected, phrases, wrapper)
        return wrapper

    return enter


def fault_by(
    base: type[Spoiled],
    method: str,
    kind: Kind,
    gates: str,
    needs: str = "",
    *,
    named: str | tuple[str, ...],
) -> Callable[[Function], Function]:
    """Enter a function among the faults: `base` with this function for one of its methods.

    It is a static method unless its first argument is `self`.
    """

    def enter(function: Function) -> Function:
        bound = "self" in signature(function).parameters
        own = {method: function if bound else staticmethod(function), "__doc__": function.__doc__}
        own["__module__"] = function.__module__
        fault(kind, gates, needs, named=named)(type(function.__name__, (base,), own))
        return function

    return enter


logged = partial(fault_by, Spoiled, "logged")
