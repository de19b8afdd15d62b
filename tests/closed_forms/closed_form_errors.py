"""Errors of a closed form against stored or fresh truth, and the truth that is stored."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import mpmath as mp
import numpy as np

from omegadot.reference_impl.system import Array, State

TRUTH = Path(__file__).with_name("truth.json")
EPS = float(np.finfo(float).eps)


def stored_truth() -> dict[str, list[list[mp.mpf]]]:
    with mp.workdps(40):
        text = json.loads(TRUTH.read_text(encoding="utf-8"))
        return {
            name: [[mp.mpf(x) for x in state] for state in states] for name, states in text.items()
        }


def errors(state: State, truth: Sequence[Sequence[mp.mpf]]) -> tuple[Array, Array]:
    """The angle of the attitude's error, rad, and the norm of that of ω, at each time."""
    with mp.workdps(40):
        angles, speeds = [], []
        for q, w, row in zip(state.orientation, state.angular_velocity, truth, strict=True):
            unit = mp.sqrt(mp.fsum(x * x for x in map(mp.mpf, map(float, q))))
            chords = [
                mp.sqrt(mp.fsum((mp.mpf(float(x)) / unit - s * y) ** 2 for x, y in pairs))
                for s in (1, -1)
                for pairs in [list(zip(q, row[:4], strict=True))]
            ]
            angles.append(float(4 * mp.asin(min(chords) / 2)))
            speeds.append(
                float(
                    mp.sqrt(
                        mp.fsum(
                            (mp.mpf(float(x)) - y) ** 2 for x, y in zip(w, row[4:], strict=True)
                        )
                    )
                )
            )
        return np.array(angles), np.array(speeds)
