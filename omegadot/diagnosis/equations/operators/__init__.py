"""Wrong equations in which one vector of the right one is changed: every operand, every operator.

A grammar in place of a list: a term, what goes in or what comes out, and what is made of it.
"""

from __future__ import annotations

from omegadot.diagnosis.equations.operators.changed import Changed, changed_vectors
from omegadot.diagnosis.equations.operators.solved_apart import Apart, solved_apart

__all__ = ["Apart", "Changed", "changed_vectors", "solved_apart"]
