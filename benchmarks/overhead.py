"""What a step costs through an adapter, against the leanest loop over the engine's own API.

Both log the same samples, every k-th step in the engine's own coordinates, and take turns in one
run: a round gives the least of some turns each, and the medians of seven rounds count. Of several
loops over an engine's API the cheapest is the rival. `adapter` is what the adapter measures of its
steps, which `choose` ranks by; `worker` is that figure out of the engine's own process; `call` is
the whole of `run`, with samples converted to the project's frames. Exits with 1 where a ratio is
above its limit.

    python benchmarks/overhead.py [--engine mujoco] [--scenario t-handle] [--processor-time]
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random
from statistics import median

import numpy as np
from bare import Bare

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import OURS, build_adapter, is_absent
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.system import State, System
from omegadot.scenarios import load_builtin
from omegadot.workers.harness_end.process import WorkerProcess

LIMITS = {"mujoco": 1.05, "dart": 1.1, "pinocchio": 1.3, "drake": 1.1}
REFERENCE_LIMIT = 6.0  # times MuJoCo's RK4, a single body
BATCH, BATCH_LIMIT = 1000, 0.8e-6  # bodies, s a step of one
SCENARIOS = ("t-handle", "heavy-top", "damped-tumble", "driven-world", "driven-body", "offset-com")
EVERY = (1, 10, 100)
TIMESTEP = 1e-3
# A turn is short enough to fall between two other tasks of a busy machine.
SECONDS_A_TURN, TURNS, ROUNDS = 0.005, 5, 7
# Two loops with other roundings, or with another expansion of small turns, stay that close.
SAME_MOTION = 1e-6


@dataclass(frozen=True)
class Measured:
    """Seconds a step, and what they may be of `rival`."""

    what: tuple[str, str, str, int]
    cost: float
    rival: float
    ratio: float
    limit: float | None
    rival_name: str = ""
    call: float = float("nan")
    worker: float = float("nan")

    @property
    def passed(self) -> bool:
        """Whether the ratio is above its limit."""
        return self.limit is not None and self.ratio > self.limit

    def line(self) -> str:
        """The row of the table, in microseconds."""
        scenario, engine, integrator, every = self.what
        call, worker = (f"{1e6 * x:8.2f}" if x == x else 8 * " " for x in (self.call, self.worker))
        limit = "     " if self.limit is None else f"{self.limit:5.2f}"
        return (
            f"{scenario:14} {engine:10} {integrator:28} {every:5d} {1e6 * self.cost:8.2f} "
            f"{1e6 * self.rival:8.2f} {self.ratio:6.2f} {limit} {'above' if self.passed else '':5} "
            f"{worker} {call}  {self.rival_name}"
        )


HEADER = (
    f"{'scenario':14} {'engine':10} {'integrator':28} {'every':>5} {'adapter':>8} {'bare':>8} "
    f"{'ratio':>6} {'limit':>5} {'':5} {'worker':>8} {'call':>8}  bare loop         (us a step)"
)


def rounds_of(turns: dict[str, Callable[[], float]]) -> list[dict[str, float]]:
    """The least of some alternating turns of each, round by round, after a round to warm up.

    The order changes from turn to turn: a busy machine favours what runs first after a wait.
    """
    found, order, shuffle = [], list(turns), Random(0).shuffle
    for _ in range(ROUNDS + 1):
        costs: dict[str, float] = {}
        for _ in range(TURNS):
            shuffle(order)
            for name in order:
                costs[name] = min(turns[name](), costs.get(name, np.inf))
        found.append(costs)
    return found[1:]


def timed(bare: Bare, steps: int) -> Callable[[], float]:
    """A turn of a loop: seconds a step."""

    def turn() -> float:
        bare.start()
        began = time.perf_counter()
        bare.run()
        return (time.perf_counter() - began) / steps

    return turn


class Engine:
    """An adapter here and another in a worker, a system loaded in both."""

    def __init__(self, name: str, system: System, initial: State) -> None:
        self.name, self.initial = name, initial
        self.adapter: Adapter = build_adapter(OURS[name])
        self.adapter.load(system)
        self.worker = WorkerProcess(OURS[name], "physics", timeout=60.0)
        self.worker.start()
        self.worker.request("load", system=system)

    def turns(self, integrator: str, steps: int, every: int) -> dict[str, Callable[[], float]]:
        """The adapter's own figure, that of the whole call, and that of the worker."""
        whole = [np.inf]

        def adapter() -> float:
            began = time.perf_counter()
            found = self.adapter.run(self.initial, integrator, TIMESTEP, steps, every)
            whole[0] = time.perf_counter() - began
            return (whole[0] if found.seconds is None else found.seconds) / steps

        def worker() -> float:
            how = {"integrator": integrator, "timestep": TIMESTEP, "steps": steps, "every": every}
            answer = self.worker.request("run", initial=self.initial, **how)
            if not answer.ok:
                raise SystemExit(f"{self.name}: {answer.reason}")
            return float(answer.result["seconds_per_step"])

        return {"adapter": adapter, "call": lambda: whole[0] / steps, "worker": worker}

    def steps_for(self, integrator: str) -> int:
        """As many as fill a turn, a multiple of each spacing of samples."""
        turn = self.turns(integrator, 100, 100)["adapter"]
        return max(200, round(SECONDS_A_TURN / min(turn() for _ in range(3)) / 100) * 100)


