"""What a trace does not give is neither drawn nor in the way of what it does give."""

import numpy as np
import polars as pl

from omegadot.reference_impl.system import Body, System
from omegadot.reports.charts.divergence import CHANNELS, STATE, divergence

SYSTEM = System((Body(np.array(2.0), np.zeros(3), np.diag([1.0, 2.0, 3.0])),))
EXACT = {"qw": 1.0, "wx": 1.0, "wy": 2.0, "vx": 3.0}


def samples(**own: float) -> pl.DataFrame:
    exact = {name: EXACT.get(name, 0.0) for name in STATE}
    found = {**exact, **own}
    columns = {name: [value, value] for name, value in found.items()}
    columns |= {f"{name}_exact": [value, value] for name, value in exact.items()}
    return pl.DataFrame({"time": [0.0, 1.0], **columns})


NAN = float("nan")
PLACE = {f"{kind}{axis}": NAN for kind in "pv" for axis in "xyz"}
ATTITUDE = {f"q{axis}": NAN for axis in "wxyz"}


def test_energy_is_that_of_the_rotation_where_no_velocity_is_given() -> None:
    errors, _ = divergence(SYSTEM, samples(wx=1.5, **PLACE))
    found = dict(zip(CHANNELS, errors[0], strict=True))
    # 1/2 I1 (1.5^2 - 1) over the exact kinetic energy, 1/2 (1 + 2 2^2 + 2 3^2)
    assert found["energy"] == np.float64(0.5 * 1.25 / 13.5)
    assert np.isnan(found["linear_momentum"])
    errors, _ = divergence(SYSTEM, samples(wx=1.5, **PLACE, **ATTITUDE))
    found = dict(zip(CHANNELS, errors[0], strict=True))
    assert found["energy"] == np.float64(0.5 * 1.25 / 13.5)
    assert np.isnan(found["attitude"])
    assert np.isnan(found["angular_momentum"])


def test_a_run_that_lost_its_velocity_in_part_is_still_not_finite() -> None:
    errors, _ = divergence(SYSTEM, samples(vx=NAN))
    assert np.isnan(dict(zip(CHANNELS, errors[0], strict=True))["energy"])
