"""Versions measured: each placed in its environment, started, measured, timed, and ended."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

from omegadot.commands.other_python import worker_command
from omegadot.commands.versions.aims import Aims
from omegadot.commands.versions.environments import Absent, Place
from omegadot.commands.versions.figures import Wanted
from omegadot.commands.versions.measure import Portrait, Sitting
from omegadot.commands.versions.metric import Name
from omegadot.commands.versions.product import Product
from omegadot.commands.versions.release import version_of
from omegadot.commands.versions.speed import ROUNDS, time_steps
from omegadot.commands.versions.truths import Truths
from omegadot.harness.engines import outcome_of
from omegadot.workers.harness_end.process import WorkerProcess

OWN = "given"


def everything(_: Name) -> bool:
    """Every metric is wanted."""
    return True


class Gallery:
    """Where releases are looked at.

    place: finds or makes the environment of a release.  pythons: interpreters given by the user.
    """

    def __init__(
        self,
        product: Product,
        aims: Aims,
        place: Callable[[str], Place | Absent],
        pythons: Mapping[str, str],
        setup: str = "physics",
        timeout: float = 60.0,
    ) -> None:
        self._product, self._aims = product, aims
        self._place, self._pythons = place, pythons
        self._setup, self._timeout = setup, timeout
        self._truths = Truths()
        self._places: dict[str, Place] = {}
        self._workers: set[WorkerProcess] = set()
        self._stopping = threading.Event()

    def _placed(self, version: str) -> Place | Absent:
        if version in self._pythons:
            return Place(worker_command(self._pythons[version]), OWN)
        return self._place(version)

    def _worker(self, place: Place) -> WorkerProcess:
        worker = WorkerProcess(self._product.target, self._setup, self._timeout, place.command)
        self._workers.add(worker)
        return worker

    def look(self, version: str, choose: Callable[[list[Name]], Wanted] | None = None) -> Portrait:
        """One version. choose: from the names of its metrics, which are wanted; all without it."""
        portrait = Portrait(version)
        place = Absent("interrupted") if self._stopping.is_set() else self._placed(version)
        if isinstance(place, Absent):
            portrait.outcome, portrait.reason = "not-installed", place.reason
            return portrait
        portrait.origin = place.origin
        worker = self._worker(place)
        try:
            sitting = Sitting(portrait, worker, self._aims, self._stopping.is_set)
            names = sitting.start()
            self._check_start(portrait, place)
            if portrait.ok:
                self._places[version] = place
                sitting.request(choose(names) if choose else everything, self._truths)
        finally:
            worker.finish()
        return portrait

    def _check_start(self, portrait: Portrait, place: Place) -> None:
        if portrait.outcome == "not-installed" and place.origin != OWN:
            portrait.reason = f"installed, and it cannot be imported: {portrait.reason}"
        reported = version_of(portrait.reported_version)
        if (
            portrait.ok
            and place.origin == OWN
            and reported
            and reported != version_of(portrait.version)
        ):
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
                for worker in list(self._workers):
                    worker.stop()
                raise
        return portraits

    def time_all(self, portraits: Sequence[Portrait]) -> None:
        """Time the steps of each, one at a time, in rounds that go forth and back."""
        known = [portrait for portrait in portraits if portrait.ok]
        for turn in range(ROUNDS):
            for portrait in known if turn % 2 == 0 else reversed(known):
                worker = self._worker(self._places[portrait.version])
                try:
                    time_steps(portrait, worker, self._aims.cases[0])
                finally:
                    worker.finish()
