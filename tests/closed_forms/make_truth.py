"""Writes truth.json: the motions of the grid to thirty digits, by a Taylor series at fifty.

Run it where the package is installed: ``python tests/closed_forms/make_truth.py`` (a minute). The
tests hold the file against the textbook forms in mpmath's elliptic functions, the second way,
wherever these exist: triaxial bodies off the separatrix and off the axes, tops clear of the
vertical.
"""

from __future__ import annotations

import json
from pathlib import Path

import mpmath as mp
from closed_form_cases import FREE, TOPS, Case
from closed_form_taylor import TaylorSeries, Vector

TRUTH = Path(__file__).with_name("truth.json")


def series_of(case: Case) -> TaylorSeries:
    """The equations of a case about the point that matters, every number taken as exact."""
    lever = [mp.mpf(x) for x in case.lever or (0, 0, 0)]
    square = mp.fdot(lever, lever)
    inertia = [
        [
            mp.mpf(float(case.inertia[i][j])) + (square if i == j else 0) - lever[i] * lever[j]
            for j in range(3)
        ]
        for i in range(3)
    ]
    return TaylorSeries(inertia, 0.0, case.gravity, lever)


def taylor(case: Case) -> list[Vector]:
    return series_of(case).states(case.orientation, case.omega, case.times)


def main() -> None:
    mp.mp.dps = 50
    truth = {}
    for case in FREE + TOPS:
        states = taylor(case)
        truth[case.name] = [[mp.nstr(x, 30) for x in state] for state in states]
        print(case.name)
    TRUTH.write_text(json.dumps(truth, indent=0) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
