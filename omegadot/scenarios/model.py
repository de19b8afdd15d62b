"""The scenario: what moves, how it starts, what acts on it, and how it is to be stepped.

The attributes are the keys of the file. Every model is frozen and hashable, holds tuples of floats
and refuses keys it does not know. SI units; quaternions are (w, x, y, z), world-from-body.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import (
    Field,
    PlainValidator,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    field_serializer,
    model_validator,
)

from omegadot.scenarios.errors import Phrase
from omegadot.scenarios.parts import Part
from omegadot.scenarios.quantities import (
    Name,
    NotNegative,
    Positive,
    Quaternion,
    Table,
    Text,
    Vector,
    read_positive,
    refuse,
)
from omegadot.scenarios.solids import check_body_of_parts
from omegadot.scenarios.tensor import Inertia

MOST_STEPS = 10**8  # of one run; more is a slip of the pen, and would hold a machine for hours
MOST_TIMESTEPS = 100  # in one sweep
MOST_SAMPLES = 10**7  # of one stored trajectory: about 2 GB

ZERO = (0.0, 0.0, 0.0)


def _read_schema(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value != 1:
        raise refuse("write schema = 1, the only one there is")
    return 1


def _read_timesteps(value: object) -> tuple[float, ...]:
    if not isinstance(value, list | tuple) or not 0 < len(value) <= MOST_TIMESTEPS:
        raise refuse(f"give a list of one to {MOST_TIMESTEPS} time steps in s", found=value)
    steps = tuple(read_positive(step, key=f"[{i}]") for i, step in enumerate(value))
    for i, step in enumerate(steps):
        if step in steps[:i]:
            raise refuse("give every time step once", key=f"[{i}]", found=step)
    return steps


def _read_accuracies(value: object) -> tuple[float, ...] | None:
    if value is None:
        return None
    if not isinstance(value, list | tuple) or not 0 < len(value) <= MOST_TIMESTEPS:
        raise refuse(f"give a list of one to {MOST_TIMESTEPS} accuracies", found=value)
    found = tuple(read_positive(one, key=f"[{i}]") for i, one in enumerate(value))
    for i, one in enumerate(found):
        if one >= 1.0:
            raise refuse("give a relative tolerance below 1", key=f"[{i}]", found=one)
        if one in found[:i]:
            raise refuse("give every accuracy once", key=f"[{i}]", found=one)
    return found


def _read_flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise refuse("give true or false", found=value)
    return value


class Body(Table):
    """One rigid body: mass, inertia and centre of mass, or the parts that they follow from.

    inertia: 3x3, about the centre of mass, body axes.  With parts, the other three are None.
    allow_impossible_inertia: take one that breaks the triangle inequality, which no body has.
    """

    mass: Positive | None = Field(default=None, description="kg")
    allow_impossible_inertia: Annotated[bool, PlainValidator(_read_flag)] = Field(
        default=False, description="true to take one that breaks the triangle inequality"
    )
    inertia: Inertia | None = Field(default=None, description="kg m^2, about the centre of mass")
    center_of_mass: Vector | None = Field(default=None, description="m, from the body origin")
    part: tuple[Part, ...] = Field(default=(), description="solids, one [[body.part]] each")

    @model_validator(mode="before")
    @classmethod
    def _center_at_origin(cls, data: object) -> object:
        if isinstance(data, dict) and "part" not in data:
            return {"center_of_mass": ZERO, **data}
        return data

    @model_validator(mode="after")
    def _parts_or_inertia(self) -> Self:
        given = {"mass": self.mass, "inertia": self.inertia, "center_of_mass": self.center_of_mass}
        if "part" in self.model_fields_set:
            for key, value in given.items():
                if value is not None:
                    raise refuse("leave it out, it follows from body.part", key=key, found=value)
            if not self.part:
                raise refuse("give at least one [[body.part]]", key="part", found=())
            check_body_of_parts(self.part)
        for key in ("mass", "inertia"):
            if given[key] is None and not self.part:
                advice = "give mass and inertia, or [[body.part]] tables"
                raise refuse(advice, key=key, found=Phrase("missing"))
        return self


class Initial(Table):
    """The state at time zero. Any nonzero quaternion is taken and normalised.

    position and linear_velocity are those of the centre of mass, in world axes. A pivoted body's
    follow from its pivot: they are not given, and mean nothing here.
    """

    orientation: Quaternion = Field(default=(1.0, 0.0, 0.0, 0.0), description="w, x, y, z")
    angular_velocity: Vector = Field(description="rad/s, body axes")
    position: Vector = Field(default=ZERO, description="m, of the centre of mass, world")
    linear_velocity: Vector = Field(default=ZERO, description="m/s, of the centre of mass, world")


class Torque(Table):
    """A constant torque, in axes fixed to the body or to the world."""

    frame: Literal["body", "world"] = Field(description='"body" or "world"')
    value: Vector = Field(description="N m")


def _read_torques(value: object, read: ValidatorFunctionWrapHandler) -> tuple[Torque, ...]:
    """One table, or a list of them; the torque in body axes comes first."""
    if not isinstance(value, list | tuple) or not any(isinstance(x, dict | Torque) for x in value):
        return (Torque.model_validate(value),)
    torques: tuple[Torque, ...] = read(value)
    frames = [one.frame for one in torques]
    for i, frame in enumerate(frames):
        if frame in frames[:i]:
            advice = "give one torque in each frame at most, or their sum"
            raise refuse(advice, key=f"[{i}].frame", found=frame)
    return tuple(sorted(torques, key=lambda one: one.frame))


class Load(Table):
    """What acts on the body. Without a pivot the body is free.

    torque: one, or one in each frame.
    """

    gravity: Vector = Field(default=ZERO, description="m/s^2, world")
    pivot: Vector | None = Field(default=None, description="m, body axes, from the body origin")
    damping: NotNegative = Field(default=0.0, description="N m s/rad, torque = -damping * omega")
    torque: Annotated[tuple[Torque, ...], WrapValidator(_read_torques)] = Field(
        default=(Torque(frame="body", value=ZERO),), description="N m"
    )

    @field_serializer("torque")
    def _one_as_a_table(self, torques: tuple[Torque, ...]) -> object:
        tables = [one.model_dump(mode="json", warnings=False) for one in torques]
        return tables if len(tables) > 1 else tables[0]


class Run(Table):
    """How long, at which steps, and how densely stored."""

    duration: Positive = Field(description="s")
    timesteps: Annotated[tuple[float, ...], PlainValidator(_read_timesteps)] = Field(
        description="s, the sweep"
    )
    sample: Positive = Field(description="s, spacing of the stored trajectory")
    accuracies: Annotated[tuple[float, ...] | None, PlainValidator(_read_accuracies)] = Field(
        default=None, description="relative, the sweep of error-controlled integrators"
    )

    @model_validator(mode="after")
    def _within_duration(self) -> Self:
        spans = {f"timesteps[{i}]": step for i, step in enumerate(self.timesteps)}
        spans["sample"] = self.sample
        for key, span in spans.items():
            if span > self.duration:
                advice = f"give at most run.duration, which is {self.duration!r}"
                raise refuse(advice, key=key, found=span)
        for key, step in spans.items():
            if key != "sample" and self.duration / step > MOST_STEPS:
                advice = f"give a step of which run.duration holds at most {MOST_STEPS:,}"
                raise refuse(advice, key=key, found=step)
        if self.duration / max(self.sample, min(self.timesteps)) > MOST_SAMPLES:
            advice = f"give a spacing of which run.duration holds at most {MOST_SAMPLES:,}"
            raise refuse(advice, key="sample", found=self.sample)
        return self


class Scenario(Table):
    """One case, as the contract's TOML file gives it. `title` is the name where it is left out."""

    schema_number: Annotated[int, PlainValidator(_read_schema)] = Field(
        alias="schema", description="schema = 1"
    )
    name: Name = Field(description="kebab-case")
    title: Text = Field(description="a short text")
    shows: Text | None = Field(default=None, description="one sentence on what it shows")
    source: Text | None = Field(default=None, description="where it comes from")
    body: Body = Field(description="the table [body]")
    initial: Initial = Field(description="the table [initial]")
    load: Load = Load()
    run: Run = Field(description="the table [run]")

    @model_validator(mode="before")
    @classmethod
    def _title_from_name(cls, data: object) -> object:
        if isinstance(data, dict) and "title" not in data and "name" in data:
            return {"title": data["name"], **data}
        return data

    @model_validator(mode="after")
    def _pivot_places_the_body(self) -> Self:
        if self.load.pivot is not None:
            for key in ("position", "linear_velocity"):
                if key in self.initial.model_fields_set:
                    raise refuse(
                        "leave it out, load.pivot holds the body in place",
                        key=f"initial.{key}",
                        found=getattr(self.initial, key),
                    )
        return self

    def to_dict(self) -> dict[str, Any]:
        """The whole scenario as plain tables, lists and numbers, for TOML or JSON.

        Defaults are written out. `scenario_of` reads it back to an equal scenario.
        """
        # pydantic would warn of the lists that it makes of its own tuples
        data = self.model_dump(mode="json", by_alias=True, exclude_none=True, warnings=False)
        if not self.body.part:
            del data["body"]["part"]
        if not self.body.allow_impossible_inertia:
            del data["body"]["allow_impossible_inertia"]
        if self.load.pivot is not None:
            del data["initial"]["position"], data["initial"]["linear_velocity"]
        return data
