"""The 3x3 inverse, in double and long double, well and badly conditioned, against mpmath."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from reference_cases import turned

from omegadot.reference_impl.symmetric import apply, inverse


def _exact_inverse(matrix: np.ndarray) -> np.ndarray:
    with mp.workdps(60):
        exact = mp.matrix(matrix.astype(float).tolist()) ** -1
        return np.array(
            [[np.longdouble(mp.nstr(exact[i, j], 30)) for j in range(3)] for i in range(3)]
        )


@pytest.mark.parametrize("moments", [(1, 2, 2.5), (1e-6, 1, 1), (1e6, 1, 1e6), (3, 3, 3)])
@pytest.mark.parametrize("dtype", [np.float64, np.longdouble])
def test_inverse_is_as_good_as_its_type_allows(moments: tuple[float, ...], dtype: type) -> None:
    matrix = turned(moments)
    exact = _exact_inverse(matrix)
    found = inverse(matrix.astype(dtype))
    assert found.dtype == dtype
    # long double loses the condition number to elimination; double is that result rounded once
    long_eps, condition = np.finfo(np.longdouble).eps, max(moments) / min(moments)
    bound = 32 * long_eps * condition + np.finfo(dtype).eps / 2
    assert np.max(np.abs(found - exact)) <= bound * np.max(np.abs(exact))


def test_many_at_once_and_apply() -> None:
    many = np.stack([turned((1, 2, 2.5)), turned((2, 3, 4))])
    assert np.array_equal(inverse(many)[1], inverse(many[1]))
    v = np.array([[1.0, 2.0, 3.0], [-1.0, 0.5, 2.0]])
    assert np.allclose(apply(many, v)[1], many[1] @ v[1], rtol=1e-15)


def test_a_tensor_that_is_not_positive_definite_is_refused() -> None:
    with pytest.raises(ValueError, match="positive definite"):
        inverse(np.diag([1.0, -1.0, 2.0]))
    with pytest.raises(ValueError, match="positive definite"):
        inverse(np.diag([1.0, -1e-3, 2.0]))
    with pytest.raises(ValueError, match="positive definite"):
        inverse(np.full((3, 3), np.nan))
