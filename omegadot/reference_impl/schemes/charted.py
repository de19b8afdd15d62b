"""Schemes that step an attitude's numbers as a part of one vector: a method, and a chart of them.

Their names are those of both. Semi-implicit Euler is stepped without the exponential here.
"""

from __future__ import annotations

from omegadot.reference_impl.schemes import implicit_damping_euler
from omegadot.reference_impl.schemes.charts.chart import Chart, by_tableau, drifted, semi_implicit
from omegadot.reference_impl.schemes.charts.rodrigues import RODRIGUES
from omegadot.reference_impl.schemes.charts.three_angles import ROLL_PITCH_YAW, TWO_FRAMES
from omegadot.reference_impl.schemes.charts.world_quaternion import WORLD_QUATERNION
from omegadot.reference_impl.schemes.charts.world_spatial import WORLD_SPATIAL
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import (
    IN_WORLD,
    Scheme,
    Step,
    every_channel,
    explicit,
)
from omegadot.reference_impl.schemes.tableaus import (
    BOGACKI_SHAMPINE3,
    DORMAND_PRINCE5,
    EULER,
    FEHLBERG4,
    HEUN,
    KUTTA3,
    KUTTA4,
    MERSON4,
    Tableau,
)
from omegadot.reference_impl.system import Array

TABLEAUS = {
    "explicit-euler": EULER,
    "heun": HEUN,
    "kutta3": KUTTA3,
    "bogacki-shampine3": BOGACKI_SHAMPINE3,
    "rk4": KUTTA4,
    "merson4": MERSON4,
    "fehlberg4": FEHLBERG4,
    "dormand-prince5": DORMAND_PRINCE5,
}
DRAKES = ("explicit-euler", "heun", "kutta3", "bogacki-shampine3", "dormand-prince5")
SIMBODYS = ("explicit-euler", "heun", "kutta3", "merson4", "fehlberg4")
# The name that follows a method's, in words, and the methods that engines have on it.
CHARTS: tuple[tuple[str, str, Chart, tuple[str, ...]], ...] = (
    ("world-quaternion", "the quaternion and omega in world axes", WORLD_QUATERNION, DRAKES),
    ("roll-pitch-yaw", "roll, pitch, yaw and omega in world axes", ROLL_PITCH_YAW, DRAKES),
    ("two-frames-xyz", "angles x y z in one of two frames and omega there", TWO_FRAMES, SIMBODYS),
    (
        "mrp",
        "modified Rodrigues parameters of the shorter turn",
        RODRIGUES,
        ("explicit-euler", "heun", "rk4"),
    ),
    ("world-spatial", "the quaternion and spatial velocity in world axes", WORLD_SPATIAL, ("rk4",)),
)
KINEMATICS = "Diebel, Representing Attitude (2006), sections 5 and 6"


def _implicit_damping(chart: Chart) -> Step:
    """Velocities as `implicit_damping_euler`, then the rest by a straight step of the chart."""
    drift = drifted(chart)

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        return drift(motion, q, implicit_damping_euler.pushed(motion, q, v, h), h)

    return step


def _explicit(method: str, name: str, words: str, chart: Chart) -> Scheme:
    tableau: Tableau = TABLEAUS[method]
    orders = explicit(tableau.order)
    if chart.from_start:  # the velocity of a point that is not the centre of mass is turned
        orders["special"] = {}
    elif method == "heun" and not chart.in_world:  # of v̇ quadratic in ω as it is in body axes
        orders["special"] = {**orders["special"], "torque-free": {"energy": 3}}
    return Scheme(
        name=f"{method}-{name}",
        title=f"{tableau.title} on {words}",
        step=by_tableau(chart, tableau),
        **orders,
        source=f"{tableau.source}; {KINEMATICS}",
        coordinates=IN_WORLD,
    )


def _euler(method: str, name: str, words: str, step: Step, conserves: bool = True) -> Scheme:
    titles = {
        "semi-implicit-euler": "Semi-implicit Euler",
        "implicit-damping-euler": "Semi-implicit Euler with implicit damping",
        "semi-implicit-euler-in-two": "Semi-implicit Euler in two halves",
    }
    return Scheme(
        name=f"{method}-{name}",
        title=f"{titles[method]}, straight in {words}",
        step=step,
        orders=every_channel(1),
        special={"free": {"linear_momentum": None}} if conserves else {},
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), I.1.2; "
        + KINEMATICS,
        coordinates=IN_WORLD,
    )


def _schemes() -> list[Scheme]:
    found = []
    for name, words, chart, methods in CHARTS:
        found += [_explicit(method, name, words, chart) for method in methods]
        if chart in (WORLD_QUATERNION, ROLL_PITCH_YAW):
            found.append(_euler("semi-implicit-euler", name, words, semi_implicit(chart)))
            found.append(_euler("implicit-damping-euler", name, words, _implicit_damping(chart)))
        elif chart is TWO_FRAMES:
            halves = semi_implicit(chart, 2)
            found.append(_euler("semi-implicit-euler-in-two", name, words, halves))
        elif chart is WORLD_SPATIAL:
            step = semi_implicit(chart)
            found.append(_euler("semi-implicit-euler", name, words, step, conserves=False))
    return found


CHARTED = tuple(_schemes())
