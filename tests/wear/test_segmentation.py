"""Pieces from a stack of stress: against dense labelling of the refined stack, closed forms, and invariances."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter, generate_binary_structure, label

from bem import Grid, InputError
from bem.wear import describe_pieces, find_particles, refine_depths, segment

DEPTHS = np.array([0.0, 1.0, 2.0, 3.5, 5.0, 6.0]) * 1e-7


def random_stack(seed, shape=(6, 17, 14), smooth=1.2):
    rng = np.random.default_rng(seed)
    field = gaussian_filter(rng.standard_normal(shape), smooth, mode="wrap")
    field = field / field.std() + np.linspace(0.8, -0.8, shape[0])[:, None, None]
    return 1e9 + 3e8 * field


def dense_pieces(stack, depths, yield_stress, periodic, refine, refinement, connectivity):
    """Oracle: interpolate everything, label every voxel, wrap by merging labels, take the caps."""
    fine = refine_depths(depths, refine)
    if refinement == "linear":
        flat = stack.reshape(len(depths), -1)
        refined = np.stack([np.interp(fine, depths, column) for column in flat.T], axis=1)
        refined = refined.reshape(-1, *stack.shape[1:])
    else:
        refined = PchipInterpolator(depths, stack, axis=0)(fine)
    refined[::refine] = stack
    solid = refined > yield_stress
    structure = generate_binary_structure(3, {6: 1, 18: 2, 26: 3}[connectivity])
    # wrap by tiling: label a padded copy, then merge labels of the same voxel
    pad = [(0, 0), (1, 1) if periodic[0] else (0, 0), (1, 1) if periodic[1] else (0, 0)]
    tiled, count = label(np.pad(solid, pad, mode="wrap"), structure)
    ix = np.arange(-pad[1][0], stack.shape[1] + pad[1][1]) % stack.shape[1]
    iy = np.arange(-pad[2][0], stack.shape[2] + pad[2][1]) % stack.shape[2]
    group = list(range(count + 1))

    def root(a):
        while group[a] != a:
            a = group[a]
        return a

    home = {}
    for (k, a, b), name in np.ndenumerate(tiled):
        if name:
            key = (k, ix[a], iy[b])
            if key in home:
                group[root(name)] = root(home[key])
            home[key] = name
    pieces = {}
    for (k, i, j), name in home.items():
        pieces.setdefault(root(name), []).append((k, i, j))
    kept = [np.array(voxels) for voxels in pieces.values() if min(v[0] for v in voxels) == 0]
    # pieces that meet in a column leave as one
    merged = []
    for voxels in kept:
        columns = {(i, j) for _, i, j in voxels}
        deepest = {}
        for k, i, j in voxels:
            deepest[i, j] = max(k, deepest.get((i, j), 0))
        for other in [m for m in merged if m.keys() & columns]:
            merged.remove(other)
            for key, k in other.items():
                deepest[key] = max(k, deepest.get(key, 0))
        merged.append(deepest)
    return merged, fine


@pytest.mark.parametrize("refinement", ["monotone_cubic", "linear"])
@pytest.mark.parametrize("connectivity", [6, 18, 26])
@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_same_pieces_as_labelling_every_voxel(periodic, connectivity, refinement):
    total = 0
    for seed in range(4):
        stack = random_stack(seed, smooth=0.8)
        found = segment(
            stack,
            DEPTHS,
            yield_stress=1.35e9,
            periodic=periodic,
            refine=7,
            refinement=refinement,
            connectivity=connectivity,
        )
        expected, fine = dense_pieces(stack, DEPTHS, 1.35e9, periodic, 7, refinement, connectivity)
        assert found.count == len(expected)
        total += found.count
        for deepest in expected:
            names = {found.labels[i, j] for i, j in deepest}
            assert len(names) == 1
            assert np.count_nonzero(found.labels == names.pop()) == len(deepest)
            for (i, j), k in deepest.items():
                # the depth lies between the deepest yielded fine sample and the next one
                upper = fine[min(k + 1, len(fine) - 1)]
                assert fine[k] - 1e-20 <= found.thickness[i, j] <= upper + 1e-20
    assert total > 12  # enough pieces for the comparison to mean something


def test_hemisphere_has_its_volume_radius_and_rectangle():
    """Yield inside r < R: V = 2/3 pi R^3; error falls at least linearly with the cell (staircase edge)."""
    radius = 1e-6
    errors = []
    for cells in (24, 48, 96):
        spacing = 3e-6 / cells
        grid = Grid((cells, cells), (spacing, spacing))
        depths = np.linspace(0, 1.5e-6, cells // 2 + 1)
        r = np.sqrt(grid.x[:, None] ** 2 + grid.y[None, :] ** 2 + depths[:, None, None] ** 2)
        (particle,) = find_particles(2e9 - 1e9 * r / radius, depths, grid, yield_stress=1e9)
        errors.append(abs(particle.volume / (2 / 3 * np.pi * radius**3) - 1))
        assert particle.thickness == pytest.approx(radius, rel=2 * spacing**2 / radius**2)
        assert particle.length == pytest.approx(2 * radius, abs=1.01 * spacing)
        assert particle.width == pytest.approx(2 * radius, abs=1.01 * spacing)
        assert np.allclose(particle.position, 0, atol=1e-12)
        assert particle.equivalent_radius == pytest.approx((particle.volume * 3 / 4 / np.pi) ** (1 / 3))
    assert errors[-1] < 2e-3  # a quarter of the surface fraction of edge cells, averaged over the circle
    assert errors[2] < errors[0]


def test_a_buried_region_stays_and_a_cap_leaves_with_its_region():
    grid = Grid((5, 3), (1e-7, 1e-7))
    stack = np.zeros((4, 5, 3))
    stack[0, 1, 1] = stack[1, 1, 1] = 2.0  # reaches the surface ...
    stack[1, 2, 1] = stack[2, 2, 1] = 2.0  # ... and undercuts the next column, which is sound at the surface
    stack[2, 4, 1] = 2.0  # buried, not connected
    depths = np.arange(4) * 1e-8
    (particle,) = find_particles(stack, depths, grid, yield_stress=1.0, refinement="linear")
    assert {tuple(c) for c in particle.columns} == {(1, 1), (2, 1)}
    # 2 falls to 0 over one interval: linear interpolation crosses 1 in its middle
    assert particle.column_thickness == pytest.approx([1.5e-8, 2.5e-8], rel=1e-12)
    (top,) = find_particles(stack, depths, grid, yield_stress=1.0, refinement="linear", removal="top_run")
    assert {tuple(c) for c in top.columns} == {(1, 1)}


@pytest.mark.parametrize("removal", ["cap", "top_run"])
def test_a_piece_is_truncated_by_what_leaves_with_it_and_not_by_yield_below_it(removal):
    stack = np.zeros((5, 3, 3))
    stack[0, 1, 1] = 2.0  # leaves
    stack[3:, 1, 1] = 2.0  # below it, not connected, down to the last depth
    given = {"yield_stress": 1.0, "refinement": "linear", "removal": removal}
    assert not segment(stack, np.arange(5) * 1e-8, **given).reaches_bottom.any()
    stack[:, 1, 1] = 2.0
    assert list(segment(stack, np.arange(5) * 1e-8, **given).reaches_bottom) == [False, True]


def test_a_piece_across_a_periodic_edge_is_one_and_its_rectangle_does_not_span_the_domain():
    stack = np.zeros((3, 8, 9))
    stack[0, 3:5, [0, 1, 8]] = 2.0
    depths = np.array([0, 1e-8, 2e-8])
    free = find_particles(stack, depths, Grid((8, 9), (1e-7, 2e-7)), yield_stress=1.0)
    assert len(free) == 2
    (one,) = find_particles(stack, depths, Grid((8, 9), (1e-7, 2e-7), periodic=(False, True)), yield_stress=1.0)
    assert (one.length, one.width) == pytest.approx((6e-7, 2e-7))
    assert one.position[1] == pytest.approx(-4 * 2e-7)


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 10**6), shift=st.tuples(st.integers(0, 20), st.integers(0, 20)))
def test_pieces_do_not_depend_on_where_a_periodic_grid_begins(seed, shift):
    stack = random_stack(seed)
    grid = Grid((17, 14), (1e-7, 1e-7), periodic=(True, True))
    here = find_particles(stack, DEPTHS, grid, yield_stress=1.2e9)
    there = find_particles(np.roll(stack, shift, axis=(1, 2)), DEPTHS, grid, yield_stress=1.2e9)
    key = [sorted((p.volume, p.length, p.width, p.thickness) for p in ps) for ps in (here, there)]
    # summation order differs: a few units in the last place
    assert np.allclose(np.array(key[0]).reshape(-1, 4), np.array(key[1]).reshape(-1, 4), rtol=1e-13)


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_a_depth_without_yield_ends_every_piece(seed):
    """What the cycle's skip rests on: below the first depth where nothing yields (and one more), nothing matters."""
    stack = random_stack(seed)
    stack[3] = np.minimum(stack[3], 1.0e9)
    full = segment(stack, DEPTHS, yield_stress=1.1e9)
    cut = segment(stack[:5], DEPTHS[:5], yield_stress=1.1e9)
    assert np.array_equal(full.thickness, cut.thickness)
    assert np.array_equal(full.labels, cut.labels)


