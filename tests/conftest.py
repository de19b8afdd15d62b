"""How tests are shared out, and the Hypothesis profiles.

`ci` is small and always the same, `thorough` is large and random, and `mutation` stops at the first
failure. Choose with ``pytest --hypothesis-profile thorough``. Tests with settings of their own keep
them.
"""

import gc
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings

slow = [HealthCheck.too_slow, HealthCheck.data_too_large]
settings.register_profile("ci", derandomize=True, max_examples=30, deadline=None)
settings.register_profile("thorough", max_examples=400, deadline=None, suppress_health_check=slow)
# Mutation testing wants to know that a test fails, not by how little.
phases = (Phase.explicit, Phase.generate)
settings.register_profile(
    "mutation", derandomize=True, max_examples=30, deadline=None, phases=phases
)
settings.load_profile("ci")


def pytest_collection_finish() -> None:
    """What stays until the end, modules and some thousand tests, is not gone through again.

    Every full collection of garbage would look at all of it.
    """
    gc.collect()
    gc.freeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """With ``-n``, a file's tests stay in one process: what they share is then made once."""
    if config.getoption("dist") != "load":
        return None
    from xdist.scheduler import LoadFileScheduling

    return LoadFileScheduling(config, log)
