"""Maps made periodic: no step where their ends meet, and nothing changed further in."""

import numpy as np
import pytest

from bem import Grid, Surface, close_seams, generate_surface


def steps(heights, axis):
    """Rms of the differences across the seam over that of the differences inside."""
    inside = np.diff(heights, axis=axis)
    across = heights.take(0, axis=axis) - heights.take(-1, axis=axis)
    return float(np.sqrt(np.mean(across**2) / np.mean(inside**2)))


def window(seed=1):
    """A part of a larger random surface: rough, and not periodic."""
    large = generate_surface(Grid((256, 256), (1e-6, 1e-6)), rms_height=1e-7, correlation_length=8e-6, seed=seed)
    return Surface(large[:96, :80], (1e-6, 1.5e-6))


@pytest.mark.parametrize("axes", [(True, True), (True, False), (False, True)])
def test_the_step_goes_and_the_middle_stays(axes):
    before = window()
    after = close_seams(before, axes=axes)
    for axis in (0, 1):
        assert steps(before.heights, axis) > 2  # neighbours of a smooth surface differ little, its two ends much
        if axes[axis]:
            assert steps(after.heights, axis) < 1.5  # as rough across the seam as elsewhere
    changed = np.abs(after.heights - before.heights)
    rim = np.ones(changed.shape, dtype=bool)
    rim[slice(4, -4) if axes[0] else slice(None), slice(4, -4) if axes[1] else slice(None)] = False
    assert changed[rim].mean() > 2 * changed[~rim].mean()
    assert after.metadata["seams_closed"] == pytest.approx(float(np.sqrt(np.mean((changed) ** 2))), rel=1e-12)
    assert after.heights.mean() == pytest.approx(before.heights.mean(), abs=1e-20)


def test_it_solves_its_equation():
    """The Laplacian of the wrapped result is that of the map with differences inside it only (Moisan's property)."""
    before = window(3)
    after = close_seams(before).heights

    def inside(heights, axis, spacing):
        flow = np.diff(heights, axis=axis) / spacing**2
        pad = [(0, 0), (0, 0)]
        pad[axis] = (1, 1)
        return np.diff(np.pad(flow, pad), axis=axis)

    wrapped = sum(
        (np.roll(after, 1, axis) + np.roll(after, -1, axis) - 2 * after) / before.spacing[axis] ** 2 for axis in (0, 1)
    )
    expected = sum(inside(before.heights, axis, before.spacing[axis]) for axis in (0, 1))
    # round-off of two transforms over 7680 cells, relative to the largest value
    np.testing.assert_allclose(wrapped, expected, atol=1e-10 * np.abs(expected).max())


def test_what_is_flat_along_an_axis_stays():
    ramp = Surface(np.linspace(0, 1e-7, 64)[:, None] + np.zeros((1, 8)), (1e-6, 1e-6))
    after = close_seams(ramp).heights
    assert np.ptp(after, axis=1).max() < 1e-20
    assert np.ptp(after) <= 1.01 / 64 * np.ptp(ramp.heights)  # a ramp is all step: one cell's share of it is left


def test_an_axis_that_does_not_wrap_is_left_alone():
    before = window()
    np.testing.assert_array_equal(close_seams(before, axes=(False, False)).heights, before.heights)
