"""A cause with a wrong lever that is zero wherever it acts: that there is none is plainer."""

from __future__ import annotations

import re

OF_PIVOT = r"the pivot's distance from the origin is taken, not from the centre of mass"
OF_CENTER = r"the centre of mass's distance from the origin is taken, not from the pivot"
OF_CENTER_IN_GRAVITY = (
    r"in the torque of gravity the lever is the centre of mass's from the origin, "
    r"not from the pivot"
)
WITHOUT = {  # by what the lever is in
    "in the parallel-axis theorem,": "in the dynamics, the inertia about the centre of mass is "
    "taken, not that about the pivot",
    "in the torque of gravity,": "the torque of gravity is missing",
    "in the linear acceleration,": "the centre of mass is accelerated as if it lay on the pivot",
}
PLACE = "|".join(WITHOUT)
AT_ORIGIN = {
    "the pivot lies at the origin": re.compile(f"({PLACE}) {OF_PIVOT}"),
    "the centre of mass lies at the origin": re.compile(
        f"({PLACE}) {OF_CENTER}|{OF_CENTER_IN_GRAVITY}"
    ),
}


def no_lever(text: str, condition: str) -> str:
    """The cause in plainer words where on this condition its lever is zero; else as it is."""
    lever = AT_ORIGIN.get(condition)
    if lever is None:
        return text
    return lever.sub(lambda m: WITHOUT[m.group(1) or "in the torque of gravity,"], text)