def test_volumes_add_up_to_what_leaves():
    stack = random_stack(3)
    grid = Grid((17, 14), (1e-7, 1.5e-7), periodic=(False, True))
    pieces = segment(stack, DEPTHS, yield_stress=1.1e9, periodic=grid.periodic)
    particles = describe_pieces(pieces, grid, cycle=5)
    total = sum(p.volume for p in particles)
    assert total == pytest.approx(pieces.thickness.sum() * grid.cell_area, rel=1e-14)
    assert all(p.cycle == 5 and p.length >= p.width for p in particles)


def test_all_none_and_truncated():
    depths = np.array([0, 1e-8, 2e-8])
    grid = Grid((4, 4), (1e-7, 1e-7))
    assert find_particles(np.zeros((3, 4, 4)), depths, grid, yield_stress=1.0) == []
    (whole,) = find_particles(np.full((3, 4, 4), 2.0), depths, grid, yield_stress=1.0)
    assert whole.truncated
    assert whole.volume == pytest.approx(16 * 1e-14 * 2e-8)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"depths": [0, 2e-8, 1e-8]}, "increasing"),
        ({"depths": [0, 1e-8]}, "depths"),
        ({"refine": 0}, "refine"),
        ({"connectivity": 8}, "connectivity"),
        ({"refinement": "spline"}, "refinement"),
        ({"yield_stress": -1.0}, "yield_stress"),
        ({"von_mises": np.full((3, 4, 4), np.nan)}, "finite"),
        ({"von_mises": np.zeros((3, 4, 5))}, "shape"),
    ],
)
def test_wrong_arguments_are_named(change, word):
    arguments = {
        "von_mises": np.zeros((3, 4, 4)),
        "depths": [0, 1e-8, 2e-8],
        "grid": Grid((4, 4), (1e-7, 1e-7)),
        "yield_stress": 1.0,
    } | change
    with pytest.raises(InputError, match=word):
        find_particles(
            arguments.pop("von_mises"), np.array(arguments.pop("depths")), arguments.pop("grid"), **arguments
        )
