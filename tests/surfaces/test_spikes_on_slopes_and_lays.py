"""Spikes of an instrument are found alike on a level, tilted or curved map, and grooves of a lay are none."""

import numpy as np
import pytest

from bem import InputError, Surface, read_surface
from bem.scenes.maps import filled_note
from bem.surfaces import crop, despike
from bem.surfaces.filter import points_in_gaps
from bem.surfaces.spikes import count_spikes, spikes_of

CELLS, SPACING = 160, 0.4e-6
AXIS = np.arange(CELLS) * SPACING


def ground_map(seed, hurst=0.8, elongation=8.0, angle=0.0):
    """A self-affine map whose waves are longer by `elongation` along the lay, `angle` [rad] off y; Sq 150 nm."""
    q = 2 * np.pi * np.fft.fftfreq(CELLS, SPACING)
    qx, qy = q[:, None], q[None, :]
    across, along = qx * np.cos(angle) + qy * np.sin(angle), qy * np.cos(angle) - qx * np.sin(angle)
    steep = np.maximum(np.hypot(across, elongation * along), 2 * np.pi / 20e-6) ** -(1 + hurst)
    heights = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).standard_normal((CELLS, CELLS))) * steep).real
    return 1.5e-7 * (heights - heights.mean()) / heights.std()


def with_spikes(heights, height=0.8e-6):
    """Twenty lone points raised by `height` [m], four of them on edges and corners, and which they are."""
    at = np.zeros(heights.shape, dtype=bool)
    at[tuple(np.random.default_rng(7).integers(5, CELLS - 5, (2, 16)))] = True
    at[[0, 0, 70, -1], [0, 40, -1, 90]] = True
    return heights + np.where(at, height, 0.0), at


@pytest.mark.parametrize("slope", [0.0, 0.03, 0.1, 0.3, 1.0])
def test_a_tilt_changes_no_spike(slope):
    """20, 23, 17, 0 and 0 points were taken out at slopes of 0, 0.03, 0.1, 0.2 and 0.3."""
    heights, spikes = with_spikes(ground_map(1))
    found = np.isnan(despike(heights + slope * AXIS[:, None], (SPACING, SPACING)))
    np.testing.assert_array_equal(found, spikes)


def test_the_flank_of_a_ball_keeps_its_points_and_loses_its_spikes():
    radius = 100e-6
    ball = np.sqrt(radius**2 - (AXIS[:, None] - 32e-6) ** 2 - (AXIS[None, :] - 32e-6) ** 2)  # slopes up to 0.5
    heights, spikes = with_spikes(ground_map(2, elongation=1.0))
    np.testing.assert_array_equal(np.isnan(despike(heights + ball, (SPACING, SPACING))), spikes)


@pytest.mark.parametrize("elongation", [1.0, 8.0, 20.0])
@pytest.mark.parametrize("angle", [0.0, 22.5, 45.0, 75.0])
def test_grooves_of_a_ground_surface_are_no_spikes(elongation, angle):
    """With a lay of 20, 116 points of a sound map were taken for spikes."""
    for seed, hurst in enumerate((0.3, 0.8)):
        heights = ground_map(seed, hurst, elongation, np.deg2rad(angle))
        assert count_spikes(heights + 0.03 * AXIS[:, None], (SPACING, SPACING)) == 0


def test_a_dust_grain_of_three_points_a_side_is_found():
    heights = ground_map(3)
    heights[80:83, 50:53] += 2e-6
    found = np.isnan(despike(heights, (SPACING, SPACING)))
    assert found[80:83, 50:53].all()
    assert found.sum() == 9


@pytest.fixture
def dirty(tmp_path):
    """File of a tilted map with spikes, 3 % lone missing points and a gap beside a spike."""
    heights, spikes = with_spikes(ground_map(4) + 0.2 * AXIS[:, None], 3e-6)
    missing = np.random.default_rng(0).random(heights.shape) < 0.03
    row, column = np.argwhere(spikes)[5]
    missing[row + 1 : row + 6, column - 3 : column + 4] = True
    missing &= ~spikes
    np.savez(tmp_path / "dirty.npz", heights=np.where(missing, np.nan, heights), spacing=(SPACING, SPACING))
    return tmp_path / "dirty.npz", int(spikes.sum())


@pytest.mark.parametrize("how", [{}, {"detrend": "curvature"}, {"level_lines": True}])
def test_a_map_counts_what_its_reading_takes_out(dirty, how):
    """Filled points beside a spike counted, and lines were levelled between the two counts: 21 beside 20."""
    path, spikes = dirty
    cleaned = read_surface(path, despike=6, **how)
    assert spikes_of(read_surface(path, **how)) == cleaned.metadata["spikes"] == spikes
    assert spikes_of(cleaned) == 0


def test_a_part_of_a_map_knows_its_own_filled_points(dirty):
    whole = read_surface(dirty[0])
    assert whole.filled_share == pytest.approx(whole.metadata["missing_points"] / whole.heights.size)
    part = crop(whole, (20e-6, 20e-6), centre=(-15e-6, 10e-6))
    first = (np.array([-15e-6, 10e-6]) / SPACING + (CELLS - 50) / 2).round().astype(int)
    inside = whole.filled[first[0] : first[0] + 50, first[1] : first[1] + 50]
    np.testing.assert_array_equal(part.filled, inside)
    assert 0 < part.filled_share < 1


def test_the_mask_of_filled_points_follows_the_heights():
    heights = np.zeros((4, 5))
    surface = Surface(heights, (1e-6, 1e-6), {}, np.eye(4, 5, dtype=bool))
    assert surface.replace(heights + 1).filled_share == 0.2
    assert surface.replace(heights, spacing=(2e-6, 2e-6)).filled is None
    assert np.isnan(surface.measured_heights).sum() == 4
    with pytest.raises(InputError, match="filled"):
        Surface(heights, (1e-6, 1e-6), {}, np.zeros((5, 4), dtype=bool))


def test_cropping_is_proposed_where_it_helps():
    """3 % of lone points strewn over a map came with the advice to crop to a part without gaps."""
    lone = np.random.default_rng(2).random((100, 100)) < 0.05
    assert points_in_gaps(lone) < 0.1 * lone.sum()
    gap = np.zeros((100, 100), dtype=bool)
    gap[40:65, 30:60] = True
    assert points_in_gaps(gap) == 750
    notes = [filled_note("map", Surface(np.zeros((100, 100)), (1e-6, 1e-6), {}, mask)) for mask in (lone, gap)]
    assert [note.values["reason"] for note in notes] == ["much", "gaps"]
    assert "crop" not in notes[0]
    assert "crop to a part without them" in notes[1]
    assert "7.5 % of the map was filled" in notes[1]
    assert all("may be rougher" in note for note in notes)
    few = np.random.default_rng(2).random((100, 100)) < 0.01
    assert filled_note("map", Surface(np.zeros((100, 100)), (1e-6, 1e-6), {}, few)) is None
