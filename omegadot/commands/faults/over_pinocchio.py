"""Every fault over the engine pinocchio, as attributes: ``over_pinocchio:GyroscopicDropped``."""

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.catalogue.every import over

__getattr__ = over(BUILT_IN["pinocchio"])
