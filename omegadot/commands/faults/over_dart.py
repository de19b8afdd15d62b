"""Every fault over the engine dart, as attributes: ``over_dart:GyroscopicDropped``."""

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.catalogue.every import over

__getattr__ = over(BUILT_IN["dart"])
