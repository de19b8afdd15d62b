"""Arrays of numbers with twice a double's digits, where the platform's long double has no more.

A number is the unevaluated sum of two doubles, ``high + low`` with ``|low| <= ulp(high)/2``: 106
bits and the range of a double. It needs no more than rounding to nearest, so every platform gives
the same digits. The sum, product, quotient and root err by a few ``u²`` with ``u = 2^-53``.

Sources: T. J. Dekker, A floating-point technique for extending the available precision, Numer.
Math. 18 (1971) 224-242; M. Joldes, J.-M. Muller and V. Popescu, Tight and rigorous error bounds for
basic building blocks of double-word arithmetic, ACM TOMS 44 (2017) 15res, algorithms 6, 10 and 17;
S. M. Rump, T. Ogita and S. Oishi, Accurate floating-point summation part I, SIAM J. Sci. Comput. 31
(2008) 189-224, section 3, for sums.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from omegadot.reference_impl.system import Array

SPLITTER = 2.0**27 + 1.0
Pair: TypeAlias = tuple[Array, Array]


def two_sum(a: Array, b: Array) -> Pair:
    """``a + b`` rounded, and its rounding error: Knuth's, for any a and b."""
    total = a + b
    of_b = total - a
    return total, (a - (total - of_b)) + (b - of_b)


def fast_two_sum(a: Array, b: Array) -> Pair:
    """The same where ``|a| >= |b|``: Dekker's."""
    total = a + b
    return total, b - (total - a)


def split(a: Array) -> Pair:
    """The leading 26 bits and the rest, exactly: Veltkamp's."""
    scaled = SPLITTER * a
    leading = scaled - (scaled - a)
    return leading, a - leading


def two_product(a: Array, b: Array) -> Pair:
    """``a b`` rounded, and its rounding error: Dekker's."""
    product = a * b
    a1, a2 = split(a)
    b1, b2 = split(b)
    return product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)


class DoubleDouble(NDArrayOperatorsMixin):
    """An array of such numbers; NumPy's functions below take it as they take an array.

    ``np.asarray`` refuses it, because it would drop the low part in silence: `to_double` in
    ``precision.py`` rounds. What is not finite becomes NaN.
    """

    __slots__ = ("high", "low")

    def __init__(self, high: Array, low: Array) -> None:
        self.high, self.low = high, low

    @classmethod
    def of(cls, values: Any) -> DoubleDouble:
        """Doubles or long doubles as they are, a long double's last bits in the low part."""
        if isinstance(values, cls):
            return values
        given = np.asarray(values)
        high = given.astype(float)
        rest = given - high if given.dtype == np.longdouble else np.zeros(high.shape)
        return cls(high, rest.astype(float))

    def __array__(self, *_: Any, **__: Any) -> Array:
        raise TypeError("a double-double array is rounded by to_double alone")

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        into = options.pop("out", None)
        with np.errstate(over="ignore", invalid="ignore"):
            if ufunc is np.add and method == "reduce":
                found: Any = _sum(self, **options)
            elif method == "__call__" and not options and ufunc in _ARITHMETIC:
                found = _ARITHMETIC[ufunc](*map(DoubleDouble.of, inputs))
            elif method == "__call__" and not options and ufunc in _COMPARISONS:
                found = ufunc(_subtract(*map(DoubleDouble.of, inputs)).high, 0.0)
            elif ufunc is np.isfinite:
                found = np.isfinite(self.high)
            else:
                return NotImplemented
        if into is None:
            return found
        into[0][...] = found
        return into[0]

    def __array_function__(self, function: Any, _: Any, given: Any, options: Any) -> Any:
        if function in _ASKING:
            return function(*_part(given, "high"), **options)
        if function in _MOVING:
            parts = (function(*_part(given, name), **options) for name in self.__slots__)
            return DoubleDouble(*parts)
        return NotImplemented

    def __getitem__(self, key: Any) -> DoubleDouble:
        return DoubleDouble(self.high[key], self.low[key])

    def __setitem__(self, key: Any, values: Any) -> None:
        given = self.of(values)
        self.high[key], self.low[key] = given.high, given.low

    def __len__(self) -> int:
        return len(self.high)

    def __repr__(self) -> str:
        return f"DoubleDouble({self.high!r}, {self.low!r})"

    shape = property(lambda self: self.high.shape)
    ndim = property(lambda self: self.high.ndim)
    T = property(lambda self: DoubleDouble(self.high.T, self.low.T))

    def reshape(self, *shape: int) -> DoubleDouble:
        """As of an array."""
        return DoubleDouble(self.high.reshape(*shape), self.low.reshape(*shape))

    def take(self, indices: Any, axis: int) -> DoubleDouble:
        """As of an array."""
        return DoubleDouble(self.high.take(indices, axis), self.low.take(indices, axis))

    def copy(self) -> DoubleDouble:
        """As of an array."""
        return DoubleDouble(self.high.copy(), self.low.copy())

    def astype(self, dtype: Any) -> Array:
        """Rounded once to another type, long double included."""
        rounded: Array = self.high.astype(dtype) + self.low.astype(dtype)
        return rounded


