"""Every fault over the engine mujoco, as attributes: ``over_mujoco:GyroscopicDropped``."""

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.catalogue.every import over

__getattr__ = over(BUILT_IN["mujoco"])
