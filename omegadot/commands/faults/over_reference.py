"""Every fault over the engine reference, as attributes: ``over_reference:GyroscopicDropped``."""

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.catalogue.every import over

__getattr__ = over(BUILT_IN["reference"])
