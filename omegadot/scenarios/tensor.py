"""An inertia as a scenario gives it: three principal moments or a symmetric 3x3 tensor."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator

from omegadot.scenarios.quantities import SMALLEST, read_number, read_positive, refuse

EPS = float(np.finfo(float).eps)
Row = tuple[float, float, float]
Matrix = tuple[Row, Row, Row]


def read_inertia(value: object) -> Matrix:
    """A 3x3 tensor in kg m^2: symmetric, positive definite, within the triangle inequality.

    Three numbers are the principal moments along the body axes. A tensor may be off symmetric by
    the rounding of ``R diag(I) R^T``; the two sides are then averaged.
    """
    wanted = "give three principal moments or a 3x3 tensor in kg m^2"
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise refuse(wanted, found=value)
    if not any(isinstance(row, list | tuple) for row in value):
        x, y, z = (read_positive(moment, key=f"[{i}]") for i, moment in enumerate(value))
        # three half ulps of the given moments and one of the sum: at most two ulps of the largest
        _check_triangle(np.array([x, y, z]), 2 * EPS, value)
        return (x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)
    for i, row in enumerate(value):
        if not isinstance(row, list | tuple) or len(row) != 3:
            raise refuse(f"{wanted}, each row of three numbers", key=f"[{i}]", found=row)
    return _check_tensor(
        np.array(
            [
                [read_number(entry, key=f"[{i}][{j}]") for j, entry in enumerate(row)]
                for i, row in enumerate(value)
            ]
        ),
        value,
    )


def _check_tensor(tensor: NDArray[np.float64], value: object) -> Matrix:
    largest = np.abs(tensor).max()
    # an entry of R diag(I) R^T is a sum of three products of three factors, each within |I|
    if np.abs(tensor - tensor.T).max() > 8 * EPS * largest:
        raise refuse(
            "give a symmetric tensor, with the products of inertia on both sides", found=value
        )
    tensor = (tensor + tensor.T) / 2
    moments: NDArray[np.floating] = np.sort(np.diag(tensor))
    rounding, floor = 2 * EPS, SMALLEST
    if np.any(tensor != np.diag(np.diag(tensor))):
        # LAPACK finds 3x3 eigenvalues to a few ulps of the largest
        moments, rounding = np.linalg.eigvalsh(tensor), 16 * EPS
        floor = max(SMALLEST, rounding * float(largest))
    if moments[0] < floor:
        raise refuse(
            f"make it positive definite, its smallest principal moment is {moments[0]:.6g}",
            found=value,
        )
    _check_triangle(moments, rounding, value)
    a, b, c = ((float(row[0]), float(row[1]), float(row[2])) for row in tensor)
    return a, b, c


def _check_triangle(moments: NDArray[np.floating], rounding: float, value: object) -> None:
    """No principal moment may exceed the sum of the others; a flat body reaches it."""
    small, middle, large = np.sort(moments)
    if large - (small + middle) > rounding * large:
        raise refuse(
            f"make the greatest principal moment ({large:.6g}) at most the sum of the other two"
            f" ({small + middle:.6g}), as every body's is",
            found=value,
        )


Inertia = Annotated[Matrix, PlainValidator(read_inertia)]
