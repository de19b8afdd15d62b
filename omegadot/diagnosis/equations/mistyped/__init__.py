"""One formula of the equation with a product or a factor mistyped, by the same in every scenario.

What is off is linear in what is typed: a rotation's matrix in products of the quaternion's parts, a
cross product in products of components. The numbers are found from all scenarios at once.
"""

from __future__ import annotations

from omegadot.diagnosis.equations.mistyped.over_scenarios import Mistyped

__all__ = ["Mistyped"]
