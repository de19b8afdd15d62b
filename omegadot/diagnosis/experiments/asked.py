"""Requests of experiments: none after a time limit or a crash, or once they take too long."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from omegadot.gates.case import Case
from omegadot.harness.drive import Driver
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written

GOES_ON = ("ok", "raised", "unsupported")  # outcomes after which an engine is asked again
MOST_SECONDS = 30.0  # of waiting for one engine's answers, whatever the number of causes


@dataclass
class Asked:
    """lost: the answer that is given from then on; None as long as requests are made.

    waited: s, for its answers.
    """

    driver: Driver
    lost: Answer | None = field(default=None, init=False)
    waited: float = field(default=0.0, init=False)

    def request(self, case: Case, operation: str, **fields: Any) -> Answer:
        """As `Driver.request`."""
        if self.lost is not None:
            return self.lost
        start = monotonic()
        answer = self.driver.request(case, operation, **fields)
        self.waited += monotonic() - start
        if answer.outcome not in GOES_ON:
            self.lost = answer
        elif self.waited > MOST_SECONDS:
            self.lost = Answer(
                "timeout", f"experiments may take {written(MOST_SECONDS)} s of an engine"
            )
        return answer

    def restart(self) -> None:
        """Start the engine afresh with the next request."""
        if self.lost is None:
            self.driver.restart()
