"""A baseline: the figures of one engine in a text file that is read in a diff."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from omegadot.harness.usage import UsageError
from omegadot.reports.record.whole_file import make_folder, write_whole

SCHEMA = 1
DIGITS = 3
ACCURACY = "accuracy "
HEAD = "# Written by --update-baseline. [value, band]: within the band a rerun may differ."


@dataclass(frozen=True)
class Figure:
    """A measured value, and how far a rerun may be from it."""

    value: float
    band: float


@dataclass(frozen=True)
class RunKey:
    """Which figures belong together: those of a run, or, without integrator, of a scenario."""

    integrator: str = ""
    timestep: float | None = None
    accuracy: float | None = None

    @property
    def knob(self) -> str:
        """The step in s, or the accuracy, as it stands in the file."""
        if self.accuracy is None:
            return repr(self.timestep)
        return f"{ACCURACY}{self.accuracy!r}"


def _key(integrator: str, knob: str) -> RunKey:
    if knob.startswith(ACCURACY):
        return RunKey(integrator, accuracy=float(knob.removeprefix(ACCURACY)))
    return RunKey(integrator, float(knob))


@dataclass(frozen=True)
class Figures:
    """The figures of one run or one scenario. scheme: the one that the integrator declares."""

    named: dict[str, Figure]
    scheme: str = ""


@dataclass(frozen=True)
class ScenarioFigures:
    """All figures of one engine on one scenario, and the engine's version that they are of."""

    version: str
    runs: dict[RunKey, Figures] = field(default_factory=dict)


Baseline = dict[str, ScenarioFigures]


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _number(value: float) -> str:
    return f"{value:.{DIGITS - 1}e}"


def _lines(engine: str, baseline: Mapping[str, ScenarioFigures]) -> Iterator[str]:
    yield HEAD
    yield f"schema = {SCHEMA}"
    yield f"engine = {_quoted(engine)}"
    for scenario in sorted(baseline):
        yield f"\n[scenario.{_quoted(scenario)}]"
        yield f"version = {_quoted(baseline[scenario].version)}"
        runs = baseline[scenario].runs
        for key in sorted(runs, key=lambda k: (k.integrator, k.timestep or k.accuracy or 0.0)):
            place = f"scenario.{_quoted(scenario)}"
            if key.integrator:
                yield f"\n[{place}.run.{_quoted(key.integrator)}.{_quoted(key.knob)}]"
                yield f"scheme = {_quoted(runs[key].scheme)}"
            else:
                yield f"\n[{place}.figures]"
            for name, figure in sorted(runs[key].named.items()):
                if not math.isfinite(figure.band):  # it holds nothing to anything
                    continue
                yield f"{_quoted(name)} = [{_number(figure.value)}, {_number(figure.band)}]"


def path_of(folder: Path, engine: str) -> Path:
    """Where an engine's baseline stands in a folder of baselines."""
    return folder / f"{engine}.toml"


def to_text(engine: str, baseline: Mapping[str, ScenarioFigures]) -> str:
    """An engine's figures as TOML: sorted, each to three digits."""
    return "\n".join(_lines(engine, baseline)) + "\n"


def write_baseline(folder: Path, engine: str, baseline: Mapping[str, ScenarioFigures]) -> Path:
    """Write an engine's figures, whole or not at all. Raises RecordError."""
    path = path_of(folder, engine)
    make_folder(folder)
    return write_whole(path, to_text(engine, baseline), HEAD)


def _figures(table: dict[str, Any]) -> Figures:
    named = {k: Figure(*map(float, pair)) for k, pair in table.items() if k != "scheme"}
    for name, figure in named.items():
        if not figure.band >= 0.0:  # nothing is within a band below zero, or of no number
            raise ValueError(f"the band of {name!r} is {figure.band!r}")
    return Figures(named, table.get("scheme", ""))


def _scenario(table: dict[str, Any]) -> ScenarioFigures:
    runs = {RunKey(): _figures(table["figures"])} if "figures" in table else {}
    for integrator, steps in table.get("run", {}).items():
        for step, figures in steps.items():
            runs[_key(integrator, step)] = _figures(figures)
    return ScenarioFigures(str(table["version"]), runs)


def from_text(text: str, engine: str) -> Baseline:
    """The figures that `to_text` wrote of an engine. Raises ValueError, KeyError or TypeError."""
    data = tomllib.loads(text)
    if data["schema"] != SCHEMA:
        raise ValueError(f"its schema is {data['schema']}, not {SCHEMA}")
    if data["engine"] != engine:
        raise ValueError(f"its engine is {data['engine']}, not {engine}")
    return {name: _scenario(table) for name, table in data.get("scenario", {}).items()}


def read_baseline(folder: Path, engine: str) -> Baseline | None:
    """The stored figures of an engine, by scenario; None where there is no file.

    Raises UsageError where the file is not a baseline.
    """
    path = path_of(folder, engine)
    if not path.is_file():
        return None
    try:
        return from_text(path.read_text(encoding="utf-8-sig"), engine)
    except (ValueError, TypeError, KeyError, AttributeError) as problem:
        raise UsageError(
            f"{path}: not a baseline: {problem}; delete the file, then run with --update-baseline."
        ) from None
