"""What ``run.json`` holds, by name and type. Keys that are not named here may stand as well."""

from __future__ import annotations

import datetime
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, field_validator
from pydantic_core import PydanticCustomError

from omegadot.reports.record import schema
from omegadot.reports.record.schema import RecordError
from omegadot.scenarios.errors import describe


def _time(text: str) -> str:
    try:
        datetime.datetime.fromisoformat(text)
    except ValueError:
        raise PydanticCustomError("time", "a date and time, as 2026-01-31T12:00:00") from None
    return text


Number = Annotated[float, Field(allow_inf_nan=False)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Quaternion = Annotated[list[Number], Field(min_length=4, max_length=4)]
Matrix = Annotated[list[Vector], Field(min_length=3, max_length=3)]
Text = str | None
Texts = list[str] | None
Time = Annotated[str, AfterValidator(_time)]
Verdict = Literal[*schema.VERDICTS]  # type: ignore[valid-type]
Outcome = Literal[*schema.OUTCOMES]  # type: ignore[valid-type]


class _Table(BaseModel):
    model_config = ConfigDict(strict=True, extra="allow")


class _Integrator(_Table):
    name: str
    scheme: Text = None
    orders: dict[str, Number | None] | None = None
    knob: Text = None
    note: Text = None
    coordinates: Text = None


class _Engine(_Table):
    name: str
    version: Text = None
    integrators: list[_Integrator] | None = None
    precision: Text = None
    conventions: Texts = None
    switched_off: Texts = None
    features: Texts = None
    licence: Text = None
    links: Texts = None
    importers: Texts = None
    settings: Texts = None
    installed: bool | None = None
    reason: Text = None
    via: Text = None
    argument: Text = None
    environment: Texts = None


class _System(_Table):
    mass: Annotated[Number, Field(gt=0.0)]
    center_of_mass: Vector
    inertia: Matrix
    gravity: Vector
    pivot: Vector | None
    damping: Number
    torque_body: Vector
    torque_world: Vector

    @field_validator("inertia")
    @classmethod
    def _positive(cls, tensor: list[list[float]]) -> list[list[float]]:
        if not np.all(np.linalg.eigvalsh(np.array(tensor)) > 0.0):
            raise PydanticCustomError("tensor", "a positive definite tensor")
        return tensor


class _Body(_Table):
    inertia: Matrix | None = None


class _Initial(_Table):
    orientation: Quaternion | None = None
    angular_velocity: Vector | None = None
    position: Vector | None = None
    linear_velocity: Vector | None = None


class _Definition(_Table):
    """What readers take of a scenario file; the rest of it is shown as it stands."""

    body: _Body | None = None
    initial: _Initial | None = None


class _Scenario(_Table):
    name: str
    title: Text = None
    shows: Text = None
    source: Text = None
    definition: _Definition | None = None
    system: _System | None = None


class _Task(_Table):
    scenario: str
    engine: str
    engine_version: Text = None
    setup: Text = None
    integrator: Text
    timestep: Number | None = None
    accuracy: Number | None = None
    outcome: Outcome
    reason: Text = None
    gates: dict[str, Verdict] | None = None
    why: Text = None
    cause: Text = None
    scheme: Text = None


class _Cluster(_Table):
    scenario: str
    timestep: Number
    scheme: Text = None
    members: list[str]
    also: Texts = None
    exact: bool = False


class _SingleSetting(_Table):
    """An engine as shipped with one of its settings mended, see `reports.shipped.figures`."""

    scenario: str
    engine: str
    integrator: str
    setting: str
    timestep: Number | None = None
    accuracy: Number | None = None
    outcome: Outcome
    reason: Text = None
    flips: list[Number] = []
    until: Number | None = None
    energy_lost: Number | None = None
    attitude_end: Number | None = None
    attitude_mean: Number | None = None


class _Run(_Table):
    """Records from before there were clusters have none."""

    engines: list[_Engine]
    scenarios: list[_Scenario]
    tasks: list[_Task]
    clusters: list[_Cluster] = []
    single_settings: list[_SingleSetting] = []
    omegadot: Text = None
    created: Time | None = None
    command: Texts = None
    seed: int | None = None
    seconds: Number | None = None
    complete: bool | None = None
    headline: Text = None
    machine: dict[str, str | Number | None] | None = None
    versions: dict[str, Text] | None = None
    worker_deaths: list[dict[str, str]] | None = None
    stale_exceptions: list[Any] | None = None


def check_run(run: object, where: str) -> None:
    """Raise RecordError, one sentence, unless it is what `run.json` holds."""
    try:
        _Run.model_validate(run)
    except ValidationError as problem:
        first = problem.errors(include_url=False)[0]
        key = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in first["loc"])
        if first["type"] == "missing":
            raise RecordError(f"{where}: {key[1:]} is missing; run again.") from None
        expected = first["msg"].removeprefix("Input should be ")
        raise RecordError(
            f"{where}: {key[1:]} is {describe(first['input'])}, expected {expected}; run again."
        ) from None
