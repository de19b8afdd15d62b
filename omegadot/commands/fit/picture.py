"""A fit as a picture: omega as measured and as fitted, and what is left."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from omegadot.commands.fit.parameters import moved
from omegadot.commands.fit.result import FitResult
from omegadot.reference_impl.system import Array
from omegadot.reports.charts.palette import COLOURS, INK
from omegadot.reports.charts.svg import Scale, path_of, text_at
from omegadot.reports.text.numbers import plain, short

MARK = "<!-- A picture of a fit, by omegadot fit. -->"
MOST = 600  # samples that are drawn
_LEFT, _RIGHT, _WIDTH = 70, 708, 720
_STYLE = (
    "svg{background:#fff}text{font:12px sans-serif;fill:#444;text-anchor:middle}.e{text-anchor:end}"
    f".s{{text-anchor:start}}path{{fill:none}}.g{{stroke:#e4e6e9}}.b{{stroke:{INK[0]}}}"
    ".d{stroke-width:3.5;stroke-linecap:round;opacity:.55}"
    + "".join(f".c{k}{{stroke:{COLOURS[k][0]}}}.t{k}{{fill:{COLOURS[k][0]}}}" for k in range(3))
)


def beside(scenario: Path) -> Path:
    """The picture's file: that of the scenario with another ending."""
    return scenario.with_suffix(".svg")


def residuals_of(result: FitResult) -> Array:
    """(n, 3) rad/s: omega as measured, less the motion and the bias that were fitted."""
    fit, count = result.compared.best, len(result.samples.times)
    lane = moved(fit.one, np.zeros((1, fit.free.count)), fit.free)
    left = result.compared.data.residuals(lane)[0, : 3 * count]
    return np.asarray(result.samples.size * left.reshape(count, 3))


def picture(result: FitResult) -> str:
    """SVG, of at most MOST samples: omega above, its residuals below, on the trace's own times."""
    samples, left = result.samples, residuals_of(result)
    count = len(samples.times)
    kept = np.unique(np.linspace(0, count - 1, min(count, MOST)).astype(int))
    times, omega, left = samples.times[kept], samples.omega[kept], left[kept]
    x = Scale(float(times[0]), float(times[-1]), _LEFT, _RIGHT, log=False)
    some = "" if count <= MOST else f"; {len(kept)} of {count} samples"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} 560" role="img">',
        f"{MARK}<title>omega as measured and as fitted, and its residuals</title>",
        f"<style>{_STYLE}</style>",
        *_panel(x, times, omega, 40, 300, f"omega, rad/s: measured (dots), fitted (lines){some}"),
    ]
    y = _upright(omega, 40, 300)
    for k in range(3):
        # A line through the fitted values at the samples; those of the motion, with the bias.
        parts.append(f'<path class="c{k}" d="{path_of(x.at(times), y.at((omega - left)[:, k]))}"/>')
        parts.append(text_at(_RIGHT - 90 + 30 * k, 28, f"w{'xyz'[k]}", f"t{k}"))
    rms = ", ".join(short(value) for value in result.rms)
    parts += [*_panel(x, times, left, 360, 520, f"residuals, rad/s; root mean square {rms}")]
    return "\n".join([*parts, text_at((_LEFT + _RIGHT) / 2, 554, "time, s"), "</svg>\n"])


def _upright(values: Array, top: float, bottom: float) -> Scale:
    low, high = float(np.min(values)), float(np.max(values))
    room = 0.05 * (high - low) or 1.0
    return Scale(low - room, high + room, bottom, top, log=False)


def _panel(
    x: Scale, times: Array, values: Array, top: float, bottom: float, title: str
) -> Iterator[str]:
    """Title, grid and the dots of three components."""
    y = _upright(values, top, bottom)
    yield text_at(_LEFT, top - 12, title, "s")
    rules = "".join(f"M{_LEFT} {y.at(v):.0f}H{_RIGHT}" for v in _round(y, 5))
    rules += "".join(f"M{x.at(v):.0f} {top}V{bottom}" for v in _round(x, 8))
    yield f'<path class="g" d="{rules}"/>'
    yield from (text_at(_LEFT - 6, float(y.at(v)) + 4, plain(v), "e") for v in _round(y, 5))
    yield from (text_at(float(x.at(v)), bottom + 16, plain(v)) for v in _round(x, 8))
    for k in range(3):
        places = zip(x.at(times), y.at(values[:, k]), strict=True)
        dots = "".join(f"M{a:.1f} {b:.1f}h0" for a, b in places)
        yield f'<path class="d c{k}" d="{dots}"/>'


def _round(scale: Scale, most: int) -> list[float]:
    """Round values along an axis."""
    step = 10.0 ** math.floor(math.log10((scale.high - scale.low) / most))
    step *= next(k for k in (1, 2, 5, 10) if k * step * most >= scale.high - scale.low)
    first, last = math.ceil(scale.low / step), math.floor(scale.high / step)
    return [k * step for k in range(first, last + 1)]
