"""The parts of the closed forms: eighty digits, phases, principal axes, theta series."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from closed_form_errors import EPS

from omegadot.reference_impl.closed_forms.digits import (
    agm,
    carlson_rf,
    cos_sin,
    exact_matrix,
    many_digits,
    pi,
)
from omegadot.reference_impl.closed_forms.elliptic import Clock, Modulus
from omegadot.reference_impl.closed_forms.given import principal_axes
from omegadot.reference_impl.closed_forms.phase import Phase, unit_circle
from omegadot.reference_impl.closed_forms.theta import jacobi_rows
from omegadot.reference_impl.closed_forms.theta_series import Series
from omegadot.reference_impl.closed_forms.times import Times


def _mp(x: Decimal) -> mp.mpf:
    return mp.mpf(str(x))


def test_constants_have_the_digits_they_claim() -> None:
    tiny = mp.mpf(10) ** -76
    with mp.workdps(85), many_digits():
        assert abs(_mp(pi()) - mp.pi) < tiny
        for text in ("0", "0.3", "1.3", "-2.9"):
            c, s = cos_sin(Decimal(text))
            assert abs(_mp(c) - mp.cos(mp.mpf(text))) < tiny
            assert abs(_mp(s) - mp.sin(mp.mpf(text))) < tiny
        for triple in (
            ("0", "0.3", "1"),
            ("1e-40", "2e-40", "1"),
            ("1e-170", "1e-170", "1"),
            ("0.1", "0.2", "0.3"),
        ):
            value = carlson_rf(*map(Decimal, triple))
            assert abs(_mp(value) / mp.elliprf(*map(mp.mpf, triple)) - 1) < tiny
        assert abs(_mp(agm(Decimal(1), Decimal("1e-30"))) / mp.agm(1, mp.mpf("1e-30")) - 1) < tiny


def test_principal_axes_of_a_rotated_tensor() -> None:
    """Eigenvalues of a bar of condition 1e12 to sixty digits; the axes right-handed."""
    tensor = np.array([[0.5, 0.5 - 1e-12, 0.1], [0.5 - 1e-12, 0.5, 0.1], [0.1, 0.1, 1.0]])
    with mp.workdps(80), many_digits():
        moments, axes = principal_axes(exact_matrix(tensor))
        truth = sorted(mp.eigsy(mp.matrix(tensor.tolist()), eigvals_only=True))
        for x, y in zip(moments, truth, strict=True):
            assert abs(_mp(x) - y) < mp.mpf(10) ** -60
    assert np.linalg.det(np.array(axes, float)) == pytest.approx(1.0, abs=8 * EPS)


@pytest.mark.parametrize(
    ("order"), [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
)
def test_axes_of_a_diagonal_tensor_are_exact(order: tuple[int, int, int]) -> None:
    moments = np.array([0.1, 0.2, 0.3])[list(order)]
    with many_digits():
        found, axes = principal_axes(exact_matrix(np.diag(moments)))
    matrix = np.array(axes, float)
    np.testing.assert_array_equal(np.array(found, float), np.sort(moments))
    np.testing.assert_array_equal(np.abs(matrix) @ np.abs(matrix).T, np.eye(3))
    assert np.linalg.det(matrix) == 1.0


def test_phase_keeps_its_digits_over_a_million_turns() -> None:
    with many_digits():
        rate, start = Decimal(2).sqrt(), Decimal("0.3")
        phase = Phase.of(rate, start)
    times = np.array([0.0, 1e-9, 1.7, 12345.678, -98765.4321, 1e6 / 7])
    whole, part = phase.reduced(Times(times))
    circle = phase.circle(Times(times))
    for t, n, r, z in zip(times, whole, part, circle, strict=True):
        x = Fraction(float(t)) * Fraction(rate) + Fraction(start)
        # rounding of the remainder, and |x| 2^-79 of the rate's last part
        bound = EPS + abs(float(x)) * 2.0**-78
        off = float(x - Fraction(float(n)) - Fraction(float(r)))
        assert abs(off - 2 * round(off / 2)) <= bound  # the parity of n is kept
        with mp.workdps(40):
            truth = mp.expjpi(2 * (x.numerator % x.denominator) / mp.mpf(x.denominator))
            # a rounding of each part, one of its small correction, and the phase's own
            assert abs(mp.mpc(complex(z)) - truth) <= EPS + abs(float(x)) * 2.0**-76


def test_unit_circle() -> None:
    turns = np.concatenate([np.linspace(-1.2, 1.2, 4001), [1e-300, -1e-20, 0.0]])
    value = unit_circle(turns)
    for t, z in list(zip(turns, value, strict=True))[::7]:
        with mp.workdps(30):
            truth = mp.expjpi(2 * mp.mpf(float(t)))
            # a rounding of the turns, up to eps 2π / 2, and one of each part
            assert abs(mp.mpc(complex(z)) - truth) <= 2 * EPS + mp.pi * EPS * abs(float(t))


@pytest.mark.parametrize("m1", ["1", "0.7", "0.05", "0.029", "0.001", "1e-12", "1e-30", "0"])
def test_jacobi_functions_by_the_complement(m1: str) -> None:
    """Against mpmath at sixty digits, through both kinds of series and on the separatrix."""
    with mp.workdps(60):
        complement = mp.mpf(m1)
        m = 1 - complement
        with many_digits():
            modulus = Modulus.of(1 - Decimal(m1), Decimal(m1))
            clock = Clock.of(modulus, Decimal(1), Decimal("0.25"))
            series = Series.of(jacobi_rows(modulus, Decimal(1), Decimal(1), Decimal(1)))
        times = np.linspace(-40.0, 40.0, 33)
        frame = clock.read(Times(times))
        sn, cn, dn, divisor = series(frame)
        odd, even, _ = frame.odd_even
        found = sn * odd / divisor, cn * even / divisor, dn / divisor
        for k, t in enumerate(times):
            u = mp.mpf(float(t)) + mp.mpf("0.25")
            for name, values in zip(("sn", "cn", "dn"), found, strict=True):
                if complement:
                    truth = mp.re(mp.ellipfun(name, u, m=m))
                else:
                    truth = mp.tanh(u) if name == "sn" else mp.sech(u)
                assert abs(mp.mpf(float(values[k])) - truth) <= 4 * EPS
