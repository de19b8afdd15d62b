"""The times of a trace's samples: read to all digits, in a window, and rising."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Context, Decimal

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.score.dates import as_date, is_date, seconds_of
from omegadot.commands.score.digits import is_single, open_time, printed_whole
from omegadot.commands.score.table import Table, TraceError
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.system import Array
from omegadot.written import written

# Stamps this much larger than what they span are differences of large numbers: epochs are.
FAR = 1e3
EXACT = Context(prec=60)


@dataclass(frozen=True)
class Stamps:
    """base: s, exact.  seconds: (n,) since then.  open: (n,) s, what is open of each.

    texts: as written, None of binary numbers.  unit: s.  dated: whether they are dates.
    single: whether they are numbers of single precision.
    """

    base: Decimal
    seconds: Array
    open: Array
    texts: Sequence[str] | None
    unit: Decimal
    dated: bool
    single: bool

    def since(self, start: Decimal) -> Array:
        """(n,) s: the times from a start on."""
        away = float(EXACT.subtract(self.base, start))
        return self.seconds + away if away else self.seconds

    def at(self, sample: int) -> Decimal:
        """A stamp in s, exactly as written."""
        if self.texts is None:
            return EXACT.add(self.base, Decimal(repr(float(self.seconds[sample]))))
        return EXACT.multiply(Decimal(self.texts[sample].lower().replace("d", "e")), self.unit)

    def text(self, sample: int) -> str:
        """The same for people and for ``--time-offset``, with every digit; dates as such."""
        return as_date(self.at(sample)) if self.dated else plain(self.at(sample))


def plain(number: Decimal) -> str:
    """All digits of a number, and no zeros behind them."""
    text = format(number.normalize(EXACT), "f")
    return "0" if text == "-0" else text


def stamps_of(table: Table, name: str, unit: float) -> Stamps:
    """The stamps of a column, numbers or dates. unit: s.  Raises TraceError."""
    column, dated = table.times(name)
    exact = Decimal(1) if dated else Decimal(repr(unit))
    unit = float(exact)
    values, texts, base = column.values, column.texts, Decimal(0)
    seconds, opened = unit * values, unit * column.open_time
    if texts is not None and np.max(np.abs(values)) > FAR * np.ptp(values):
        numbers = [Decimal(text.lower().replace("d", "e")) for text in texts]
        apart = [EXACT.subtract(number, numbers[0]) for number in numbers]
        base, away = EXACT.multiply(numbers[0], exact), np.array([float(d) for d in apart])
        seconds, opened = unit * away, unit * open_time([format(d, "f") for d in apart], away)
        if printed_whole(texts) and not dated:
            opened = np.maximum(opened, 0.5 * EPS * unit * np.abs(values))
    single = texts is not None and is_single(texts, column.values)
    return Stamps(base, seconds, opened, texts, exact, dated, single)


def counted(table: Table, rate: float) -> Stamps:
    """The stamps of samples that come at a rate, in Hz, the first at zero."""
    seconds = np.asarray(table.numbers, dtype=float) / rate
    return Stamps(Decimal(0), seconds, EPS * seconds, None, Decimal(1), dated=False, single=False)


def instant(text: str | float, where: str) -> Decimal:
    """A time in s, or a date, as an option has it. Raises TraceError."""
    written = text if isinstance(text, str) else repr(float(text))
    found = seconds_of(written) if is_date(written.strip()) else written
    try:
        number = Decimal(found or "")
    except ArithmeticError:
        number = Decimal("nan")
    if not number.is_finite():
        raise TraceError(
            f"{where} {written}: neither a number of seconds nor a date; write it as 12.5 or as "
            "2025-01-31T12:00:00.5."
        )
    return number


def in_window(stamps: Stamps, first: Decimal | None, last: Decimal | None) -> NDArray[np.bool_]:
    """(n,): whether a stamp lies in a window, its ends included, as far as the stamps are known."""
    inside = np.ones(len(stamps.seconds), dtype=bool)
    if first is not None:
        inside &= stamps.since(first) >= -stamps.open
    if last is not None:
        inside &= stamps.since(last) <= stamps.open
    return inside


def check_rising(table: Table, stamps: Stamps) -> None:
    """Raise TraceError where a stamp is repeated or goes back."""
    if len(stamps.seconds) < 2:  # of a motion, more than one instant is needed
        raise TraceError(f"{table.file}: has one sample only; give a trace with at least two.")
    gaps = np.diff(stamps.seconds)
    repeated, back = np.flatnonzero(gaps == 0.0), np.flatnonzero(gaps < 0.0)
    if len(back):
        k, more = int(back[0]), len(back) - 1
        raise TraceError(
            f"{table.file}: {table.place(k + 1)}: the time goes back from {_shown(stamps, k)} to "
            f"{_shown(stamps, k + 1)}{_more(more)}; sort the samples, or use a part with --from "
            "and --to."
        )
    if len(repeated):
        k, more = int(repeated[0]), len(repeated) - 1
        raise TraceError(
            f"{table.file}: {table.place(k)} and {table.place(k + 1)}: the time "
            f"{_shown(stamps, k)} is repeated{_more(more)}; keep one sample of each instant."
        )


def _shown(stamps: Stamps, sample: int) -> str:
    """As the file has it, in its own unit."""
    if stamps.texts is None:
        return written(stamps.seconds[sample], 15)
    return stamps.texts[sample]


def _more(count: int) -> str:
    return f", and {count} times more" if count else ""


def gaps_of(table: Table, stamps: Stamps) -> str:
    """A sentence about missing samples; empty where none are, or the spacing is irregular.

    A gap is half a spacing longer than the median, where most are that within a tenth.
    """
    spans = np.diff(stamps.seconds)
    usual = float(np.median(spans))
    gaps = np.flatnonzero(spans > 1.5 * usual)
    if not len(gaps) or np.mean(np.abs(spans - usual) <= 0.1 * usual) < 0.6:
        return ""
    longest = gaps[np.argsort(-spans[gaps], kind="stable")]
    missing = int(np.sum(np.round(spans[gaps] / usual) - 1))
    shown = [f"{written(spans[k])} s after {table.place(int(k))}" for k in longest[:3]]
    more = f" and {len(gaps) - 3} more" if len(gaps) > 3 else ""
    count = f"{len(gaps)} gaps" if len(gaps) > 1 else "One gap"
    return (
        f"{count} in the samples, which are {written(usual)} s apart otherwise: {', '.join(shown)}"
        f"{more}; {missing} samples are missing."
    )
