"""An inertia as a scenario gives it: three principal moments or a symmetric 3x3 tensor."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, ValidationInfo

from omegadot.scenarios.quantities import SMALLEST, read_number, read_positive, refuse
from omegadot.written import written

EPS = float(np.finfo(float).eps)
LAPACK = 16 * EPS  # it finds 3x3 eigenvalues to a few ulps of the largest
# The fewest that a number which was computed is printed with: str of Python 2, and so xacro, which
# wrote most robots' files.
DIGITS = 12
ALLOWED = "allow_impossible_inertia"  # the key that takes an inertia which no body has
WANTED = "give three principal moments or a 3x3 tensor in kg m^2"
Row = tuple[float, float, float]
Matrix = tuple[Row, Row, Row]


def read_inertia(value: object, info: ValidationInfo) -> Matrix:
    """A 3x3 tensor in kg m^2: symmetric, positive definite, within the triangle inequality.

    The last is not required with ``allow_impossible_inertia = true``. Three numbers are the
    principal moments along the body axes. A tensor may be off symmetric by the rounding of
    ``R diag(I) R^T``; the two sides are then averaged.
    """
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise refuse(WANTED, found=value)
    if not any(isinstance(row, list | tuple) for row in value):
        x, y, z = (read_positive(moment, key=f"[{i}]") for i, moment in enumerate(value))
        tensor: Matrix = (x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)
    else:
        tensor = _read_rows(value)
    if (broken := broken_triangle(np.array(tensor))) and not info.data.get(ALLOWED):
        raise refuse(
            f"make the greatest principal moment at most the sum of the other two ({broken}), as"
            f" every body's is, or allow it ({ALLOWED} = true in [body],"
            f" --{ALLOWED.replace('_', '-')} with --body)",
            found=value,
        )
    return tensor


def _read_rows(value: list[object] | tuple[object, ...]) -> Matrix:
    rows = []
    for i, row in enumerate(value):
        if not isinstance(row, list | tuple) or len(row) != 3:
            raise refuse(f"{WANTED}, each row of three numbers", key=f"[{i}]", found=row)
        rows.append([read_number(entry, key=f"[{i}][{j}]") for j, entry in enumerate(row)])
    tensor = np.array(rows)
    largest = np.abs(tensor).max()
    # an entry of R diag(I) R^T is a sum of three products of three factors, each within |I|
    if np.abs(tensor - tensor.T).max() > 8 * EPS * largest:
        raise refuse(
            "give a symmetric tensor, with the products of inertia on both sides", found=value
        )
    tensor = (tensor + tensor.T) / 2
    moments, floor = principal_moments(tensor), SMALLEST
    if np.any(tensor != np.diag(np.diag(tensor))):
        floor = max(SMALLEST, LAPACK * float(largest))
    if moments[0] < floor:
        raise refuse(
            f"make it positive definite, its smallest principal moment is {written(moments[0])}",
            found=value,
        )
    a, b, c = ((float(row[0]), float(row[1]), float(row[2])) for row in tensor)
    return a, b, c


def principal_moments(tensor: NDArray[np.float64]) -> NDArray[np.float64]:
    """The three in rising order; of a diagonal tensor exactly."""
    diagonal = np.diag(tensor)
    whole = np.any(tensor != np.diag(diagonal))
    return np.asarray(np.linalg.eigvalsh(tensor) if whole else np.sort(diagonal), dtype=float)


def broken_triangle(tensor: NDArray[np.float64]) -> str | None:
    """How the inertia breaks the triangle inequality, such as ``3.1234 > 3.1233``; None if not.

    No body's greatest principal moment exceeds the sum of the others; a flat body's reaches it.
    With ``u`` half a unit in the last of `DIGITS` printed digits, entries ``I_ij`` are within
    ``u |I_ij|`` of what they were before, and ``2 max - trace`` is within
    ``u (2 |I|_F + trace)``: what exceeds it by less may be a flat body that was printed.
    """
    small, middle, large = principal_moments(tensor)
    rounding = 0.5 * 10.0 ** (1 - DIGITS) + LAPACK
    size = 2.0 * np.linalg.norm(tensor) + np.trace(tensor)
    if large - (small + middle) <= rounding * size:
        return None
    shown = (
        f"{written(large, digits)} > {written(small + middle, digits)}" for digits in range(6, 18)
    )
    return next(pair for pair in shown if len(set(pair.split(" > "))) == 2)


Inertia = Annotated[Matrix, PlainValidator(read_inertia)]