def _add(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    high, error = two_sum(a.high, b.high)
    low, least = two_sum(a.low, b.low)
    high, error = fast_two_sum(high, error + low)
    return DoubleDouble(*fast_two_sum(high, error + least))


def _subtract(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    return _add(a, _negative(b))


def _multiply(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    high, error = two_product(a.high, b.high)
    return DoubleDouble(*fast_two_sum(high, error + (a.high * b.low + a.low * b.high)))


def _divide(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    quotient = DoubleDouble.of(a.high / b.high)
    rest = _subtract(a, _multiply(quotient, b)).high
    return DoubleDouble(*fast_two_sum(quotient.high, rest / b.high))


def _root(a: DoubleDouble) -> DoubleDouble:
    """One step of Newton's from the double's root; a root of zero stays there."""
    root = np.sqrt(a.high)
    rest = _subtract(a, DoubleDouble(*two_product(root, root))).high
    return DoubleDouble(*fast_two_sum(root, rest / np.where(root == 0.0, 1.0, 2.0 * root)))


def _matrix_product(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    if a.ndim == 1:
        return _matrix_product(a[None], b)[..., 0, :] if b.ndim > 1 else _sum(a * b, 0)
    if b.ndim == 1:
        return _matrix_product(a, b[:, None])[..., 0]
    high, error = two_product(a.high[..., None], b.high[..., None, :, :])
    small = a.high @ b.low + a.low @ b.high
    return DoubleDouble(*_exact_sum(high, -2, np.add.reduce(error, -2) + small))


def _sum(a: DoubleDouble, axis: int = 0, keepdims: bool = False) -> DoubleDouble:
    high, low = _exact_sum(a.high, axis, np.add.reduce(a.low, axis))
    found = DoubleDouble(high, low)
    where = (axis % a.ndim,)
    return DoubleDouble(*(np.expand_dims(x, where) for x in (high, low))) if keepdims else found


def _exact_sum(terms: Array, axis: int, rest: Array) -> Pair:
    """Sum along an axis, and with it what the terms leave: to ``n² u²`` of the largest term.

    Added to and taken from a power of two that is more than n times the largest term, each keeps
    its leading bits, which are summed without rounding.
    """
    largest = np.max(np.abs(terms), axis, keepdims=True)
    power = np.ldexp(1.0, np.frexp(largest)[1] + (terms.shape[axis] + 2).bit_length())
    leading = (power + terms) - power
    return two_sum(np.add.reduce(leading, axis), np.add.reduce(terms - leading, axis) + rest)


def _negative(a: DoubleDouble) -> DoubleDouble:
    return DoubleDouble(-a.high, -a.low)


def _absolute(a: DoubleDouble) -> DoubleDouble:
    sign = np.where(a.high < 0, -1.0, 1.0)
    return DoubleDouble(sign * a.high, sign * a.low)


_ARITHMETIC: dict[np.ufunc, Callable[..., DoubleDouble]] = {
    np.add: _add,
    np.subtract: _subtract,
    np.multiply: _multiply,
    np.divide: _divide,
    np.matmul: _matrix_product,
    np.negative: _negative,
    np.absolute: _absolute,
    np.sqrt: _root,
}
_COMPARISONS = {np.equal, np.not_equal, np.less, np.less_equal, np.greater, np.greater_equal}
_MOVING = {
    np.broadcast_to, np.concatenate, np.expand_dims, np.stack, np.swapaxes, np.zeros_like
}  # fmt: skip
_ASKING = {np.any, np.ndim, np.shape}


def _part(given: Any, name: str) -> Any:
    """The high or low parts in a function's arguments; a plain array's low part is zero."""
    if isinstance(given, list | tuple):
        return type(given)(_part(value, name) for value in given)
    if isinstance(given, DoubleDouble):
        return getattr(given, name)
    return np.zeros_like(given) if isinstance(given, np.ndarray) and name == "low" else given
