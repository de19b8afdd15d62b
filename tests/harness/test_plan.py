"""Steps and samples: the contract's times, exactly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.gates.case import sweep_of


@pytest.mark.parametrize(
    ("duration", "timestep", "sample", "steps", "every"),
    [
        (20.0, 0.02, 0.01, 1000, 1),
        (20.0, 0.005, 0.01, 4000, 2),
        (0.3, 0.1, 0.1, 3, 1),  # 0.3 / 0.1 is 2.9999999999999996
        (1.0, 0.3, 0.3, 3, 1),  # the last whole step within the duration
        (1.0, 0.4, 1.0, 2, 2),
        (1.0, 1.0, 0.01, 1, 1),
        (1.0, 0.01, 0.025, 100, 2),  # round(2.5) is 2
    ],
)
def test_whole_steps_and_sample_spacing(
    duration: float, timestep: float, sample: float, steps: int, every: int
) -> None:
    sweep = sweep_of(duration, timestep, sample)
    assert (sweep.steps, sweep.every) == (steps, every)


@settings(derandomize=True, max_examples=200)
@given(st.floats(0.1, 100.0), st.floats(1e-3, 0.1), st.floats(1e-3, 0.1))
def test_start_and_end_are_kept(duration: float, timestep: float, sample: float) -> None:
    sweep = sweep_of(duration, timestep, sample)
    kept = sweep.sample_steps
    assert kept[0] == 0
    assert kept[-1] == sweep.steps
    assert np.all(np.diff(kept)[:-1] == sweep.every)
    assert sweep.times[-1] <= duration * (1 + 4 * np.finfo(float).eps)
    assert duration - sweep.times[-1] < timestep * (1 + 1e-9)


@settings(derandomize=True, max_examples=50)
@given(st.floats(0.1, 10.0), st.floats(1e-3, 0.1), st.sampled_from([2, 4, 8]))
def test_refined_sweeps_keep_the_times_to_the_bit(
    duration: float, timestep: float, factor: int
) -> None:
    sweep = sweep_of(duration, timestep, timestep)
    np.testing.assert_array_equal(sweep.refined(factor).times, sweep.times)
