"""Arrays of double-word numbers, where the platform's long double is a double."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from omegadot.reference_impl.arithmetic import double_words
from omegadot.reference_impl.arithmetic.double_words import Pair
from omegadot.reference_impl.system import Array


class DoubleDouble(NDArrayOperatorsMixin):
    """An array of such numbers; NumPy's functions named below take it as they take an array.

    ``np.asarray`` refuses it, because it would drop the low part in silence: `to_double` in
    ``precision.py`` rounds. What is not finite becomes NaN.
    """

    __slots__ = ("high", "low")

    def __init__(self, high: Array, low: Array) -> None:
        self.high, self.low = high, low

    @classmethod
    def of(cls, values: Any) -> DoubleDouble:
        """Doubles or long doubles as they are, a long double's last bits in the low part."""
        return values if isinstance(values, cls) else cls(*_pair(values))

    def __array__(self, *_: Any, **__: Any) -> Array:
        raise TypeError("a double-double array is rounded by to_double alone")

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        into = options.pop("out", None)
        with np.errstate(over="ignore", invalid="ignore"):
            if ufunc is np.add and method == "reduce":
                found: Any = _sum(self, **options)
            elif method != "__call__" or options:
                return NotImplemented
            elif ufunc in _ARITHMETIC:
                found = DoubleDouble(*_ARITHMETIC[ufunc](*map(_pair, inputs)))
            elif ufunc in _COMPARISONS:
                found = ufunc(double_words.subtract(*map(_pair, inputs))[0], 0.0)
            elif ufunc is np.isfinite:
                found = np.isfinite(self.high)
            else:
                return NotImplemented
        if into is None:
            return found
        into[0][...] = found
        return into[0]

    def __array_function__(self, function: Any, _: Any, given: Any, options: Any) -> Any:
        if function in _QUERIES:
            return function(*_part(given, "high"), **options)
        if function in _MOVING:
            parts = (function(*_part(given, name), **options) for name in self.__slots__)
            return DoubleDouble(*parts)
        return NotImplemented

    def __getitem__(self, key: Any) -> DoubleDouble:
        return DoubleDouble(self.high[key], self.low[key])

    def __setitem__(self, key: Any, values: Any) -> None:
        self.high[key], self.low[key] = _pair(values)

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


def _pair(values: Any) -> Pair:
    if isinstance(values, DoubleDouble):
        return values.high, values.low
    given = np.asarray(values)
    high = given.astype(float)
    rest = given - high if given.dtype == np.longdouble else np.zeros(high.shape)
    return high, rest.astype(float)


def _matrix_product(a: Pair, b: Pair) -> Pair:
    """As ``@`` of arrays, which takes vectors too."""
    if a[0].ndim == 1:
        high, low = _matrix_product((a[0][None], a[1][None]), b)
        return (high[0], low[0]) if b[0].ndim == 1 else (high[..., 0, :], low[..., 0, :])
    if b[0].ndim == 1:
        high, low = double_words.matrix_product(a, (b[0][:, None], b[1][:, None]))
        return high[..., 0], low[..., 0]
    return double_words.matrix_product(a, b)


def _sum(a: DoubleDouble, axis: int = 0, keepdims: bool = False) -> DoubleDouble:
    found = DoubleDouble(*double_words.total((a.high, a.low), axis))
    return DoubleDouble.of(np.expand_dims(found, axis)) if keepdims else found


def _part(given: Any, name: str) -> Any:
    """The high or low parts in a function's arguments; a plain array's low part is zero."""
    if isinstance(given, list | tuple):
        return type(given)(_part(value, name) for value in given)
    if isinstance(given, DoubleDouble):
        return getattr(given, name)
    return np.zeros_like(given) if isinstance(given, np.ndarray) and name == "low" else given


_ARITHMETIC: dict[np.ufunc, Callable[..., Pair]] = {
    np.add: double_words.add,
    np.subtract: double_words.subtract,
    np.multiply: double_words.multiply,
    np.divide: double_words.divide,
    np.matmul: _matrix_product,
    np.negative: double_words.negative,
    np.absolute: double_words.absolute,
    np.sqrt: double_words.root,
}
_COMPARISONS = {np.equal, np.not_equal, np.less, np.less_equal, np.greater, np.greater_equal}
_MOVING = {
    np.broadcast_to, np.concatenate, np.expand_dims, np.stack, np.swapaxes, np.zeros_like
}  # fmt: skip
_QUERIES = {np.any, np.ndim, np.shape}