def compared(
    scenario: str, engine: Engine, system: System, integrator: str, spacings: Sequence[int]
) -> Iterator[Measured]:
    """An integrator against the loops over the engine's own API, at several spacings of samples."""
    steps = engine.steps_for(integrator)
    module = importlib.import_module(f"bare_{engine.name}")
    for every in spacings:
        loops = module.loops(system, engine.initial, integrator, TIMESTEP, steps, every)
        what = (scenario, engine.name, integrator, every)
        if not loops:
            print(
                f"{scenario:14} {engine.name:10} {integrator:28} {every:5d} no loop to compare with"
            )
            continue
        for loop in loops:
            check_same_motion(what, engine, loop, steps)
        own = engine.turns(integrator, steps, every)
        rivals = {loop.name: timed(loop, steps) for loop in loops}
        found = rounds_of({**rivals, **own})
        name = min(rivals, key=lambda name: median(costs[name] for costs in found))
        ratio = median(costs["adapter"] / costs[name] for costs in found)
        cost, rival, call, worker = (
            median(costs[key] for costs in found) for key in ("adapter", name, "call", "worker")
        )
        yield Measured(what, cost, rival, ratio, LIMITS[engine.name], name, call, worker)


def check_same_motion(
    what: tuple[str, str, str, int], engine: Engine, loop: Bare, steps: int
) -> None:
    """Ends the benchmark where a loop does not end in the angular velocity of the adapter."""
    loop.start()
    loop.run()
    state = engine.adapter.run(engine.initial, what[2], TIMESTEP, steps, steps).state
    expected, found = state.angular_velocity[-1], loop.omega()
    off = float(np.linalg.norm(found - expected) / np.linalg.norm(expected))
    if not off <= SAME_MOTION:
        raise SystemExit(f"{what}: the loop {loop.name} ends {off:.1e} away from the adapter.")


def against_mujoco(scenario: str, system: System, initial: State) -> Iterator[Measured]:
    """A single body: the reference's RK4 against MuJoCo's, both through their adapters."""
    reference, mujoco = (Engine(name, system, initial) for name in ("reference", "mujoco"))
    declared = {i.name: i.scheme for i in mujoco.adapter.description.integrators}
    schemes = sorted({"rk4-quaternion", "lie-rk4", str(declared["RK4"])})
    rival = mujoco.turns("RK4", mujoco.steps_for("RK4"), 100)["adapter"]
    for scheme in schemes:
        steps = reference.steps_for(scheme)
        own = reference.turns(scheme, steps, 100)
        found = rounds_of({"rival": rival, **own})
        ratio = median(costs["adapter"] / costs["rival"] for costs in found)
        cost, base, call, worker = (
            median(costs[key] for costs in found) for key in ("adapter", "rival", "call", "worker")
        )
        what = (scenario, "reference", scheme, 100)
        yield Measured(what, cost, base, ratio, REFERENCE_LIMIT, "MuJoCo RK4", call, worker)


def in_a_batch(scenario: str, system: System, initial: State) -> Iterator[Measured]:
    """The reference's cost for each body of many, against the limit."""
    adapter = build_adapter(OURS["reference"])
    adapter.load(system)
    many = State(*(np.tile(field, (BATCH, 1)) for field in vars(initial).values()))
    steps = 20
    for scheme in ("semi-implicit-euler", "rk4-quaternion", "lie-rk4", "munthe-kaas-rk4"):

        def turn(scheme: str = scheme) -> float:
            began = time.perf_counter()
            adapter.run(many, scheme, TIMESTEP, steps, steps)
            return (time.perf_counter() - began) / steps / BATCH

        cost = median(costs["batch"] for costs in rounds_of({"batch": turn}))
        what = (scenario, "reference", f"{scheme}, {BATCH} bodies", steps)
        yield Measured(what, cost, BATCH_LIMIT, cost / BATCH_LIMIT, 1.0, "the limit")


def measured(options: argparse.Namespace) -> Iterator[Measured]:
    """All that was requested."""
    for scenario in options.scenario or SCENARIOS:
        given = load_builtin(scenario)
        system, initial = system_of(given), initial_state_of(given)
        for name in options.engine or (*(n for n in LIMITS if not is_absent(n)), "reference"):
            if name == "reference":
                yield from against_mujoco(scenario, system, initial)
                yield from in_a_batch(scenario, system, initial)
                continue
            engine = Engine(name, system, initial)
            for integrator in engine.adapter.description.integrators:
                if integrator.knob == "accuracy":
                    continue
                if options.integrator and integrator.name not in options.integrator:
                    continue
                yield from compared(
                    scenario, engine, system, integrator.name, options.every or EVERY
                )
            engine.worker.finish()


def main() -> None:
    """Print the table; exit with 1 where a ratio is above its limit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--engine", action="append", choices=[*LIMITS, "reference"])
    parser.add_argument("--integrator", action="append")
    parser.add_argument("--scenario", action="append", choices=SCENARIOS)
    parser.add_argument("--every", action="append", type=int, choices=EVERY)
    parser.add_argument(
        "--processor-time",
        action="store_true",
        help="count processor time, of this process alone: for a machine with other work to do",
    )
    options = parser.parse_args()
    if options.processor_time:  # before the adapters, which are imported as they are built
        time.perf_counter = time.process_time
    print(HEADER)
    above = 0
    for row in measured(options):
        above += row.passed
        print(row.line(), flush=True)
    if above:
        sys.exit(f"{above} above their limits")


if __name__ == "__main__":
    main()
