"""Versions measured: each placed in its environment, started, measured, timed, and ended."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field

from omegadot.commands.other_python import worker_command
from omegadot.commands.versions.aims import Aims
from omegadot.commands.versions.changes import Portrait
from omegadot.commands.versions.environments import Absent, Place
from omegadot.commands.versions.figures import Wanted
from omegadot.commands.versions.measure import Sitting
from omegadot.commands.versions.metric import Name
from omegadot.commands.versions.release import Product, version_of
from omegadot.diagnosis.scheme_study.subject import NoAnswerError, load
from omegadot.gates.case import Case
from omegadot.gates.steps.accuracy import usual_for
from omegadot.harness.arguments import API
from omegadot.harness.engines import outcome_of
from omegadot.workers.harness_end.process import WorkerProcess

OWN = "given"
# Of timings. A round goes over all versions, so that a machine's moods fall on them alike.
ROUNDS, REPEATS = 3, 4


def everything(_: Name) -> bool:
    """Every metric is wanted."""
    return True


@dataclass
class Gallery:
    """Where releases are looked at.

    place: finds or makes the environment of a release.  pythons: interpreters given by the user.
    via: how bodies go in.
    """

    product: Product
    aims: Aims
    place: Callable[[str], Place | Absent]
    pythons: Mapping[str, str]
    setup: str
    timeout: float
    via: str = API
    _places: dict[str, Place] = field(default_factory=dict)
    _workers: list[WorkerProcess] = field(default_factory=list)
    _stopping: threading.Event = field(default_factory=threading.Event)

    @contextmanager
    def _worker(self, place: Place) -> Iterator[WorkerProcess]:
        target, file = self.product.target, "" if self.via == API else self.via
        worker = WorkerProcess(target, self.setup, self.timeout, place.command, via=file)
        self._workers.append(worker)
        try:
            yield worker
        finally:
            worker.finish()

    def look(self, version: str, choose: Callable[[list[Name]], Wanted] | None = None) -> Portrait:
        """One version. choose: from the names of its metrics, which are wanted; all without it."""
        portrait = Portrait(version)
        place: Place | Absent
        if self._stopping.is_set():
            place = Absent("interrupted")
        elif version in self.pythons:
            place = Place(worker_command(self.pythons[version]), OWN)
        else:
            place = self.place(version)
        if isinstance(place, Absent):
            portrait.outcome, portrait.reason = "not-installed", place.reason
            return portrait
        portrait.origin = place.origin
        with self._worker(place) as worker:
            read = self.via != API
            sitting = Sitting(portrait, worker, self.aims, self._stopping.is_set, read)
            names = sitting.start()
            self._check_start(portrait, place)
            if portrait.ok:
                self._places[version] = place
                sitting.request(choose(names) if choose else everything)
        return portrait

    def _check_start(self, portrait: Portrait, place: Place) -> None:
        if portrait.outcome == "not-installed" and place.origin != OWN:
            portrait.reason = f"installed, and it cannot be imported: {portrait.reason}"
        reported = version_of(portrait.reported_version)
        other = reported and reported != version_of(portrait.version)
        if portrait.ok and place.origin == OWN and other:
            portrait.outcome = "not-installed"
            portrait.reason = f"the interpreter given for it has {portrait.reported_version}"

    def measure_all(
        self, versions: Sequence[str], jobs: int, seen: Callable[[Portrait], object]
    ) -> list[Portrait]:
        """Every version, several side by side; `seen` hears of each. Ctrl-C ends them at once."""
        with ThreadPoolExecutor(max(1, jobs)) as threads:
            futures = [threads.submit(self.look, version) for version in versions]
            try:
                portraits = []
                for future in futures:
                    portraits.append(outcome_of(future))
                    seen(portraits[-1])
            except BaseException:
                self._stopping.set()
                for future in futures:
                    future.cancel()
                for worker in self._workers[:]:
                    worker.stop()
                raise
        return portraits

    def time_all(self, portraits: Sequence[Portrait]) -> None:
        """Time the steps of each, one at a time, in rounds that go forth and back."""
        known = [portrait for portrait in portraits if portrait.ok]
        for turn in range(ROUNDS):
            for portrait in known if turn % 2 == 0 else reversed(known):
                with self._worker(self._places[portrait.version]) as worker:
                    _time_steps(portrait, worker, self.aims.cases[0])


def _time_steps(portrait: Portrait, worker: WorkerProcess, case: Case) -> None:
    """Several timings of each integrator on a case, added to those of earlier rounds, s a step."""
    sweep = case.sweeps[0]
    plan = {"timestep": sweep.timestep, "steps": sweep.steps, "every": sweep.steps}
    try:
        declared = load(worker, case.system)
    except NoAnswerError:
        return
    for name in (name for name in portrait.integrators if name in declared):
        for _ in range(REPEATS):
            own = {"integrator": name, "accuracy": usual_for(declared[name])}
            answer = worker.request("run", initial=case.initial, **own, **plan)
            if not answer.ok:
                break
            portrait.speeds.setdefault(name, []).append(float(answer.result["seconds_per_step"]))
