"""Requests of experiments: none after a time limit or a crash, or once they take too long."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from omegadot.gates.case import Case
from omegadot.harness.drive import Driver
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written

WHAT = {"forward": "omega-dot", "model": "a state set and read back", "first_steps": "single steps"}
VARIED = re.compile(r"-experiment-\d+$|-by-length$")  # ends the name of a system that was changed
GOES_ON = ("ok", "raised", "unsupported")  # outcomes after which requests are made again
MOST_SECONDS = 30.0  # of waiting for one engine's answers, whatever the number of causes


@dataclass
class Requests:
    """lost: the answer that is given from then on; None as long as requests are made.

    waited: s, for its answers.  lost_in: the request that crashed or timed out, and
    how; "" without one.
    """

    driver: Driver
    lost: Answer | None = field(default=None, init=False)
    waited: float = field(default=0.0, init=False)
    lost_in: str = field(default="", init=False)

    def request(self, case: Case, operation: str, **fields: Any) -> Answer:
        """As `Driver.request`."""
        if self.lost is not None:
            return self.lost
        start = monotonic()
        answer = self.driver.request(case, operation, **fields)
        self.waited += monotonic() - start
        if answer.outcome not in GOES_ON:
            self.lost = answer
            if answer.outcome != "interrupted":
                self.lost_in = f"{_requested(case, operation, fields)}; {answer.outcome}: "
                self.lost_in += answer.reason
        elif self.waited > MOST_SECONDS:
            self.lost = Answer(
                "timeout", f"experiments may take {written(MOST_SECONDS)} s of an engine"
            )
        return answer

    def restart(self) -> None:
        """Start the engine afresh with the next request."""
        if self.lost is None:
            self.driver.restart()


def _requested(case: Case, operation: str, fields: Mapping[str, Any]) -> str:
    """``single steps of RK4 on a variation of t-handle``."""
    by = f" of {fields['integrator']}" if "integrator" in fields else ""
    name, varied = VARIED.subn("", case.name)
    return f"{WHAT.get(operation, operation)}{by} on {'a variation of ' * varied}{name}"
