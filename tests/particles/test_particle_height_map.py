"""Particles on a plate: known bodies, levelling, separation, borders, rectangles, the synthetic AFM map."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import label as connected

from bem import Grid, InputError, particle_statistics, particles_from_height_map
from bem.particles import level_background, size_summary, synthetic_afm_map
from bem.particles.height_map import label_particles, minimum_area_rectangle

SPACING = (20e-9, 25e-9)


def box_map():
    heights = np.zeros((60, 50))
    heights[10:15, 20:30] = 100e-9
    heights[40:42, 5:9] = 70e-9
    heights[41, 6] = 90e-9
    return heights


def test_boxes():
    first, second = particles_from_height_map(box_map(), SPACING, threshold=50e-9)
    assert first.volume == pytest.approx(50 * 500e-18 * 100e-9, rel=1e-6, abs=0)
    assert (first.length, first.width) == pytest.approx((250e-9, 100e-9))
    assert first.thickness == pytest.approx(100e-9)
    assert first.equivalent_radius == pytest.approx((3 * first.volume / (4 * math.pi)) ** (1 / 3))
    grid = Grid((60, 50), SPACING)
    assert first.position == pytest.approx((grid.x[10:15].mean(), grid.y[20:30].mean()))
    assert first.columns_count == 50
    assert not first.truncated
    assert second.thickness == pytest.approx(90e-9)
    assert second.volume == pytest.approx(500e-18 * (7 * 70e-9 + 90e-9), rel=1e-6, abs=0)
    np.testing.assert_allclose(second.column_thickness.sum() * 500e-18, second.volume, rtol=1e-12)


def test_position_is_the_centre_of_volume_from_the_centre_of_the_map():
    heights = np.zeros((60, 50))
    columns, thickness = ([10, 10, 11], [7, 8, 8]), np.array([60e-9, 180e-9, 90e-9])
    heights[columns] = thickness
    (particle,) = particles_from_height_map(heights, SPACING, threshold=50e-9)
    grid = Grid((60, 50), SPACING)
    expected = [np.average(axis[at], weights=thickness) for axis, at in zip((grid.x, grid.y), columns, strict=True)]
    assert particle.position == pytest.approx(expected, rel=1e-9, abs=0)


def test_pits_do_not_move_the_plate():
    """Pits at one end of a tilted map: a plane fitted through them too would tilt against the plate."""
    heights = box_map()
    plain = particles_from_height_map(heights, SPACING, threshold=50e-9)
    heights[3:9, 3:47] = -200e-9
    heights += 0.05 * np.arange(60)[:, None] * SPACING[0]
    found = particles_from_height_map(heights, SPACING, threshold=50e-9)
    assert [p.volume for p in found] == pytest.approx([p.volume for p in plain], rel=1e-9, abs=0)


def test_threshold_is_above_the_plate_wherever_that_is():
    heights = box_map()
    x, y = np.arange(60)[:, None] * SPACING[0], np.arange(50)[None, :] * SPACING[1]
    tilted = heights + 3e-6 + 0.05 * x - 0.02 * y
    plain = particles_from_height_map(heights, SPACING, threshold=50e-9)
    level = particles_from_height_map(tilted, SPACING, threshold=50e-9)
    bowed = particles_from_height_map(tilted + 5e4 * x**2, SPACING, threshold=50e-9, background="curvature")
    for a, b, c in zip(plain, level, bowed, strict=True):
        # the offset is thirty times the particle: round-off of the fit
        assert b.volume == pytest.approx(a.volume, rel=1e-9, abs=0)
        assert c.volume == pytest.approx(a.volume, rel=1e-9, abs=0)
        np.testing.assert_array_equal(a.columns, b.columns)
    # not levelled, all of the map is one particle, which the border cuts
    assert particles_from_height_map(heights + 1e-6, SPACING, threshold=50e-9, background="none") == []


def test_levelling_under_many_particles():
    """A fifth of the plate covered: a plain least-squares plane would be lifted, the robust one is not."""
    sample = synthetic_afm_map(seed=4, shape=(400, 400), lengths=(10e-6, 10e-6), count=60, tilt=(2e-2, 1e-2))
    level = level_background(sample.heights, sample.spacing, threshold=50e-9)
    plate = np.abs(level) < 25e-9
    assert abs(np.median(level[plate])) < 1e-9
    assert np.std(level[plate]) < 7e-9  # 5 nm of roughness and the particles' feet
    slope = np.polyfit(np.arange(400), [np.median(row[np.abs(row) < 25e-9]) for row in level], 1)[0]
    assert abs(slope * 400) < 2e-9


def test_scan_lines():
    rng = np.random.default_rng(0)
    heights = box_map() + rng.normal(size=50)[None, :] * 30e-9
    plain = particles_from_height_map(box_map(), SPACING, threshold=50e-9)
    got = particles_from_height_map(heights, SPACING, threshold=50e-9, background="none", level_lines=True)
    assert [p.volume for p in got] == pytest.approx([p.volume for p in plain], rel=1e-9, abs=0)


def test_border():
    heights = box_map()
    heights[0:3, 0:3] = 80e-9
    without = particles_from_height_map(heights, SPACING, threshold=50e-9)
    with_border = particles_from_height_map(heights, SPACING, threshold=50e-9, border="include")
    assert len(without) == 2
    assert [p.truncated for p in with_border] == [True, False, False]


def test_smallest():
    heights = box_map()
    heights[50, 40] = 60e-9
    assert len(particles_from_height_map(heights, SPACING, threshold=50e-9)) == 3
    assert len(particles_from_height_map(heights, SPACING, threshold=50e-9, smallest_columns=2)) == 2
    assert len(particles_from_height_map(heights, SPACING, threshold=50e-9, smallest_radius=60e-9)) == 1
    radii = [p.equivalent_radius for p in particles_from_height_map(heights, SPACING, threshold=50e-9)]
    kept = particles_from_height_map(heights, SPACING, threshold=50e-9, smallest_radius=sorted(radii)[1])
    assert len(kept) == 2, "a particle of the smallest radius counts"


def test_connectivity():
    heights = np.zeros((10, 10))
    heights[3, 3] = heights[4, 4] = 1e-7
    assert len(particles_from_height_map(heights, SPACING, threshold=5e-8)) == 1
    assert len(particles_from_height_map(heights, SPACING, threshold=5e-8, connectivity=4)) == 2


def bumps(distance):
    """Two paraboloids of height 1 and radius 10 cells, one over the other where they meet: the pass is 1 - (d/20)^2."""
    x, y = np.arange(81)[:, None], np.arange(61)[None, :]
    return np.max(
        [np.maximum(1 - ((x - 40 - s * distance / 2) ** 2 + (y - 30) ** 2) / 100, 0) for s in (-1, 1)], axis=0
    )


@pytest.mark.internal
@pytest.mark.parametrize("distance", [6, 10, 14, 18])
def test_separation_of_touching_particles(distance):
    """They part when the pass is lower than the asked share of the lower summit."""
    depth = (distance / 20) ** 2
    level = bumps(distance)
    assert label_particles(level, 0.05).max() == 1
    assert label_particles(level, 0.05, separate=depth + 0.01).max() == 1
    assert label_particles(level, 0.05, separate=depth - 0.01).max() == 2


@pytest.mark.parametrize(("separate", "count"), [(0.15, 2), (0.25, 1)])
def test_the_lower_summit_decides_whether_particles_part(separate, count):
    """The pass at 40 nm lies a fifth below the summit of 50 nm, and three fifths below that of 100 nm."""
    heights = np.zeros((9, 5))
    heights[3:6, 2] = [100e-9, 40e-9, 50e-9]
    found = particles_from_height_map(heights, SPACING, threshold=10e-9, background="none", separate=separate)
    assert len(found) == count


@pytest.mark.internal
def test_separation_keeps_every_column_and_divides_at_the_pass():
    level = bumps(16)
    labels = label_particles(level, 0.05, separate=0.2)
    assert ((labels > 0) == (level > 0.05)).all()
    # mirror images of each other; the columns exactly between go to one of them
    assert (labels[:40] != 2).all()
    assert (labels[41:] != 1).all()


@pytest.mark.internal
@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31), st.integers(1, 15), st.integers(1, 15), st.floats(0, 1), st.booleans())
def test_labels_without_separation_are_connected_components(seed, nx, ny, threshold, corners):
    level = np.random.default_rng(seed).random((nx, ny)).round(1)  # ties too
    ours = label_particles(level, threshold, None, 8 if corners else 4)
    theirs, count = connected(level > threshold, structure=np.ones((3, 3)) if corners else None)
    assert ours.max() == count
    assert len({(a, b) for a, b in zip(ours.ravel(), theirs.ravel(), strict=True)}) == count + (
        0 if (theirs > 0).all() else 1
    )


@pytest.mark.internal
@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), st.floats(0.05, 0.95))
def test_separation_divides_components_and_no_more_than_summits(seed, share):
    level = np.random.default_rng(seed).random((12, 9))
    whole = label_particles(level, 0.3)
    parts = label_particles(level, 0.3, share)
    assert ((whole > 0) == (parts > 0)).all()
    for name in range(1, parts.max() + 1):
        inside = parts == name
        assert len(np.unique(whole[inside])) == 1
        assert connected(inside, structure=np.ones((3, 3)))[1] == 1
    # a larger share merges more
    assert label_particles(level, 0.3, min(share + 0.04, 0.99)).max() <= parts.max()


@pytest.mark.internal
def test_minimum_area_rectangle():
    heights = np.zeros((80, 80))
    x, y = np.arange(80)[:, None] - 40, np.arange(80)[None, :] - 40
    turned = (np.abs(x + y) <= 40) & (np.abs(x - y) <= 12)
    heights[turned] = 1e-7
    (plain,) = particles_from_height_map(heights, (1e-8, 1e-8), threshold=5e-8)
    (tight,) = particles_from_height_map(heights, (1e-8, 1e-8), threshold=5e-8, rectangle="minimum_area")
    assert plain.length == pytest.approx(plain.width)
    # half-diagonals 40 and 12 cells along the diagonals; a cell's corners add up to one cell
    assert tight.length == pytest.approx(40 * math.sqrt(2) * 1e-8, rel=0.05)
    assert tight.width == pytest.approx(12 * math.sqrt(2) * 1e-8, rel=0.1)
    assert minimum_area_rectangle(np.array([3]), np.array([4]), (1.0, 2.0)) in (
        pytest.approx((1.0, 2.0)),
        pytest.approx((2.0, 1.0)),
    )


def test_rectangle_of_least_area_is_not_that_of_least_perimeter():
    """An obtuse triangle: its longest side bounds the least area (found here by turning), a short one the perimeter."""
    x, y = np.indices((60, 50))
    rest = 1 - (y - 3) / 40
    triangle = (y >= 3) & (rest > 0) & (x >= 5 + 8 * rest) & (x <= 5 + 48 * rest)
    (particle,) = particles_from_height_map(
        np.where(triangle, 1e-7, 0.0), (1e-8, 1e-8), threshold=5e-8, background="none", rectangle="minimum_area"
    )
    corners = np.concatenate([np.argwhere(triangle) + np.array([a, b]) for a in (0, 1) for b in (0, 1)])
    angle = np.linspace(0, np.pi / 2, 5001)
    along, across = (
        np.ptp(corners @ direction, axis=0)
        for direction in ((np.cos(angle), np.sin(angle)), (-np.sin(angle), np.cos(angle)))
    )
    area = along * across
    assert area[np.argmin(along + across)] > 1.1 * area.min(), "the two rectangles differ"
    assert particle.length * particle.width == pytest.approx(1e-16 * area.min(), rel=1e-3, abs=0)


def test_nothing_there():
    assert particles_from_height_map(np.zeros((5, 5)), SPACING, threshold=1e-9) == []


@pytest.mark.parametrize(
    "kwargs",
    [
        {"threshold": 0.0},
        {"threshold": math.nan},
        {"threshold": 1e-9, "background": "sphere"},
        {"threshold": 1e-9, "separate": 1.0},
        {"threshold": 1e-9, "border": "clip"},
        {"threshold": 1e-9, "rectangle": "circle"},
        {"threshold": 1e-9, "smallest_columns": 0},
        {"threshold": 1e-9, "smallest_radius": -1.0},
        {"threshold": 1e-9, "connectivity": 6},
    ],
)
def test_refusals(kwargs):
    with pytest.raises(InputError, match="particles_from_height_map"):
        particles_from_height_map(np.zeros((5, 5)), SPACING, **kwargs)


def test_bad_maps():
    with pytest.raises(InputError, match="heights"):
        particles_from_height_map(np.full((5, 5), np.nan), SPACING, threshold=1e-9)
    with pytest.raises(InputError, match="background"):
        level_background(np.zeros((5, 5)), SPACING, threshold=1e-9, method="sphere")


# --- the made-up AFM map -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sample():
    return synthetic_afm_map(seed=1)


def test_synthetic_map_has_the_asked_particles(sample):
    r = sample.equivalent_radius
    assert sample.heights.shape == (1024, 1024)
    assert r.mean() == pytest.approx(175e-9, rel=1e-9)
    assert (r**4).sum() / (r**3).sum() == pytest.approx(358e-9, rel=1e-9)


def test_measuring_it_gives_the_thesis_numbers(sample):
    """Number mean 175 nm, volume mean 358 nm, thickness 4-5 times below width, one mode; 50 nm threshold."""
    particles = particles_from_height_map(sample.heights, sample.spacing, threshold=50e-9)
    got = size_summary(particles)
    # flat ones are not seen and rims are lost: a few per cent, as in any measurement of this kind
    assert len(particles) > 0.9 * len(sample.equivalent_radius)
    assert got["number_mean_radius_nm"] == pytest.approx(175, rel=0.05)
    assert got["volume_mean_radius_nm"] == pytest.approx(358, rel=0.02)
    assert got["number_mean_radius_nm"] < got["area_mean_radius_nm"] < got["volume_mean_radius_nm"]
    tight = particles_from_height_map(sample.heights, sample.spacing, threshold=50e-9, rectangle="minimum_area")
    assert 3.5 < np.mean([p.width / p.thickness for p in tight]) < 5
    counts = particle_statistics(particles, edges=8).counts
    peak = int(counts.argmax())
    assert (np.diff(counts[: peak + 1]) >= 0).all()
    assert (np.diff(counts[peak:]) <= 2).all()  # one mode; two particles more in a tail bin are no second


def test_each_particle_is_found_where_it_was_put(sample):
    particles = particles_from_height_map(sample.heights, sample.spacing, threshold=50e-9)
    found = 0
    for p in particles:
        distance = np.hypot(*(sample.position - p.position).T)
        i = int(distance.argmin())
        if sample.thickness[i] > 100e-9:
            found += 1
            assert distance[i] < 40e-9  # two cells
            # threshold at half or less of the height: 1 - 0.5^(1/8 x 2) of the area is lost at most
            assert p.equivalent_radius == pytest.approx(sample.equivalent_radius[i], rel=0.07)
            assert p.thickness == pytest.approx(sample.thickness[i], abs=25e-9)  # the plate's roughness on top
    assert found == (sample.thickness > 100e-9).sum()


def test_threshold_hides_small_particles(sample):
    """The higher the threshold, the fewer and the larger: the bias of the method, in the direction the source says."""
    counts, means = [], []
    for threshold in (30e-9, 50e-9, 100e-9):
        got = size_summary(particles_from_height_map(sample.heights, sample.spacing, threshold=threshold))
        counts.append(got["count"])
        means.append(got["number_mean_radius_nm"])
    assert counts == sorted(counts, reverse=True)
    assert means == sorted(means)


def test_synthetic_map_is_seeded_and_refuses():
    kwargs = {"shape": (128, 128), "lengths": (4e-6, 4e-6), "count": 5}
    one, two = (synthetic_afm_map(seed=3, **kwargs) for _ in range(2))
    np.testing.assert_array_equal(one.heights, two.heights)
    assert not np.array_equal(one.heights, synthetic_afm_map(seed=4, **kwargs).heights)
    with pytest.raises(InputError, match="no room"):
        synthetic_afm_map(seed=3, shape=(128, 128), lengths=(4e-6, 4e-6), count=60)
    for bad in ({"count": 0}, {"number_mean_radius": 4e-7}, {"width_over_thickness": 0.5}, {"plate_rms": -1.0}):
        with pytest.raises(InputError, match="synthetic_afm_map"):
            synthetic_afm_map(seed=3, **(kwargs | bad))
    with pytest.raises(InputError, match="cannot have a volume mean"):
        synthetic_afm_map(seed=3, **(kwargs | {"count": 2}))
