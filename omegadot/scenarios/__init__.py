"""What is run: scenario files, their model and the built-in cases."""

from omegadot.scenarios.errors import ScenarioError
from omegadot.scenarios.loader import (
    ScenarioLike,
    builtin_names,
    load_builtin,
    load_scenario,
    scenario,
    scenario_of,
)
from omegadot.scenarios.model import Scenario

__all__ = [
    "Scenario",
    "ScenarioError",
    "ScenarioLike",
    "builtin_names",
    "load_builtin",
    "load_scenario",
    "scenario",
    "scenario_of",
]
