"""What the engines of a selection reported when they were started."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

from omegadot.commands.check.generate import Subject
from omegadot.harness.engines import Engines
from omegadot.harness.plan import Engine


def subject_of(engine: Engine) -> Subject:
    """What is to be known of an engine that started."""
    return Subject(
        engine.name,
        engine.description.version,
        tuple(i.name for i in engine.integrators),
        tuple(i.name for i in engine.description.integrators),
    )


@dataclass(frozen=True)
class Registry:
    """Engines that started, and those that did not, with outcome and reason."""

    subjects: tuple[Subject, ...]
    missing: dict[str, tuple[str, str]]

    @classmethod
    def of(cls, engines: Engines) -> Registry:
        """The registry of engines that have been started."""
        subjects = tuple(subject_of(engine) for engine in engines.started)
        missing = {choice.name: (a.outcome, a.reason) for choice, a in engines.missing}
        return cls(subjects, missing)

    def to_json(self) -> str:
        """The registry as a string that another process makes it of again."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Registry:
        """The registry that `to_json` wrote."""
        data: dict[str, Any] = json.loads(text)
        subjects = [
            Subject(s["name"], s["version"], tuple(s["integrators"]), tuple(s["declared"]))
            for s in data["subjects"]
        ]
        missing = {name: (outcome, reason) for name, (outcome, reason) in data["missing"].items()}
        return cls(tuple(subjects), missing)
