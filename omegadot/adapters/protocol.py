"""What an engine must answer: one small protocol, the same for the reference and for MuJoCo."""

from __future__ import annotations

from dataclasses import InitVar, dataclass, field
from typing import Literal, Protocol, runtime_checkable

from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

Setup = Literal["physics", "as-shipped"]
WITH = "+"  # as-shipped+NAME: as shipped, with the setting of this name mended
Format = Literal["urdf", "mjcf"]
Channel = Literal[
    "omega_dot",
    "omega",
    "attitude",
    "energy",
    "angular_momentum",
    "linear_momentum",
    "position",
    "torque",
    "model",
    "time",
]
Knob = Literal["timestep", "accuracy", "fixed-accuracy"]
FEATURES = (
    *("free", "pivot", "gravity", "damping", "torque", "full_inertia", "offset_com"),
    *("forward_dynamics", "inverse_dynamics", "batch"),
)
"""What an engine may declare that it can do."""
ONE_BODY = frozenset(FEATURES) - {"batch"}
"""The features of an engine that takes a single body under every load."""


def mends(setup: str, setting: str) -> bool:
    """Whether the default behind one of `Description.settings` is mended under a setup.

    All are under ``physics``, none under ``as-shipped``, this one under ``as-shipped+SETTING``.
    """
    return setup in ("physics", f"as-shipped{WITH}{setting}")


class UnsupportedError(Exception):
    """The engine cannot do what the scenario requires; the message names it in one sentence."""


@dataclass(frozen=True)
class Integrator:
    """One way an engine steps.

    scheme: the name of the reference scheme it is declared to equal, or None when unknown.
    orders: declared order of the accumulated error per channel.
    knob: "timestep", or "accuracy" for an error-controlled integrator, which chooses its own steps.
    Its `run` takes an `accuracy`; where it takes none, its knob is "fixed-accuracy".
    finest_accuracy: the smallest that it follows, 0 where it follows all down to rounding.
    coordinates: those in which the engine steps a free body's translation, see `Coordinates`.
    one_step: a step depends on the state alone; False for a multistep method, which keeps earlier
    steps in mind, and for coordinates that are chosen by the steps before, as a chart that moves.
    steps_origin: True is the same as the coordinates "origin-world"; adapters written before
    `coordinates` give it.
    """

    name: str
    scheme: str | None
    orders: dict[str, int]
    knob: Knob = "timestep"
    note: str = ""
    coordinates: Coordinates = "com-world"
    one_step: bool = True
    finest_accuracy: float = 0.0
    steps_origin: InitVar[bool] = False

    def __post_init__(self, steps_origin: bool) -> None:
        if steps_origin:
            object.__setattr__(self, "coordinates", "origin-world")


@dataclass(frozen=True)
class Description:
    """What an engine is.

    precision: of the numbers that it keeps and computes with, by which rounding is judged.
    conventions: how the engine itself keeps states (frames, orders), one clause each.
    switched_off: defaults that disturb the motion and were turned off for the ``physics`` setup.
    settings: those of them that can be mended alone and act on a body without contacts, in the
    engine's own words, whatever the setup. Each makes ``as-shipped+NAME`` a setup, see `mends`.
    features: what it can do, of `FEATURES`. Each that is a call's name needs that call.
    importers: the formats of robot files that the engine's own reader takes. For each the adapter
    has ``load_file(system, format)``, which does what `Adapter.load` does with a model that the
    engine has read from a file of the body (`omegadot.adapters.body_files` writes it).
    """

    name: str
    version: str
    integrators: tuple[Integrator, ...]
    precision: Literal["float64", "float32"] = "float64"
    conventions: tuple[str, ...] = ()
    switched_off: tuple[str, ...] = ()
    features: frozenset[str] = field(default_factory=frozenset)
    licence: str = ""
    links: tuple[str, ...] = ()
    importers: tuple[Format, ...] = ()
    settings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Trajectory:
    """States at the engine's own steps. time: (n,) s; every array of the state has n rows.

    seconds: s that the steps took, with samples logged as the engine keeps them. Setting the state
    and converting samples to the project's frames are left out: a user of the engine's own API
    does not pay for them at each step. None: the whole call is the cost.
    """

    time: Array
    state: State
    seconds: float | None = None


@runtime_checkable
class Adapter(Protocol):
    """An engine behind the harness.

    A class is built with ``Engine(setup="physics")`` and must not import its engine before that.
    Other setups are "as-shipped", and "as-shipped+NAME" for those who describe settings.
    States cross this border in the project's frames only, whatever the engine keeps inside.
    """

    @property
    def description(self) -> Description:
        """Name, version, integrators with declared orders, conventions, links."""
        ...

    def load(self, system: System) -> None:
        """Build the engine's own model of the system, forgetting any earlier one.

        Raises UnsupportedError when the engine lacks what the system needs.
        """
        ...

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia as the engine itself holds them, read back."""
        ...

    def set_state(self, state: State) -> None:
        """Put the engine in a state. Pivoted bodies take orientation and angular velocity only."""
        ...

    def get_state(self) -> State:
        """The engine's present state."""
        ...

    def forward_dynamics(self, states: State) -> Acceleration:
        """The engine's omega-dot and centre-of-mass acceleration at n states, all loads acting."""
        ...

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The torque (n, 3) in N m, body axes, that gives n states this acceleration.

        Everything but gravity: ``I omega_dot + omega x I omega - tau_gravity``, about the centre of
        mass, or about the pivot for a pivoted body. Damping and applied torques are part of it.
        Raises UnsupportedError where the engine has no inverse dynamics.
        """
        ...

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step from `initial`, logging step 0, every `every`-th step and the last one.

        Times are ``n * timestep``. The result does not depend on earlier runs.

        An adapter with an integrator of the knob "accuracy" has a further parameter, ``accuracy:
        float | None = None``: the relative tolerance of the integrator, which takes steps of its
        own between the samples. It is given to those integrators alone, by name.
        """
        ...
