"""Companions are shared by two processes, and the loss of one loses none of them."""

from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from omegadot.gates.case import Sweep
from omegadot.gates.truth import SchemeKey
from omegadot.harness.runner import Runner
from omegadot.workers.harness_end.process import Answer

SWEEPS = [Sweep(0.1, 2, 1), Sweep(0.05, 4, 2)]
KEYS = [SchemeKey(name) for name in ("lie-rk4", "munthe-kaas-rk4", "implicit-midpoint")]


class Process:
    """Answers so many requests, and none after that."""

    def __init__(self, answers: int) -> None:
        self.left = answers
        self.stepped: list[str] = []

    def request(self, _: object, __: str, **fields: Any) -> Answer:
        if self.left == 0:
            return Answer("crashed", "it has ended")
        self.left -= 1
        self.stepped.append(fields["scheme"])
        fields_of_state = ("orientation", "angular_velocity", "position", "linear_velocity")
        state = dict.fromkeys(fields_of_state, np.zeros(3))
        run = {"state": state, "growth": np.ones(3), "omega_dot": np.zeros(3)}
        return Answer("ok", result=[run, run])


@pytest.mark.parametrize("answers", [0, 1, 99])
def test_the_loss_of_the_exact_process_loses_no_companion(answers: int) -> None:
    """Caught: schemes that a dead process took and nobody stepped, so that engines are accused."""
    drivers = {"exact": Process(answers), "reference": Process(99)}
    threads = {name: ThreadPoolExecutor(1) for name in drivers}
    engines = SimpleNamespace(drivers=drivers, submit=lambda name, call: threads[name].submit(call))
    case = cast(Any, SimpleNamespace(system=None, initial=None))
    truth = cast(Any, SimpleNamespace(yardstick=SimpleNamespace(rate=1.0)))
    runner = cast(Any, SimpleNamespace(engines=engines))
    found = Runner._submit_companions(runner, case, lambda: truth, KEYS, SWEEPS).result()
    assert set(found) == {(key, sweep.timestep) for key in KEYS for sweep in SWEEPS}
    assert sorted(drivers["exact"].stepped + drivers["reference"].stepped) == sorted(
        key.scheme for key in KEYS
    )
    for thread in threads.values():
        thread.shutdown()
