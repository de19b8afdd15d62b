"""What is run: the engines requested, and the engines that started."""

from __future__ import annotations

from dataclasses import dataclass, field

from omegadot.adapters.protocol import Description, Integrator


@dataclass(frozen=True)
class EngineChoice:
    """An engine requested, and which of its integrators (all of them when empty).

    named: integrators requested besides all of them; the engine must have these too.
    via: the format of the files by which its bodies go in; "" for its API. The name has it too.
    """

    name: str
    target: str
    integrators: tuple[str, ...] = ()
    required: bool = False
    via: str = ""
    named: tuple[str, ...] = ()

    @property
    def engine(self) -> str:
        """The engine's name, whichever way its bodies go in."""
        return self.name.removesuffix(f"-via-{self.via}") if self.via else self.name


@dataclass(frozen=True)
class Engine:
    """An engine that started: its choice, its description, and the integrators that are run."""

    choice: EngineChoice
    description: Description
    integrators: tuple[Integrator, ...] = field(default_factory=tuple)

    @property
    def name(self) -> str:
        """The engine's name."""
        return self.choice.name
